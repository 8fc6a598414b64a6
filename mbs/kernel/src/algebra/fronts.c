/* Multifrontal L D L' of the tangent: dense column-major fronts, no pivoting, Schur complements added into the parent.
 * In the columns of its pivots a factorised front holds L below the diagonal and 1/D on it. */
#include "fronts.h"
#include "../instance.h"
#include "front_block.h"
#include "processor.h"

/* target -= f[0] c + f[1] c1 + ... of `count` columns of length n, from entry `from` on, so that a column of the target
 * is loaded and stored once. Four are one sum, fewer are subtracted in turn. */
ALI3_INLINED void subtract(real *restrict target, const real *restrict c, int32_t n, const real *f, int32_t count,
                           int32_t from) {
  const real *restrict c1 = c + n, *restrict c2 = c1 + n, *restrict c3 = c2 + n;
  if (count == PANEL) {
    ALI3_BY_FOURS
    for (int32_t i = from; i < n; i++) target[i] -= (f[0] * c[i] + f[1] * c1[i]) + (f[2] * c2[i] + f[3] * c3[i]);
  } else if (count == 3) {
    ALI3_BY_FOURS
    for (int32_t i = from; i < n; i++) target[i] = ((target[i] - f[0] * c[i]) - f[1] * c1[i]) - f[2] * c2[i];
  } else if (count == 2) {
    ALI3_BY_FOURS
    for (int32_t i = from; i < n; i++) target[i] = (target[i] - f[0] * c[i]) - f[1] * c1[i];
  } else if (count == 1) {
    ALI3_BY_FOURS
    for (int32_t i = from; i < n; i++) target[i] -= f[0] * c[i];
  }
}

/* Pivots `start` to start + count - 1: first the columns of the panel among themselves, then column j of the rest loses
 * L_jp times the unscaled column p, so that the inner loops run down columns. */
ALI3_INLINED ali3_status eliminate_panel(ali3_instance *in, real *block, int32_t first, int32_t start, int32_t count,
                                         int32_t n) {
  real *panel = block + (int64_t)start * n, inverse[PANEL], factor[PANEL];
  for (int32_t p = 0; p < count; p++) {
    real *column = panel + (int64_t)p * n;
    for (int32_t k = 0; k < p; k++) factor[k] = panel[(int64_t)k * n + start + p] * inverse[k];
    subtract(column, panel, n, factor, p, start + p);
    const ali3_status status = ali3_check_pivot(in, first + start + p, column[start + p]);
    if (status != ALI3_OK) return status;
    inverse[p] = 1.0 / column[start + p];
  }
  for (int32_t j = start + count; j < n; j++) {
    for (int32_t k = 0; k < count; k++) factor[k] = panel[(int64_t)k * n + j] * inverse[k];
    subtract(block + (int64_t)j * n, panel, n, factor, count, j);
  }
  for (int32_t p = 0; p < count; p++) {
    real *column = panel + (int64_t)p * n;
    ALI3_BY_FOURS
    for (int32_t i = start + p + 1; i < n; i++) column[i] *= inverse[p];
    column[start + p] = inverse[p];
  }
  return ALI3_OK;
}

ALI3_INLINED ali3_status eliminate(ali3_instance *in, real *block, int32_t first, int32_t n_pivot, int32_t n) {
  ali3_status status = ALI3_OK;
  int32_t p = 0;
  for (; p + PANEL <= n_pivot && status == ALI3_OK; p += PANEL) status = eliminate_panel(in, block, first, p, PANEL, n);
  if (status != ALI3_OK || p == n_pivot) return status;
  switch (n_pivot - p) {
  case 1:
    return eliminate_panel(in, block, first, p, 1, n);
  case 2:
    return eliminate_panel(in, block, first, p, 2, n);
  default:
    return eliminate_panel(in, block, first, p, 3, n);
  }
}

/* The Schur complement of a front is added into its parent. */
ALI3_INLINED void assemble(const real *block, const int32_t *map, int32_t n_pivot, int32_t n, real *parent,
                           int32_t parent_n) {
  for (int32_t j = n_pivot; j < n; j++) {
    const real *restrict column = block + (int64_t)j * n;
    real *restrict target = parent + (int64_t)map[j] * parent_n;
    if (map[n - 1] - map[j] == n - 1 - j) { /* side by side there too */
      ali3_add(target + map[j], column + j, n - j);
      continue;
    }
    for (int32_t i = j; i < n; i++) target[map[i]] += column[i];
  }
}

ALI3_INLINED ali3_status factorise(ali3_instance *in, real *F) {
  const ali3_system *S = in->system;
  ALI3_COUNT(in, factorizations);
  ALI3_COUNT_ANEW(in, negative_pivots);
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t first = S->front_col[f], n_pivot = S->front_col[f + 1] - first,
                  n = S->front_ptr[f + 1] - S->front_ptr[f], parent = S->front_parent[f];
    real *block = F + S->front_off[f];
    const ali3_status status = eliminate(in, block, first, n_pivot, n);
    if (status != ALI3_OK) return status;
    if (parent >= 0)
      assemble(block, S->front_map + S->front_ptr[f], n_pivot, n, F + S->front_off[parent],
               S->front_ptr[parent + 1] - S->front_ptr[parent]);
  }
  return ALI3_OK;
}

/* x becomes L^-1' x front by front; `far`: sums from the far end, for large fronts. */
ALI3_INLINED void substitute_back(ali3_instance *in, const real *F, real *b, bool far) {
  const ali3_system *S = in->system;
  real *restrict x = in->local;
  for (int32_t f = S->size.nf - 1; f >= 0; f--) {
    const int32_t first = S->front_col[f], n_pivot = S->front_col[f + 1] - first;
    const int32_t n = S->front_ptr[f + 1] - S->front_ptr[f], *idx = S->front_idx + S->front_ptr[f];
    for (int32_t i = n_pivot; i < n; i++) x[i] = b[idx[i]];
    const real *block = F + S->front_off[f];
    for (int64_t p = n_pivot - 1; p >= 0; p--) {
      const real *after = block + p * n + p + 1;
      const real taken =
          far ? ali3_product_from_far(after, x + p + 1, n - p - 1) : ali3_product_in_two(after, x + p + 1, n - p - 1);
      x[p] = b[first + p] * after[-1] - taken;
      b[first + p] = x[p];
    }
  }
}

/* b becomes the solution. The pivots of a front lie side by side in b. */
ALI3_INLINED void solve(ali3_instance *in, const real *F, real *b) {
  const ali3_system *S = in->system;
  real *restrict x = in->local;
  ALI3_COUNT(in, solves);
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t first = S->front_col[f], n_pivot = S->front_col[f + 1] - first;
    const int32_t n = S->front_ptr[f + 1] - S->front_ptr[f], *idx = S->front_idx + S->front_ptr[f];
    ali3_copy(x, b + first, n_pivot);
    for (int32_t i = n_pivot; i < n; i++) x[i] = b[idx[i]];
    ali3_front_forward(F + S->front_off[f], x, n_pivot, n);
    ali3_copy(b + first, x, n_pivot);
    for (int32_t i = n_pivot; i < n; i++) b[idx[i]] = x[i];
  }
  if (S->n_flexible > 0)
    substitute_back(in, F, b, true);
  else
    substitute_back(in, F, b, false);
}

ALI3_BY_PROCESSOR(in->system, ali3_status, factorise, (ali3_instance * in, real *F), (in, F))

ALI3_BY_PROCESSOR(in->system, void, solve, (ali3_instance * in, const real *F, real *b), (in, F, b))
