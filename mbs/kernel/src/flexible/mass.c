/* Products M x with the constant mass matrix and the contributions of flexible and lookup-table bodies. */
#include "mass.h"
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../instance.h"
#include "../lookup/lookup.h"
#include "flexible_body.h"

void ali3_mass_times(const ali3_instance *in, const double *x, double *out) {
  ali3_constant_mass_times(in, x, out);
  if (in->system->n_flexible > 0) ali3_flexible_mass_times(in, x, out);
  if (in->system->n_lookup > 0) ali3_lookup_mass_times(in, x, out);
}

double ali3_mass_product(const ali3_instance *in, const double *a, const double *b, double *work) {
  double sum = 0.0;
  ali3_mass_times(in, b, work);
  for (int32_t i = 0; i < in->system->size.nq; i++) sum += work[i] * a[i];
  return sum;
}

/* Copies lower triangles, four columns at a time, all four from the row at which the first begins, so that lengths are
 * even. Entries above the diagonal are not read. */
ALI3_INLINED void mass_to_fronts(const ali3_instance *in, double *F) {
  const ali3_system *S = in->system;
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int64_t n = S->front_ptr[f + 1] - S->front_ptr[f];
    double *to = F + S->front_off[f];
    const double *from = in->mass.front + S->front_off[f];
    int64_t j = 0;
    for (; j + 3 < n; j += 4, to += 4 * n, from += 4 * n) {
      ALI3_EACH(ali3_padded_start(j, n), n, for (int k = 0; k < 4; k++) ALI3_AT(to + k * n) = ALI3_AT(from + k * n))
    }
    for (; j < n; j++, to += n, from += n) ali3_copy(to, from, n);
  }
}

ALI3_BY_PROCESSOR(in->system, void, mass_to_fronts, (const ali3_instance *in, double *F), (in, F))
