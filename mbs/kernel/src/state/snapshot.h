/* What a snapshot begins with; then come the vectors, inputs and parameters. */
#ifndef ALI3_SNAPSHOT_H
#define ALI3_SNAPSHOT_H
#include "../instance.h"

typedef struct {
  ali3_report report;
  double t_base, h_last;
  int64_t count;
} ali3_snapshot_head;
#endif
