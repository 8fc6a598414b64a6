/* Inputs within a step; inputs.c describes the functions. */
#ifndef ALI3_INPUTS_H
#define ALI3_INPUTS_H
#include "../instance.h"

ali3_status ali3_inputs_aim(ali3_instance *in, double h, const double *end);
ali3_status ali3_inputs_begin(ali3_instance *in, double t, double h);
ali3_status ali3_inputs_at(ali3_instance *in, double fraction);
double ali3_inputs_until(const ali3_instance *in, double t);
bool ali3_inputs_jump(const ali3_instance *in);
#endif
