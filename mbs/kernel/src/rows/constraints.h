/* Rows, their gradients and second derivatives, and products with them. */
#ifndef ALI3_CONSTRAINTS_H
#define ALI3_CONSTRAINTS_H
#include "../algebra/real.h"
#include "../instance.h"

ALI3_PER_WIDTH const real *ali3_near_origin(ali3_instance *in, const real *q);
ALI3_PER_WIDTH void ali3_constraints(ali3_instance *in, const real *q, const real *s, real *Phi, real *J);
ALI3_PER_WIDTH void ali3_constraint_rate(ali3_instance *in, const real *q, const ali3_vectors *guides, real *Phit);
ALI3_PER_WIDTH void ali3_constraint_gamma(ali3_instance *in, const real *q, const real *qd, const ali3_vectors *guides,
                                          real *gamma);
ALI3_PER_WIDTH void ali3_geometric(ali3_instance *in, const real *q, const real *s, const real *lam, double weight,
                                   real *F);

/* row_products.c */
ALI3_PER_WIDTH void ali3_rows_square(ali3_instance *in, const real *J, double weight, real *F);
ALI3_PER_WIDTH void ali3_rows_product(ali3_instance *in, const real *A, const real *J, double weight, real *F);
ALI3_PER_WIDTH void ali3_rows_times(const ali3_system *S, const real *J, const real *x, real *out);
ALI3_PER_WIDTH void ali3_rows_transposed(const ali3_system *S, const real *J, const real *w,
                                         real *out); /* out = J' w */
#endif
