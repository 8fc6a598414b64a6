/* Head of a snapshot; the vectors, inputs and parameters follow. */
#ifndef ALI3_SNAPSHOT_H
#define ALI3_SNAPSHOT_H
#include "../instance.h"

typedef struct {
  ali3_report report;
  double t_base, h_last;
  int64_t count;
} ali3_snapshot_head;
#endif
