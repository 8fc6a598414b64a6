/* Vectors of three and small dense matrices. */
#ifndef ALI3_SMALL_VECTORS_H
#define ALI3_SMALL_VECTORS_H
#include <stdint.h>

#include "real.h"

static inline real ali3_dot(const real a[3], const real b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static inline void ali3_cross(const real a[3], const real b[3], real out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline real ali3_norm(const real a[3]) { return ali3_sqrt(ali3_dot(a, a)); }

/* sqrt is exactly rounded everywhere, hypot is not */
static inline real ali3_hypot(real a, real b) { return ali3_sqrt(a * a + b * b); }

static inline real ali3_clamp(real v, real lo, real hi) { return ali3_where(v < lo, lo, ali3_where(v > hi, hi, v)); }

/* S += w b b' for an n x n row-major matrix */
static inline void ali3_add_outer(real *S, int32_t n, real w, const real *b) {
  for (int32_t i = 0; i < n; i++)
    for (int32_t j = 0; j < n; j++) S[i * n + j] += w * (b[i] * b[j]);
}

/* S += w (b c' + c b') / 2 */
static inline void ali3_add_symmetric(real *S, int32_t n, real w, const real *b, const real *c) {
  for (int32_t i = 0; i < n; i++)
    for (int32_t j = 0; j < n; j++) S[i * n + j] += 0.5 * w * (b[i] * c[j] + c[i] * b[j]);
}
#endif
