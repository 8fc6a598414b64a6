/* Rows, their gradients and second derivatives, and products with them. */
#ifndef ALI3_CONSTRAINTS_H
#define ALI3_CONSTRAINTS_H
#include "../algebra/real.h"
#include "../instance.h"

/* Coordinates (nq) at which rows are evaluated: q, or in->step.shifted, a copy shifted horizontally or vertically by
 * multiples of 64 m, for scenes that a translation does not change. */
ALI3_PER_WIDTH const real *ali3_near_origin(ali3_instance *in, const real *q);
/* Rows Phi (nc) and Phi_q in the row pattern, J (nnz_rows), at coordinates q (nq) and driving functions s (ng); rows
 * that are off are zero. */
ALI3_PER_WIDTH void ali3_constraints(ali3_instance *in, const real *q, const real *s, real *Phi, real *J);
/* Phit (nc): partial derivative of Phi with respect to time, by the rates of driving functions. */
ALI3_PER_WIDTH void ali3_constraint_rate(ali3_instance *in, const real *q, const ali3_vectors *driving, real *Phit);
/* gamma (nc) = d(Phi_q)/dt qd + d(Phi_t)/dt, so that Phi'' = Phi_q qdd + gamma. */
ALI3_PER_WIDTH void ali3_constraint_gamma(ali3_instance *in, const real *q, const real *qd, const ali3_vectors *driving,
                                          real *gamma);
/* F += weight * sum_k lam_k d2(Phi_k)/dq2, lower triangles in front storage. */
ALI3_PER_WIDTH void ali3_geometric(ali3_instance *in, const real *q, const real *s, const real *lam, double weight,
                                   real *F);

/* Products with Phi_q; J, A: row pattern. F += weight * J' J, lower triangles in front storage. */
ALI3_PER_WIDTH void ali3_rows_square(ali3_instance *in, const real *J, double weight, real *F);
/* F += weight * A' J, both triangles. */
ALI3_PER_WIDTH void ali3_rows_product(ali3_instance *in, const real *A, const real *J, double weight, real *F);
/* out (nc) = J x */
ALI3_PER_WIDTH void ali3_rows_times(const ali3_system *S, const real *J, const real *x, real *out);
/* out (nq) = J' w */
ALI3_PER_WIDTH void ali3_rows_transposed(const ali3_system *S, const real *J, const real *w, real *out);
#endif
