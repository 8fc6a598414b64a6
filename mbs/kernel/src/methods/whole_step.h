/* Start and end of a requested step, before and after the method. */
#ifndef ALI3_WHOLE_STEP_H
#define ALI3_WHOLE_STEP_H
#include "../instance.h"
#include "../request.h"

typedef struct {
  ali3_request asked; /* the step as a whole */
  double t_base; /* start time of the count of steps of this length, s */
  int64_t count; /* number of steps of this length, including this one */
  ali3_report before; /* the report at its start */
} ali3_whole_step;

/* Starts a step of h, s: fills *step and sets the inputs, which change linearly to `end` (nu); NULL: they are constant.
 * Returns ALI3_OK, or why there can be no step. */
ali3_status ali3_step_begin(ali3_instance *in, double h, const double *end, ali3_reading reading,
                            ali3_whole_step *step);
/* Ends a step with the status of the method, which it returns; after a failure it restores the state before the
 * step. */
ali3_status ali3_step_end(ali3_instance *in, const ali3_whole_step *step, ali3_status status);
#endif
