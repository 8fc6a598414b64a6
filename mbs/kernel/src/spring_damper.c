/* Linear spring and damper between two points, with optional linear end stops.
 * Signals: d = p2 - p1 (2 or 3). Reals: stiffness, damping, free length, bump length and stiffness, rebound length and
 * stiffness.
 * Outputs: length m, force N (tension positive), rate m/s. */
#include "element.h"
#include "element_math.h"

enum { STIFFNESS, DAMPING, FREE_LENGTH, BUMP_LENGTH, BUMP_STIFFNESS, REBOUND_LENGTH, REBOUND_STIFFNESS, REALS };
#define SHORTEST 1e-12 /* m; below it there is no direction and no force */

static void evaluate(ali3_element_args *a) {
  const double *p = a->real;
  const int32_t n = a->nsig;
  double square = 0.0;
  for (int32_t i = 0; i < n; i++) square += a->u[i] * a->u[i];
  const double length = sqrt(square);
  double dir[3] = {0}, rate = 0.0;
  if (length > SHORTEST)
    for (int32_t i = 0; i < n; i++) {
      dir[i] = a->u[i] / length;
      rate += dir[i] * a->ud[i];
    }
  double stretch = length - p[FREE_LENGTH], stiffness = p[STIFFNESS];
  double elastic = stiffness * stretch;
  a->potential = 0.5 * p[STIFFNESS] * stretch * stretch;
  if (length < p[BUMP_LENGTH]) {
    double s = length - p[BUMP_LENGTH];
    elastic += p[BUMP_STIFFNESS] * s;
    stiffness += p[BUMP_STIFFNESS];
    a->potential += 0.5 * p[BUMP_STIFFNESS] * s * s;
  }
  if (length > p[REBOUND_LENGTH]) {
    double s = length - p[REBOUND_LENGTH];
    elastic += p[REBOUND_STIFFNESS] * s;
    stiffness += p[REBOUND_STIFFNESS];
    a->potential += 0.5 * p[REBOUND_STIFFNESS] * s * s;
  }
  const double tension = elastic + p[DAMPING] * rate;
  for (int32_t i = 0; i < n; i++) a->f[i] = -tension * dir[i];
  a->out[0] = length;
  a->out[1] = tension;
  a->out[2] = rate;
  if (!a->S) return;
  if (length <= SHORTEST) { /* as for a spring of free length 0: it is isotropic */
    for (int32_t i = 0; i < n; i++) a->S[i * n + i] = a->wK * stiffness + a->wC * p[DAMPING];
    return;
  }
  const double across = a->wK * tension / length;
  double turn[3] = {0}; /* d(rate)/d(d) */
  for (int32_t i = 0; i < n; i++) turn[i] = (a->ud[i] - rate * dir[i]) / length;
  ali3_add_outer(a->S, n, a->wK * stiffness + a->wC * p[DAMPING] - across, dir);
  ali3_add_symmetric(a->S, n, a->wK * p[DAMPING], dir, turn);
  for (int32_t i = 0; i < n; i++) a->S[i * n + i] += across;
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)nreal, (void)integer, (void)nint, (void)n_inputs, (void)n_roads;
  if (nsig != 2 && nsig != 3) return "a spring-damper needs the 2 or 3 components of a distance";
  if (real[FREE_LENGTH] < 0.0) return "the free length of a spring-damper must not be negative";
  if (real[BUMP_STIFFNESS] < 0.0 || real[REBOUND_STIFFNESS] < 0.0)
    return "the stiffness of a spring's stops must not be negative";
  return 0;
}

extern const ali3_element_type ali3_spring_damper;
const ali3_element_type ali3_spring_damper = {evaluate, 0, -1, REALS, 0, 0, 3, check};
