/* First guess of the increment: the present motion goes on with constant acceleration. Amplitudes that vibrate faster
 * than the step can follow stay where they are: their accelerations say nothing about the next step, and a guess far
 * off would start Newton where the body is strongly bent. */
#include "ali3_internal.h"

void ali3_predict(ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  const ali3_vectors *from = &in->now;
  const double c = 0.25 * h * h;
  for (int32_t i = 0; i < S->size.nq; i++) {
    in->D[i] = h * from->qd[i] + 0.5 * h * h * from->qdd[i];
    in->d0[i] = h * from->qd[i] + c * from->qdd[i];
  }
  for (int32_t b = 0; b < S->n_flexible; b++) {
    const int64_t first = S->flex_mode_ptr[b], n = S->flex_mode_ptr[b + 1] - first;
    for (int64_t j = 0; j < n; j++) {
      const int32_t i = S->flex_mode[first + j];
      if (c * S->flex_K[S->flex_square[b] + j * (n + 1)] > S->front_mass[S->diagonal_pos[i]]) in->D[i] = 0.0;
    }
  }
}
