/* Inputs (nu) within a step; times and steps in s. Functions with a status return ALI3_OK, ALI3_BAD_ARGUMENT for inputs
 * that are not finite, or ALI3_BAD_NORMAL. */
#ifndef ALI3_INPUTS_H
#define ALI3_INPUTS_H
#include "../instance.h"

/* Sets the inputs of a step of h from the present time: linear from the present values to `end`, limited to their
 * ranges; NULL: constant. */
ali3_status ali3_inputs_set_end(ali3_instance *in, double h, const double *end);
/* Computes the inputs at both ends, in->inputs.begin and in->inputs.set, of a step, or of a part of one, of h to time
 * t. */
ali3_status ali3_inputs_begin(ali3_instance *in, double t, double h);
/* Writes the inputs at a fraction, 0 to 1, of that step to in->inputs.middle. */
ali3_status ali3_inputs_at(ali3_instance *in, double fraction);
/* The first break of the inputs after the present time and before t, otherwise t. */
double ali3_inputs_until(const ali3_instance *in, double t);
/* Whether the inputs jump at the start of the step, so that the last accelerations are invalid. */
bool ali3_inputs_jump(const ali3_instance *in);
#endif
