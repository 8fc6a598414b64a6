/* Multifrontal L D L' of the tangent: dense column-major fronts, no pivoting, Schur complements added into the parent.
 * In the columns of its pivots a factorised front holds L below the diagonal and 1/D on it. */
#include <math.h>

#include "ali3_internal.h"

/* One pivot at a time: column j of the rest loses L_jp times the unscaled column p, so the inner loop is an axpy. */
static ali3_status eliminate(ali3_instance *in, double *block, int32_t first, int32_t n_pivot, int32_t n) {
  for (int32_t p = 0; p < n_pivot; p++) {
    double *column = block + (int64_t)p * n;
    const double d = column[p];
    if (!(fabs(d) > 1e-14 * in->system->mass_floor[first + p]) || !(fabs(d) < 1e300)) {
      in->report.worst_coordinate = first + p;
      return d == d ? ALI3_SINGULAR : ALI3_NOT_FINITE;
    }
    if (d < 0.0) in->report.negative_pivots++;
    const double inverse = 1.0 / d;
    for (int32_t j = p + 1; j < n; j++) {
      const double factor = column[j] * inverse;
      double *target = block + (int64_t)j * n;
      for (int32_t i = j; i < n; i++) target[i] -= factor * column[i];
    }
    for (int32_t i = p + 1; i < n; i++) column[i] *= inverse;
    column[p] = inverse;
  }
  return ALI3_OK;
}

ali3_status ali3_factorise(ali3_instance *in, double *F) {
  const ali3_system *S = in->system;
  in->report.factorizations++;
  in->report.negative_pivots = 0;
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t first = S->front_col[f], n_pivot = S->front_col[f + 1] - first,
                  n = S->front_ptr[f + 1] - S->front_ptr[f];
    const int32_t *map = S->front_map + S->front_ptr[f], parent = S->front_parent[f];
    double *block = F + S->front_off[f];
    const ali3_status status = eliminate(in, block, first, n_pivot, n);
    if (status != ALI3_OK) return status;
    if (parent < 0) continue;
    const int32_t parent_n = S->front_ptr[parent + 1] - S->front_ptr[parent];
    for (int32_t j = n_pivot; j < n; j++) {
      const double *column = block + (int64_t)j * n;
      double *target = F + S->front_off[parent] + (int64_t)map[j] * parent_n;
      for (int32_t i = j; i < n; i++) target[map[i]] += column[i];
    }
  }
  return ALI3_OK;
}

/* b becomes the solution. */
void ali3_solve(ali3_instance *in, const double *F, double *b) {
  const ali3_system *S = in->system;
  double *x = in->local;
  in->report.solves++;
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t first = S->front_col[f], n_pivot = S->front_col[f + 1] - first,
                  n = S->front_ptr[f + 1] - S->front_ptr[f];
    const int32_t *idx = S->front_idx + S->front_ptr[f];
    const double *block = F + S->front_off[f];
    for (int32_t i = 0; i < n; i++) x[i] = b[idx[i]];
    for (int32_t p = 0; p < n_pivot; p++) {
      const double *column = block + (int64_t)p * n, value = x[p];
      for (int32_t i = p + 1; i < n; i++) x[i] -= column[i] * value;
    }
    for (int32_t p = 0; p < n_pivot; p++) x[p] *= block[(int64_t)p * n + p];
    for (int32_t i = 0; i < n; i++) b[idx[i]] = x[i];
  }
  for (int32_t f = S->size.nf - 1; f >= 0; f--) {
    const int32_t first = S->front_col[f], n_pivot = S->front_col[f + 1] - first,
                  n = S->front_ptr[f + 1] - S->front_ptr[f];
    const int32_t *idx = S->front_idx + S->front_ptr[f];
    const double *block = F + S->front_off[f];
    for (int32_t i = 0; i < n; i++) x[i] = b[idx[i]];
    for (int32_t p = n_pivot - 1; p >= 0; p--) {
      const double *column = block + (int64_t)p * n;
      double even = x[p], odd = 0.0; /* two sums, so that additions need not wait for each other */
      int32_t i = p + 1;
      for (; i + 1 < n; i += 2) {
        even -= column[i] * x[i];
        odd -= column[i + 1] * x[i + 1];
      }
      if (i < n) even -= column[i] * x[i];
      x[p] = even + odd;
      b[first + p] = x[p];
    }
  }
}
