/* Functions of Newton's iteration that methods share. */
#ifndef ALI3_NEWTON_H
#define ALI3_NEWTON_H
#include "../algebra/real.h"
#include "../instance.h"

#define ALI3_LOST 1.0 /* m: a larger violation is divergence */

double ali3_penalty(const ali3_instance *in, double h);
bool ali3_judge(ali3_instance *in, const double *r);
ali3_status ali3_newton_ended(const ali3_instance *in, ali3_status status);
void ali3_iterations_since(ali3_instance *in, int64_t before);
ALI3_PER_WIDTH void ali3_accelerate(ali3_instance *in, truth mixes);
#endif
