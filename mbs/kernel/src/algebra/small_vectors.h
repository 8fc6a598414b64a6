/* Vectors of three and small dense matrices. */
#ifndef ALI3_SMALL_VECTORS_H
#define ALI3_SMALL_VECTORS_H
#include <math.h>
#include <stdint.h>

static inline double ali3_dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static inline void ali3_cross(const double a[3], const double b[3], double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double ali3_norm(const double a[3]) { return sqrt(ali3_dot(a, a)); }

/* sqrt is exactly rounded everywhere, hypot is not */
static inline double ali3_hypot(double a, double b) { return sqrt(a * a + b * b); }

static inline double ali3_clamp(double v, double lo, double hi) { return v < lo ? lo : v > hi ? hi : v; }

/* S += w b b' for an n x n row-major matrix */
static inline void ali3_add_outer(double *S, int32_t n, double w, const double *b) {
  for (int32_t i = 0; i < n; i++)
    for (int32_t j = 0; j < n; j++) S[i * n + j] += w * (b[i] * b[j]);
}

/* S += w (b c' + c b') / 2 */
static inline void ali3_add_symmetric(double *S, int32_t n, double w, const double *b, const double *c) {
  for (int32_t i = 0; i < n; i++)
    for (int32_t j = 0; j < n; j++) S[i * n + j] += 0.5 * w * (b[i] * c[j] + c[i] * b[j]);
}
#endif
