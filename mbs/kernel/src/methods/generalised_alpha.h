/* The integration rule of generalised-alpha for a step h, s. */
#ifndef ALI3_GENERALISED_ALPHA_H
#define ALI3_GENERALISED_ALPHA_H
#include "../instance.h"

/* Whether the next step is one of the damped start of Systems with flexible bodies. */
bool ali3_damped_start(const ali3_instance *in, double h);
/* Sets in->rule, in->step.d0 and in->step.hat for the step from in->now. */
void ali3_alpha_rule(ali3_instance *in, double h);
/* Writes the algorithmic accelerations at the end of the step to in->next.own. */
void ali3_alpha_accept(ali3_instance *in, double h);
#endif
