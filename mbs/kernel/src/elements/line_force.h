/* Forces along the line between two points, shared by springs: their signals are d = p2 - p1 (2 or 3). */
#ifndef ALI3_LINE_FORCE_H
#define ALI3_LINE_FORCE_H
#include "../algebra/small_vectors.h"
#include "element.h"

#define ALI3_MIN_LENGTH 1e-12 /* m; below it there is no direction and no force */

typedef struct {
  real length, rate; /* m, m/s */
  real start, end; /* m: lengths at both ends of a step with a discrete gradient */
  real dir[3]; /* unit, from p1 to p2; zero below ALI3_MIN_LENGTH */
} ali3_line;

/* The line at u, ud. */
static inline ali3_line ali3_line_at(const ali3_element_args *a) {
  const int32_t n = a->nsig;
  real square = {0};
  for (int32_t i = 0; i < n; i++) square += a->u[i] * a->u[i];
  ali3_line line = {.length = ali3_sqrt(square)};
  const lane_mask directed = line.length > ALI3_MIN_LENGTH;
  for (int32_t i = 0; i < n; i++) {
    line.dir[i] = ali3_where(directed, a->u[i] / line.length, line.dir[i]);
    line.rate = ali3_add_unless(ali3_not(directed), line.rate, line.dir[i] * a->ud[i]);
  }
  return line;
}

#ifndef ALI3_WIDTH
/* The line over a step, see ali3_element_type.discrete. V depends on the length l, l^2 is quadratic: l1^2 - l0^2 = 2 u
 * . (u1 - u0). So f = -(dV / d(l^2)) 2 u with the difference quotient dV / dl: `length` is the mean of both. */
static inline ali3_line ali3_line_between(const ali3_element_args *a) {
  const int32_t n = a->nsig;
  double square0 = 0.0, square1 = 0.0, along = 0.0;
  for (int32_t i = 0; i < n; i++) {
    const double u0 = a->u[i] - a->h * a->ud[i], u1 = a->u[i] + a->h * a->ud[i];
    square0 += u0 * u0;
    square1 += u1 * u1;
    along += a->u[i] * a->ud[i];
  }
  ali3_line line = {.start = sqrt(square0), .end = sqrt(square1)};
  line.length = 0.5 * (line.start + line.end);
  if (line.length <= ALI3_MIN_LENGTH) return line;
  line.rate = along / line.length;
  for (int32_t i = 0; i < n; i++) line.dir[i] = a->u[i] / line.length;
  return line;
}
#endif

/* Adds forces and tangent of a tension, N, with its slopes by length, N/m, and rate, N s/m. */
static inline void ali3_line_force(ali3_element_args *a, const ali3_line *line, real tension, real stiffness,
                                   real damping) {
  const int32_t n = a->nsig;
  const real length = line->length, rate = line->rate, *dir = line->dir;
  const lane_mask apart = length > ALI3_MIN_LENGTH;
  for (int32_t i = 0; i < n; i++) a->f[i] = -tension * dir[i];
  if (!a->S) return;
  const real along = a->wK * stiffness + a->wC * damping;
  if (ali3_any(apart)) {
    const real across = a->wK * tension / length;
    real turn[3]; /* d(rate)/d(d) */
    for (int32_t i = 0; i < n; i++) turn[i] = (a->ud[i] - rate * dir[i]) / length;
    ali3_add_outer(a->S, n, along - across, dir);
    ali3_add_symmetric(a->S, n, a->wK * damping, dir, turn);
    for (int32_t i = 0; i < n; i++) a->S[i * n + i] += across;
  }
  if (!ali3_any(ali3_not(apart))) return;
  for (int32_t i = 0; i < n; i++) /* isotropic, as for a spring of free length 0 */
    for (int32_t j = 0; j < n; j++)
      a->S[i * n + j] = ali3_where(apart, a->S[i * n + j], i == j ? along : ali3_same(0.0));
}
#endif
