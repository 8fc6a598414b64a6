/* Whether numbers are finite. */
#include "finite.h"

enum { SUMS = 8 }; /* so that additions need not wait for each other */

bool ali3_finite(const double *v, int64_t n) {
  double sum[SUMS] = {0.0}; /* x - x is 0 for finite x, NaN else */
  int64_t i = 0;
  for (; i + SUMS <= n; i += SUMS)
    for (int k = 0; k < SUMS; k++) sum[k] += v[i + k] - v[i + k];
  for (; i < n; i++) sum[0] += v[i] - v[i];
  for (int k = 1; k < SUMS; k++) sum[0] += sum[k];
  return sum[0] == 0.0;
}
