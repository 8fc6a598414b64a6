/* Products with Phi_q, row by row: squares in front storage, and vectors. Without one index for three coordinates where
 * rows are in triples, a step has 7 % (lane change, 10 ms) to 8.6 % (spatial chain) more instructions. */
#include <string.h>

#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../algebra/real.h"
#include "../instance.h"
#include "constraints.h"

/* Three columns of weight J' J, of entries j to j + 2 of a row of triples that ends before `end`. */
ALI3_INLINED void add_triple(real *block, int64_t n, const real *J, int32_t j, int32_t end, const int32_t *loc,
                             double weight) {
  const real x = weight * J[j], y = weight * J[j + 1], z = weight * J[j + 2];
  real *restrict a = block + loc[j] * n, *restrict b = a + n, *restrict c = b + n;
  const int32_t own = loc[j];
  a[own] += x * J[j];
  a[own + 1] += x * J[j + 1];
  a[own + 2] += x * J[j + 2];
  b[own + 1] += y * J[j + 1];
  b[own + 2] += y * J[j + 2];
  c[own + 2] += z * J[j + 2];
  for (int32_t i = j + 3; i < end; i += 3) {
    ali3_triple_add(a + loc[i], J + i, x);
    ali3_triple_add(b + loc[i], J + i, y);
    ali3_triple_add(c + loc[i], J + i, z);
  }
}

/* target += f[0] a + f[1] b + f[2] c + f[3] d, entry by entry in this order. */
ALI3_INLINED void add_four(real *restrict target, const real *restrict a, const real *restrict b,
                           const real *restrict c, const real *restrict d, const real *f, int64_t count) {
  ALI3_BY_FOURS
  for (int64_t i = 0; i < count; i++)
    target[i] = (((target[i] + f[0] * a[i]) + f[1] * b[i]) + f[2] * c[i]) + f[3] * d[i];
}

/* Adds weight J' J of four rows with the same stretch (see row_stretch of ali3_system) to a front of n coordinates:
 * before the stretch row by row, in its columns all four at once. */
ALI3_INLINED void add_square_of_four(const ali3_system *S, const int32_t *rows, const real *J, double weight,
                                     real *block, int64_t n) {
  const int32_t *ptr = S->row_ptr, *first = S->row_stretch, *loc = S->row_loc, k = rows[0];
  const int32_t length = ptr[k + 1] - first[k];
  for (const int32_t *at = rows; at < rows + 4; at++)
    for (int32_t row = *at, j = ptr[row]; j < first[row]; j++) {
      real *restrict column = block + (int64_t)loc[j] * n;
      const real factor = weight * J[j];
      for (int32_t i = j; i < first[row]; i++) column[loc[i]] += factor * J[i];
      ali3_add_multiple(column + loc[first[row]], J + first[row], factor, length);
    }
  const real *a = J + first[k], *b = J + first[rows[1]], *c = J + first[rows[2]], *d = J + first[rows[3]];
  for (int64_t j = 0; j < length; j++) {
    const real factor[4] = {weight * a[j], weight * b[j], weight * c[j], weight * d[j]};
    int64_t from = j < 3 ? j : ali3_padded_start_unclipped(j, length);
    real *column = block + (loc[first[k]] + j) * n + loc[first[k]] + from;
    add_four(column, a + from, b + from, c + from, d + from, factor, length - from);
  }
}

/* F += weight * J' J, front by front and row by row. */
ALI3_INLINED void rows_square(ali3_instance *in, const real *J, double weight, real *F) {
  const ali3_system *S = in->system;
  const int32_t *ptr = S->row_ptr, *loc = S->row_loc;
  for (int32_t at = 0; at < S->size.nc; at++) {
    const int32_t k = S->front_row[at], f = S->row_front[k], n = S->front_ptr[f + 1] - S->front_ptr[f],
                  end = ptr[k + 1];
    real *block = F + S->front_off[f];
    if (S->row_alike[at] >= 4) {
      add_square_of_four(S, S->front_row + at, J, weight, block, n);
      at += 3;
      continue;
    }
    if (S->row_triples[k]) {
      for (int32_t j = ptr[k]; j < end; j += 3) add_triple(block, n, J, j, end, loc, weight);
      continue;
    }
    for (int32_t j = ptr[k]; j < end; j++) {
      real *column = block + (int64_t)loc[j] * n;
      const real factor = weight * J[j];
      ALI3_SHORT
      for (int32_t i = j; i < end; i++) column[loc[i]] += factor * J[i];
    }
  }
}

ALI3_BY_PROCESSOR(in->system, void, rows_square, (ali3_instance * in, const real *J, double weight, real *F),
                  (in, J, weight, F))

void ali3_rows_product(ali3_instance *in, const real *A, const real *J, double weight, real *F) {
  const ali3_system *S = in->system;
  for (int32_t k = 0; k < S->size.nc; k++) {
    const int32_t f = S->row_front[k], n = S->front_ptr[f + 1] - S->front_ptr[f], end = S->row_ptr[k + 1];
    real *block = F + S->front_off[f];
    for (int32_t j = S->row_ptr[k]; j < end; j++) {
      real *column = block + (int64_t)S->row_loc[j] * n;
      const real factor = weight * J[j];
      ALI3_SHORT
      for (int32_t i = S->row_ptr[k]; i < end; i++) column[S->row_loc[i]] += factor * A[i];
    }
  }
}

ALI3_INLINED void rows_times(const ali3_system *S, const real *J, const real *x, real *out) {
  if (ALI3_GENERATED(S, rows_times, (J, x, out))) return;
  const int32_t *ptr = S->row_ptr, *col = S->row_col;
  for (int32_t k = 0; k < S->size.nc; k++) {
    const int32_t end = ptr[k + 1];
    real sum = {0};
    int32_t i = ptr[k];
    if (S->row_triples[k]) {
      ALI3_SHORT
      for (; i < end; i += 3) sum = ali3_points_sum(sum, J + i, x + col[i]);
    } else {
      ALI3_SHORT
      for (; i < S->row_stretch[k]; i++) sum += J[i] * x[col[i]];
      if (i < end) sum += ali3_product_backward(J + i, x + col[i], end - i);
    }
    out[k] = sum;
  }
}

ALI3_BY_PROCESSOR(S, void, rows_times, (const ali3_system *S, const real *J, const real *x, real *out), (S, J, x, out))

ALI3_INLINED void rows_transposed(const ali3_system *S, const real *J, const real *w, real *out) {
  if (ALI3_GENERATED(S, rows_transposed, (J, w, out))) return;
  const int32_t *ptr = S->row_ptr, *col = S->row_col;
  memset(out, 0, (size_t)S->size.nq * sizeof *out);
  for (int32_t k = 0; k < S->size.nc; k++) {
    const int32_t end = ptr[k + 1];
    const real weight = w[k];
    int32_t i = ptr[k];
    ALI3_SHORT
    for (const int32_t points = S->row_triples[k] ? end : i; i < points; i += 3)
      ali3_triple_add(out + col[i], J + i, weight);
    ALI3_SHORT
    for (; i < S->row_stretch[k]; i++) out[col[i]] += J[i] * weight;
    if (i < end) ali3_add_multiple(out + col[i], J + i, weight, end - i);
  }
}

ALI3_BY_PROCESSOR(S, void, rows_transposed, (const ali3_system *S, const real *J, const real *w, real *out),
                  (S, J, w, out))
