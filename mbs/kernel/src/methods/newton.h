/* Functions of Newton's iteration that methods share. */
#ifndef ALI3_NEWTON_H
#define ALI3_NEWTON_H
#include "../algebra/real.h"
#include "../instance.h"

#define ALI3_LOST 1.0 /* m: a larger violation is divergence */

/* Penalty alpha of the rows for a step h, s; 1/s^2. */
double ali3_penalty(const ali3_instance *in, double h);
/* Writes the size of the residual r (nq) and of the rows in in->step.Phi, both m, to the report; false: not finite. */
bool ali3_measure_residual(ali3_instance *in, const double *r);
/* Status of a correction that could not be computed; far from the rows a singular tangent is divergence. */
ali3_status ali3_newton_failure(const ali3_instance *in, ali3_status status);
/* Reports the iterations of one step; `before`: report.iterations before it. */
void ali3_iterations_since(ali3_instance *in, int64_t before);
/* Replaces the corrections in in->step.x and in->step.lam by accelerated ones; `enabled`: lanes with an earlier
 * correction. */
ALI3_PER_WIDTH void ali3_accelerate(ali3_instance *in, lane_mask enabled);
#endif
