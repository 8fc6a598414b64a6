/* M x: the constant mass matrix and what flexible bodies add to it. */
#include "mass.h"
#include "../algebra/processor.h"
#include "../algebra/stretch.h"
#include "../instance.h"
#include "../tabled/tabled.h"
#include "flexible_body.h"

void ali3_mass_times(const ali3_instance *in, const double *x, double *out) {
  ali3_constant_mass_times(in, x, out);
  if (in->system->n_flexible > 0) ali3_flexible_mass_times(in, x, out);
  if (in->system->n_tabled > 0) ali3_tabled_mass_times(in, x, out);
}

/* a' M b, M of the last q prepared; M b stays in `work` (nq). */
double ali3_mass_product(const ali3_instance *in, const double *a, const double *b, double *work) {
  double sum = 0.0;
  ali3_mass_times(in, b, work);
  for (int32_t i = 0; i < in->system->size.nq; i++) sum += work[i] * a[i];
  return sum;
}

ALI3_INLINED void mass_to_fronts(const ali3_instance *in, double *F) {
  const ali3_system *S = in->system;
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t n = S->front_ptr[f + 1] - S->front_ptr[f];
    for (int32_t j = 0; j < n; j++) {
      const int32_t from = ali3_by_fours(j, n);
      const int64_t first = S->front_off[f] + (int64_t)j * n + from;
      ali3_copy_few(F + first, in->front_mass + first, n - from);
    }
  }
}

ALI3_BY_PROCESSOR(in->system, void, mass_to_fronts, (const ali3_instance *in, double *F), (in, F))
