/* Projections of velocities and accelerations. */
#ifndef ALI3_PROJECTION_H
#define ALI3_PROJECTION_H
#include "../instance.h"

bool ali3_rates_closed(ali3_instance *in, const double *b, const double *v, double tolerance, double *violation);
double ali3_project(ali3_instance *in, double factor, const double *b, double *v, double *lam, double tolerance,
                    int32_t sweeps);
#endif
