/* M x of the constant mass matrix. */
#include "../algebra/processor.h"
#include "../algebra/stretch.h"
#include "../instance.h"
#include "mass.h"

enum { MANY = 8 };

/* Rows with the same columns, those of the modes of a flexible body, are summed side by side, column by column: as M is
 * symmetric, the entries of a column lie side by side in its row. */
ALI3_INLINED void constant_mass_times(const ali3_instance *in, const real *x, real *out) {
  const ali3_system *S = in->system;
  const real *val = in->mass_val;
  const int32_t *ptr = S->mass_ptr, *col = S->mass_col;
  for (int32_t i = 0; i < S->size.nq; i++) {
    const int32_t alike = S->mass_alike[i];
    real sum = {0};
    if (alike >= MANY) {
      for (int32_t j = i; j < i + alike; j++) out[j] = sum;
      for (int32_t k = ptr[i]; k < ptr[i + 1]; k++)
        ali3_add_multiple(out + i, val + S->mass_mirror[k], x[col[k]], alike);
      i += alike - 1;
      continue;
    }
    for (int32_t k = ptr[i]; k < ptr[i + 1]; k++) sum += val[k] * x[col[k]];
    out[i] = sum;
  }
}

ALI3_BY_PROCESSOR(in->system, void, constant_mass_times, (const ali3_instance *in, const real *x, real *out),
                  (in, x, out))
