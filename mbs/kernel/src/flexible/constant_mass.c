/* M x of the constant mass matrix. */
#include "../instance.h"
#include "mass.h"

void ali3_constant_mass_times(const ali3_instance *in, const real *x, real *out) {
  const ali3_system *S = in->system;
  const real *val = in->mass_val;
  const int32_t *ptr = S->mass_ptr, *col = S->mass_col;
  for (int32_t i = 0; i < S->size.nq; i++) {
    real sum = {0};
    for (int32_t k = ptr[i]; k < ptr[i + 1]; k++) sum += val[k] * x[col[k]];
    out[i] = sum;
  }
}
