/* Products with the mass matrix M(q) (nq x nq) at the last prepared q. */
#ifndef ALI3_MASS_H
#define ALI3_MASS_H
#include "../algebra/real.h"
#include "../instance.h"

/* out = (constant part of M) x */
ALI3_PER_WIDTH void ali3_constant_mass_times(const ali3_instance *in, const real *x, real *out);
/* out = M x */
ALI3_PER_WIDTH void ali3_mass_times(const ali3_instance *in, const real *x, real *out);
/* Copies the constant part of M to the fronts, lower triangles. */
void ali3_mass_to_fronts(const ali3_instance *in, double *F);
/* a' M b; M b stays in `work` (nq). */
double ali3_mass_product(const ali3_instance *in, const double *a, const double *b, double *work);
#endif
