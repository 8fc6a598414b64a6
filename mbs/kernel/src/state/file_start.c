/* Resets the start of an instance to the start in the System's file. */
#include <string.h>

#include "../instance.h"
#include "parameters.h"

void ali3_file_start(ali3_instance *in) {
  const ali3_system *S = in->system;
  const size_t n = S->size.has_pose ? (size_t)S->size.nq * sizeof(double) : 0;
  memcpy(in->start.q, S->q0, (size_t)S->size.nq * sizeof(double));
  if (n > 0) {
    memcpy(in->start.pose_0, S->pose_0, n);
    memcpy(in->start.pose_cos, S->pose_cos, n);
    memcpy(in->start.pose_sin, S->pose_sin, n);
  }
}
