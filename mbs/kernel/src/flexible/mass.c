/* M x: the constant mass matrix and what flexible bodies add to it. */
#include "mass.h"
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
