/* Products with the mass matrix. */
#ifndef ALI3_MASS_H
#define ALI3_MASS_H
#include "../algebra/real.h"
#include "../instance.h"

ALI3_PER_WIDTH void ali3_constant_mass_times(const ali3_instance *in, const real *x, real *out);
ALI3_PER_WIDTH void ali3_mass_times(const ali3_instance *in, const real *x, real *out); /* M of the last q prepared */
/* Copies the constant part of M to the fronts, lower triangles. */
void ali3_mass_to_fronts(const ali3_instance *in, double *F);
/* a' M b with M at the prepared q; M b stays in `work` (nq). */
double ali3_mass_product(const ali3_instance *in, const double *a, const double *b, double *work);
#endif
