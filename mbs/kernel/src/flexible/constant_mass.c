/* Product M x of the constant mass matrix with a vector. */
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../instance.h"
#include "mass.h"

enum { MANY = 8 }; /* least number of rows with equal columns for which they are summed column by column */

/* Adds four columns times their entries of x to `out`, one after the other. */
ALI3_INLINED void add_columns(const real *val, const int32_t *mirror, const real *x, const int32_t *col, int32_t n,
                              real *restrict out) {
  const real *restrict a = val + mirror[0], *restrict b = val + mirror[1], *restrict c = val + mirror[2],
                       *restrict d = val + mirror[3];
  const real w = x[col[0]], y = x[col[1]], z = x[col[2]], v = x[col[3]];
  ALI3_BY_FOURS
  for (int32_t j = 0; j < n; j++) out[j] = (((out[j] + w * a[j]) + y * b[j]) + z * c[j]) + v * d[j];
}

/* Writes rows i to i + n - 1 of M x, which have the same columns. */
ALI3_INLINED void add_rows(const ali3_instance *in, int32_t i, int32_t n, const real *x, real *out) {
  const ali3_system *S = in->system;
  const real *val = in->mass.val, none = {0};
  const int32_t *col = S->mass_col, end = S->mass_ptr[i + 1];
  for (int32_t j = i; j < i + n; j++) out[j] = none;
  int32_t k = S->mass_ptr[i];
  for (; k + 3 < end; k += 4) add_columns(val, S->mass_mirror + k, x, col + k, n, out + i);
  for (; k < end; k++) ali3_add_multiple(out + i, val + S->mass_mirror[k], x[col[k]], n);
}

/* Rows with the same columns, as the modes of a flexible body have, are summed together, column by column: M is
 * symmetric, so the entries of a column are contiguous in its row. Stretches of contiguous columns are summed four at a
 * time. */
ALI3_INLINED void constant_mass_times(const ali3_instance *in, const real *x, real *out) {
  const ali3_system *S = in->system;
  if (in->mass.isotropic && ALI3_GENERATED(S, mass_times, (in->mass.val, x, out))) return;
  const real *val = in->mass.val;
  const int32_t *ptr = S->mass_ptr, *col = S->mass_col;
  for (int32_t i = 0; i < S->size.nq; i++) {
    const int32_t alike = S->mass_alike[i];
    real sum = {0};
    if (alike == 0 && in->mass.isotropic) {
      ali3_three three = {0};
      ALI3_SHORT
      for (int32_t k = ptr[i]; k < ptr[i + 1]; k++) ali3_three_add(&three, x + col[k], val[k]);
      ali3_three_put(out + i, &three);
      i += 2;
      continue;
    }
    if (alike >= MANY) {
      add_rows(in, i, alike, x, out);
      i += alike - 1;
      continue;
    }
    int32_t k = ptr[i];
    if (S->mass_stretch[2 * i] < ptr[i + 1]) {
      const int32_t first = S->mass_stretch[2 * i], last = S->mass_stretch[2 * i + 1];
      for (; k < first; k++) sum += val[k] * x[col[k]];
      sum += ali3_product_backward(val + first, x + col[first], last - first);
      k = last;
    }
    ALI3_SHORT
    for (; k < ptr[i + 1]; k++) sum += val[k] * x[col[k]];
    out[i] = sum;
  }
}

ALI3_BY_PROCESSOR(in->system, void, constant_mass_times, (const ali3_instance *in, const real *x, real *out),
                  (in, x, out))
