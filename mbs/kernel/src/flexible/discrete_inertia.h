/* Discrete inertia forces of flexible bodies, without the constant part of M. */
#ifndef ALI3_DISCRETE_INERTIA_H
#define ALI3_DISCRETE_INERTIA_H
#include "../instance.h"

/* p (nq) = M(q) v */
void ali3_flexible_momentum(const ali3_instance *in, const double *q, const double *v, double *p);
/* r += h/2 (p1 - p0) - h^2/2 g with momenta p0, p1; mean: D / h, half: (v1 - v0) / 2 (nq). Requires bodies prepared in
 * the middle of the step. */
void ali3_discrete_inertia(const ali3_instance *in, double h, const double *p0, const double *p1, const double *mean,
                           const double *half, double *r);
#endif
