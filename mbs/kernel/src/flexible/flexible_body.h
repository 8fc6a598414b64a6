/* Flexible bodies, without the constant part of their mass matrix. ali3_flexible_prepare stores quantities at one q,
 * which the others use. */
#ifndef ALI3_FLEXIBLE_BODY_H
#define ALI3_FLEXIBLE_BODY_H
#include "../algebra/real.h"
#include "../instance.h"

/* Stores the quantities at q (nq). */
ALI3_PER_WIDTH void ali3_flexible_prepare(const ali3_instance *in, const real *q);
/* out += (M(q) - constant part) x at the prepared q. */
ALI3_PER_WIDTH void ali3_flexible_mass_times(const ali3_instance *in, const real *x, real *out);
/* Adds inertia forces quadratic in qd, gravity, elastic and damping forces to Q; `discrete`: for discrete gradients,
 * without the inertia forces. */
ALI3_PER_WIDTH void ali3_flexible_forces(const ali3_instance *in, const real *q, const real *qd, bool discrete,
                                         real *Q);
/* Adds the potential energy of gravity, except its constant part, and the elastic energy, J. */
void ali3_flexible_energy(const ali3_instance *in, const double *q, double *gravity, double *elastic);
/* F += wM (M(q) - constant part) + wC C + wK K at the prepared q, lower triangles in front storage; K includes the
 * geometric stiffness of gravity. */
ALI3_PER_WIDTH void ali3_flexible_tangent(const ali3_instance *in, double wM, double wC, double wK, real *F);
/* F += weight K without the geometric stiffness of gravity, lower triangles in front storage. */
void ali3_flexible_stiffen(const ali3_instance *in, double weight, double *F);
/* out (nq) += weight K x, K likewise. */
void ali3_flexible_elastic(const ali3_instance *in, double weight, const double *x, double *out);
#endif
