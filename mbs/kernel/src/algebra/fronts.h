/* Symmetric and unsymmetric factorization of the fronts. */
#ifndef ALI3_FRONTS_H
#define ALI3_FRONTS_H
#include "../instance.h"
#include "real.h"

ali3_status ali3_factorise(ali3_instance *in, real *F);
void ali3_solve(ali3_instance *in, const real *F, real *b);
void ali3_mirror(const ali3_instance *in, double *F);
ali3_status ali3_factorise_lu(ali3_instance *in, int32_t width, double *F);
void ali3_solve_lu(ali3_instance *in, int32_t width, const double *F, double *b);
#endif
