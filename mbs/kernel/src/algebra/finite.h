/* Whether numbers are finite. */
#ifndef ALI3_FINITE_H
#define ALI3_FINITE_H
#include <stdbool.h>
#include <stdint.h>

/* Of products with 0, which are 0 for finite numbers and NaN else, eight sums, so that additions need not wait for each
 * other. */
static inline __attribute__((always_inline)) bool ali3_finite_inlined(const double *v, int64_t n) {
  double sum[8] = {0.0};
  int64_t i = 0;
  for (; i + 8 <= n; i += 8)
    for (int k = 0; k < 8; k++) sum[k] += 0.0 * v[i + k];
  for (; i < n; i++) sum[0] += 0.0 * v[i];
  for (int k = 1; k < 8; k++) sum[0] += sum[k];
  return sum[0] == 0.0;
}

bool ali3_finite(const double *v, int64_t n);
#endif
