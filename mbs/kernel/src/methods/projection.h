/* Projections of velocities and accelerations onto the rows; projection.c describes the functions. */
#ifndef ALI3_PROJECTION_H
#define ALI3_PROJECTION_H
#include "../algebra/real.h"
#include "../instance.h"

ALI3_PER_WIDTH truth ali3_rates_closed(ali3_instance *in, const real *b, const real *v, double tolerance, double known,
                                       real *violation);
ALI3_PER_WIDTH real ali3_project(ali3_instance *in, double factor, const real *b, real *v, real *lam, double tolerance,
                                 double known, int32_t sweeps, bool begun);
#endif
