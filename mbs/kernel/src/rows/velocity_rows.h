/* Rows on velocities. */
#ifndef ALI3_VELOCITY_ROWS_H
#define ALI3_VELOCITY_ROWS_H
#include "../instance.h"

void ali3_velocity_jacobian(const ali3_instance *in, const double *q, double *Phi, double *J);
void ali3_velocity_gamma(const ali3_instance *in, const double *qd, double *gamma);
void ali3_velocity_values(const ali3_instance *in, const double *A, const double *v, double rate, double *Phi);
void ali3_velocity_middle(const ali3_instance *in, const double *A, const double *D, double *Phi, double *J);
void ali3_velocity_release(const ali3_instance *in, double *J);
#endif
