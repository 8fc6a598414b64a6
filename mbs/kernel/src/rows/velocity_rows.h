/* Rows on velocities. */
#ifndef ALI3_VELOCITY_ROWS_H
#define ALI3_VELOCITY_ROWS_H
#include "../algebra/real.h"
#include "../instance.h"

ALI3_PER_WIDTH void ali3_velocity_jacobian(const ali3_instance *in, const real *q, real *Phi, real *J);
ALI3_PER_WIDTH void ali3_velocity_gamma(const ali3_instance *in, const real *qd, real *gamma);
ALI3_PER_WIDTH void ali3_velocity_values(const ali3_instance *in, const real *A, const real *v, double rate, real *Phi);
ALI3_PER_WIDTH void ali3_velocity_middle(const ali3_instance *in, const real *A, const real *D, real *Phi, real *J);
ALI3_PER_WIDTH void ali3_velocity_release(const ali3_instance *in, real *J);
#endif
