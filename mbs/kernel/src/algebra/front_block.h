/* Operations on a front that the symmetric and the unsymmetric factorization share: check of a pivot, forward
 * substitution, gather and scatter of unknowns. */
#ifndef ALI3_FRONT_BLOCK_H
#define ALI3_FRONT_BLOCK_H
#include <math.h>

#include "../instance.h"
#include "number_pairs.h"
#include "processor.h"
#include "real.h"

enum { PANEL = 4 }; /* pivots that are eliminated together */

#ifdef ALI3_WIDTH
/* Checks a pivot in every lane: one with a bad pivot is marked in in->singular; the others continue. */
static inline ali3_status ali3_check_pivot(ali3_instance *in, int32_t coordinate, real d) {
  const lane_mask good = (ali3_abs(d) > 1e-14 * in->mass.floor[coordinate]) & (ali3_abs(d) < 1e300);
  *in->singular |= ~good & *in->at_work;
  *in->report.negative_pivots -= good & (d < 0.0) & *in->at_work;
  return ALI3_OK;
}
#else
/* Checks that a pivot d is finite and does not vanish relative to the mass of its coordinate; counts negative ones. */
static inline ali3_status ali3_check_pivot(ali3_instance *in, int32_t coordinate, double d) {
  if (fabs(d) > 1e-14 * in->mass.floor[coordinate] && fabs(d) < 1e300) {
    if (d < 0.0) in->report.negative_pivots++;
    return ALI3_OK;
  }
  in->report.worst_coordinate = coordinate;
  return d == d ? ALI3_SINGULAR : ALI3_NOT_FINITE;
}
#endif

/* Forward substitution by two columns at a time: x becomes L^-1 x in the pivots, and is reduced by them below. */
ALI3_INLINED void ali3_front_forward(const real *block, real *restrict x, int32_t n_pivot, int32_t n) {
  int64_t p = 0;
  for (; p + 1 < n_pivot; p += 2) {
    const real *a = block + p * n;
    const real *restrict b = a + n;
    const real first = x[p], second = x[p + 1] - a[p + 1] * first;
    x[p + 1] = second;
    ali3_subtract_two_multiples(x + p + 2, a + p + 2, first, b + p + 2, second, n - p - 2);
  }
  if (p < n_pivot) ali3_add_multiple(x + p + 1, block + p * n + p + 1, -x[p], n - p - 1);
}

/* Gathers the unknowns of a front from b, `width` for each coordinate: first its pivots, then the others. If there are
 * only pivots they are contiguous in b and not copied. */
ALI3_INLINED real *ali3_front_unknowns(ali3_instance *in, int32_t f, int32_t width, real *b) {
  const ali3_system *S = in->system;
  const int32_t first = S->front_col[f], n_pivot = S->front_col[f + 1] - first;
  const int32_t n = S->front_ptr[f + 1] - S->front_ptr[f], *idx = S->front_idx + S->front_ptr[f];
  real *restrict x = in->tangent.local;
  if (n == n_pivot) return b + width * first;
  for (int32_t i = 0; i < n; i++)
    for (int32_t s = 0; s < width; s++) x[width * i + s] = b[width * idx[i] + s];
  return x;
}

/* Scatters the unknowns of a front to b: all, or its pivots only. */
ALI3_INLINED void ali3_front_put_back(const ali3_instance *in, int32_t f, int32_t width, const real *x, bool all,
                                      real *restrict b) {
  const ali3_system *S = in->system;
  const int32_t n_pivot = S->front_col[f + 1] - S->front_col[f];
  const int32_t n = S->front_ptr[f + 1] - S->front_ptr[f], *idx = S->front_idx + S->front_ptr[f];
  for (int32_t i = 0, end = n == n_pivot ? 0 : all ? n : n_pivot; i < end; i++)
    for (int32_t s = 0; s < width; s++) b[width * idx[i] + s] = x[width * i + s];
}
#endif
