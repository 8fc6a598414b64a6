/* Flexible bodies: ali3_flexible_prepare stores quantities at one q, which the others use. */
#ifndef ALI3_FLEXIBLE_BODY_H
#define ALI3_FLEXIBLE_BODY_H
#include "../algebra/real.h"
#include "../instance.h"

ALI3_PER_WIDTH void ali3_flexible_prepare(const ali3_instance *in, const real *q);
ALI3_PER_WIDTH void ali3_flexible_mass_times(const ali3_instance *in, const real *x, real *out);
ALI3_PER_WIDTH void ali3_flexible_forces(const ali3_instance *in, const real *q, const real *qd, bool discrete,
                                         real *Q);
void ali3_flexible_energy(const ali3_instance *in, const double *q, double *gravity, double *elastic);
ALI3_PER_WIDTH void ali3_flexible_tangent(const ali3_instance *in, double wM, double wC, double wK, real *F);
void ali3_flexible_stiffen(const ali3_instance *in, double weight, double *F);
void ali3_flexible_elastic(const ali3_instance *in, double weight, const double *x, double *out);
#endif
