/* Whether numbers are finite. */
#include "finite.h"

bool ali3_finite(const double *v, int64_t n) {
  double sum = 0.0; /* x - x is 0 for finite x, NaN else */
  for (int64_t i = 0; i < n; i++) sum += v[i] - v[i];
  return sum == 0.0;
}
