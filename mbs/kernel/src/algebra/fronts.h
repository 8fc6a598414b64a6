/* Symmetric and unsymmetric factorization of the fronts. */
#ifndef ALI3_FRONTS_H
#define ALI3_FRONTS_H
#include "../instance.h"
#include "real.h"

/* Adds to entry (i, j) of a symmetric block stored as its lower triangle, by columns of `size`. */
static inline void ali3_add_lower(real *block, int32_t size, int32_t i, int32_t j, real value) {
  block[i >= j ? (int64_t)j * size + i : (int64_t)i * size + j] += value;
}

/* L D L' of the tangent F in front storage, in place; counts negative pivots in the report. ALI3_SINGULAR or
 * ALI3_NOT_FINITE with report.worst_coordinate on a bad pivot. */
ALI3_PER_WIDTH ali3_status ali3_factorise(ali3_instance *in, real *F);
/* b (nq) becomes F^-1 b. */
ALI3_PER_WIDTH void ali3_solve(ali3_instance *in, const real *F, real *b);
/* Fills the upper triangles of the fronts from the lower ones. */
void ali3_mirror(const ali3_instance *in, double *F);
/* L U of an unsymmetric F with `width` consecutive unknowns for each coordinate; status as of ali3_factorise. */
ali3_status ali3_factorise_lu(ali3_instance *in, int32_t width, double *F);
/* b (width nq) becomes F^-1 b. */
void ali3_solve_lu(ali3_instance *in, int32_t width, const double *F, double *b);
#endif
