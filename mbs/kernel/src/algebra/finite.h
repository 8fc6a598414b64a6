/* Test whether all numbers of an array are finite. */
#ifndef ALI3_FINITE_H
#define ALI3_FINITE_H
#include <stdbool.h>
#include <stdint.h>

#include "number_pairs.h"

#ifdef ALI3_WIDTH
/* Lanes in which all numbers are finite: v - v is 0 for finite v, otherwise NaN. */
static inline lane_mask ali3_finite_inlined(const real *v, int64_t n) {
  real sum = {0};
  for (int64_t i = 0; i < n; i++) sum += v[i] - v[i];
  return sum == 0.0;
}
#else
/* The sum of 0 times all numbers is 0 if they are finite, otherwise NaN. Four independent products hide the latency of
 * the multiplication. */
static inline __attribute__((always_inline)) bool ali3_finite_inlined(const double *v, int64_t n) {
  ali3_double4 a = {0}, b = {0}, c = {0}, d = {0};
  int64_t i = 0;
  ALI3_SHORT
  for (; i + 16 <= n; i += 16) {
    const ali3_double4 *x = (const ali3_double4 *)(v + i);
    a *= x[0], b *= x[1], c *= x[2], d *= x[3];
  }
  a += (b + c) + d;
  ALI3_SHORT
  for (; i + 4 <= n; i += 4) a *= *(const ali3_double4 *)(v + i);
  double zero = (a[0] + a[1]) + (a[2] + a[3]);
  for (; i < n; i++) zero *= v[i];
  return zero == 0.0;
}

bool ali3_finite(const double *v, int64_t n);
#endif
#endif
