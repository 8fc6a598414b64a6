/* Multifrontal L D L' of the tangent: dense column-major fronts, no pivoting, Schur complements added into the parent.
 * In the columns of its pivots a factorised front holds L below the diagonal and 1/D on it. */
#include "fronts.h"
#include "../instance.h"
#include "front_block.h"

static void subtract(real *restrict target, const real *restrict column, real factor, int32_t from, int32_t n) {
  for (int32_t i = from; i < n; i++) target[i] -= factor * column[i];
}

/* Four pivots at once, so that a column is loaded and stored once for eight operations. */
static void subtract_panel(real *restrict target, const real *restrict c, int32_t n, const real f[PANEL],
                           int32_t from) {
  const real *restrict c1 = c + n, *restrict c2 = c + 2 * (int64_t)n, *restrict c3 = c + 3 * (int64_t)n;
  const real f0 = f[0], f1 = f[1], f2 = f[2], f3 = f[3];
  for (int32_t i = from; i < n; i++) target[i] -= (f0 * c[i] + f1 * c1[i]) + (f2 * c2[i] + f3 * c3[i]);
}

/* Panels of pivots: first the columns of the panel among themselves, then column j of the rest loses L_jp times the
 * unscaled column p, so that the inner loops run down columns. */
static ali3_status eliminate(ali3_instance *in, real *block, int32_t first, int32_t n_pivot, int32_t n) {
  for (int32_t start = 0; start < n_pivot; start += PANEL) {
    const int32_t end = start + PANEL < n_pivot ? start + PANEL : n_pivot;
    real *panel = block + (int64_t)start * n, inverse[PANEL], factor[PANEL];
    for (int32_t p = start; p < end; p++) {
      real *column = block + (int64_t)p * n;
      for (int32_t k = start; k < p; k++)
        subtract(column, block + (int64_t)k * n, block[(int64_t)k * n + p] * inverse[k - start], p, n);
      const ali3_status status = ali3_check_pivot(in, first + p, column[p]);
      if (status != ALI3_OK) return status;
      inverse[p - start] = 1.0 / column[p];
    }
    if (end - start == PANEL) {
      for (int32_t j = end; j < n; j++) {
        for (int32_t k = 0; k < PANEL; k++) factor[k] = panel[(int64_t)k * n + j] * inverse[k];
        subtract_panel(block + (int64_t)j * n, panel, n, factor, j);
      }
    } else {
      for (int32_t j = end; j < n; j++)
        for (int32_t p = start; p < end; p++)
          subtract(block + (int64_t)j * n, block + (int64_t)p * n, block[(int64_t)p * n + j] * inverse[p - start], j,
                   n);
    }
    for (int32_t p = start; p < end; p++) {
      real *column = block + (int64_t)p * n;
      for (int32_t i = p + 1; i < n; i++) column[i] *= inverse[p - start];
      column[p] = inverse[p - start];
    }
  }
  return ALI3_OK;
}

ali3_status ali3_factorise(ali3_instance *in, real *F) {
  const ali3_system *S = in->system;
  ALI3_COUNT(in, factorizations);
  ALI3_COUNT_ANEW(in, negative_pivots);
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t first = S->front_col[f], n_pivot = S->front_col[f + 1] - first,
                  n = S->front_ptr[f + 1] - S->front_ptr[f];
    const int32_t *map = S->front_map + S->front_ptr[f], parent = S->front_parent[f];
    real *block = F + S->front_off[f];
    const ali3_status status = eliminate(in, block, first, n_pivot, n);
    if (status != ALI3_OK) return status;
    if (parent < 0) continue;
    const int32_t parent_n = S->front_ptr[parent + 1] - S->front_ptr[parent];
    for (int32_t j = n_pivot; j < n; j++) {
      const real *column = block + (int64_t)j * n;
      real *target = F + S->front_off[parent] + (int64_t)map[j] * parent_n;
      for (int32_t i = j; i < n; i++) target[map[i]] += column[i];
    }
  }
  return ALI3_OK;
}

/* b becomes the solution. */
void ali3_solve(ali3_instance *in, const real *F, real *b) {
  const ali3_system *S = in->system;
  real *restrict x = in->local;
  ALI3_COUNT(in, solves);
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t n_pivot = S->front_col[f + 1] - S->front_col[f], n = S->front_ptr[f + 1] - S->front_ptr[f];
    const int32_t *idx = S->front_idx + S->front_ptr[f];
    for (int32_t i = 0; i < n; i++) x[i] = b[idx[i]];
    ali3_front_forward(F + S->front_off[f], x, n_pivot, n);
    for (int32_t i = 0; i < n; i++) b[idx[i]] = x[i];
  }
  for (int32_t f = S->size.nf - 1; f >= 0; f--) {
    const int32_t first = S->front_col[f], n_pivot = S->front_col[f + 1] - first;
    const int32_t n = S->front_ptr[f + 1] - S->front_ptr[f], *idx = S->front_idx + S->front_ptr[f];
    for (int32_t i = 0; i < n; i++) x[i] = b[idx[i]];
    const real *block = F + S->front_off[f];
    for (int64_t p = n_pivot - 1; p >= 0; p--) {
      const real *column = block + p * n;
      x[p] = x[p] * column[p] - ali3_product_in_two(column + p + 1, x + p + 1, n - p - 1);
      b[first + p] = x[p];
    }
  }
}
