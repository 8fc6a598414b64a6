/* Head of a snapshot; the vectors, inputs and parameters follow. */
#ifndef ALI3_SNAPSHOT_H
#define ALI3_SNAPSHOT_H
#include "../instance.h"

typedef struct {
  ali3_report report; /* in->report */
  double t_base, h_last; /* s: as base and h of ali3_clock */
  int64_t count; /* steps of h_last since t_base */
} ali3_snapshot_head;
#endif
