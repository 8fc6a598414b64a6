/* Rows on velocities, A(q) qd = 0 (velocity_rows.c); A and J in the row pattern. The functions leave other rows as they
 * are. */
#ifndef ALI3_VELOCITY_ROWS_H
#define ALI3_VELOCITY_ROWS_H
#include "../algebra/real.h"
#include "../instance.h"

/* Phi = 0, J += what the coordinates q add to A. */
ALI3_PER_WIDTH void ali3_velocity_jacobian(const ali3_instance *in, const real *q, real *Phi, real *J);
/* gamma = d(A)/dt qd */
ALI3_PER_WIDTH void ali3_velocity_gamma(const ali3_instance *in, const real *qd, real *gamma);
/* Phi = A v / rate */
ALI3_PER_WIDTH void ali3_velocity_values(const ali3_instance *in, const real *A, const real *v, double rate, real *Phi);
/* For a step D with A of its middle: Phi = A D, and J its exact derivative, A + sum of h D_b / 2. */
ALI3_PER_WIDTH void ali3_velocity_middle(const ali3_instance *in, const real *A, const real *D, real *Phi, real *J);
/* J = 0: positions do not satisfy these rows. */
ALI3_PER_WIDTH void ali3_velocity_release(const ali3_instance *in, real *J);
#endif
