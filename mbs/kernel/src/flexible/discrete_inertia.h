/* Discrete inertia forces of flexible bodies. */
#ifndef ALI3_DISCRETE_INERTIA_H
#define ALI3_DISCRETE_INERTIA_H
#include "../instance.h"

void ali3_flexible_momentum(const ali3_instance *in, const double *q, const double *v, double *p);
void ali3_discrete_inertia(const ali3_instance *in, double h, const double *p0, const double *p1, const double *mean,
                           const double *half, double *r);
#endif
