/* Start and end of a requested step, before and after the method. */
#ifndef ALI3_WHOLE_STEP_H
#define ALI3_WHOLE_STEP_H
#include "../instance.h"
#include "../request.h"

typedef struct {
  ali3_request asked;
  double t_base; /* start time of the count of steps of this length, s */
  int64_t count; /* number of steps of this length, including this one */
  ali3_report before; /* the report at its start */
} ali3_whole_step;

ali3_status ali3_step_begin(ali3_instance *in, double h, const double *end, ali3_reading reading,
                            ali3_whole_step *step);
ali3_status ali3_step_end(ali3_instance *in, const ali3_whole_step *step, ali3_status status);
#endif
