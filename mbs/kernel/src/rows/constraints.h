/* Rows, their gradients and second derivatives, and products with them. */
#ifndef ALI3_CONSTRAINTS_H
#define ALI3_CONSTRAINTS_H
#include "../instance.h"

void ali3_constraints(ali3_instance *in, const double *q, const double *s, double *Phi, double *J);
void ali3_constraint_rate(ali3_instance *in, const double *q, const ali3_vectors *guides, double *Phit);
void ali3_constraint_gamma(ali3_instance *in, const double *q, const double *qd, const ali3_vectors *guides,
                           double *gamma);
void ali3_geometric(ali3_instance *in, const double *q, const double *s, const double *lam, double weight, double *F);
void ali3_rows_square(ali3_instance *in, const double *J, double weight, double *F);
void ali3_rows_product(ali3_instance *in, const double *A, const double *J, double weight, double *F);
void ali3_rows_times(const ali3_system *S, const double *J, const double *x, double *out);
void ali3_rows_transposed(const ali3_system *S, const double *J, const double *w, double *out); /* out = J' w */
#endif
