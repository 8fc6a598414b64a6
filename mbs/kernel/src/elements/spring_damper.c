/* Linear spring and damper between two points, with optional end stops.
 * Signals: d = p2 - p1 (2 or 3). Reals: see spring_damper.h; without the last eight the stops are linear.
 * Outputs: length m, force N (tension positive), rate m/s. */
#include "spring_damper.h"
#include "element_math.h"

#define SHORTEST 1e-12 /* m; below it there is no direction and no force */

void ali3_end_stops(const double *p, int32_t nreal, ali3_contact_law law[2]) {
  const int progressive = nreal == ALI3_SPRING_REALS;
  for (int side = 0; side < 2; side++) {
    const double *q = p + ALI3_SPRING_PROGRESSION + 2 * side;
    law[side].stiffness = p[side ? ALI3_SPRING_REBOUND_STIFFNESS : ALI3_SPRING_BUMP_STIFFNESS];
    law[side].progression = progressive ? q[0] : 0.0;
    law[side].end = progressive ? q[1] : 0.0;
    law[side].hard_stiffness = progressive && law[side].stiffness > 0.0 ? p[ALI3_SPRING_METAL_STIFFNESS] : 0.0;
    law[side].onset = progressive ? p[ALI3_SPRING_METAL_ONSET] : 0.0;
    law[side].loss = progressive ? p[ALI3_SPRING_STOP_LOSS + side] : 0.0;
  }
}

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
  double stretch = length - p[ALI3_SPRING_FREE_LENGTH], stiffness = p[ALI3_SPRING_STIFFNESS];
  double elastic = stiffness * stretch, damping = p[ALI3_SPRING_DAMPING];
  a->potential = 0.5 * p[ALI3_SPRING_STIFFNESS] * stretch * stretch;
  const double beyond[2] = {p[ALI3_SPRING_BUMP_LENGTH] - length, length - p[ALI3_SPRING_REBOUND_LENGTH]};
  double lost = 0.0;
  for (int side = 0; side < 2; side++) {
    if (!(beyond[side] > 0.0)) continue;
    const double sign = side ? 1.0 : -1.0;
    ali3_contact_law law[2];
    ali3_end_stops(p, a->nreal, law);
    double slope = 0.0, loss_slope;
    const double force = ali3_contact_force(&law[side], beyond[side], &slope, &a->potential);
    const double factor = ali3_contact_loss(&law[side], sign * rate, &loss_slope);
    elastic += sign * force;
    lost += sign * force * (factor - 1.0);
    stiffness += slope * factor;
    damping += force * loss_slope;
  }
  const double tension = elastic + p[ALI3_SPRING_DAMPING] * rate + lost;
  for (int32_t i = 0; i < n; i++) a->f[i] = -tension * dir[i];
  a->out[0] = length;
  a->out[1] = tension;
  a->out[2] = rate;
  if (!a->S) return;
  if (length <= SHORTEST) { /* as for a spring of free length 0: it is isotropic */
    for (int32_t i = 0; i < n; i++) a->S[i * n + i] = a->wK * stiffness + a->wC * damping;
    return;
  }
  const double across = a->wK * tension / length;
  double turn[3] = {0}; /* d(rate)/d(d) */
  for (int32_t i = 0; i < n; i++) turn[i] = (a->ud[i] - rate * dir[i]) / length;
  ali3_add_outer(a->S, n, a->wK * stiffness + a->wC * damping - across, dir);
  ali3_add_symmetric(a->S, n, a->wK * damping, dir, turn);
  for (int32_t i = 0; i < n; i++) a->S[i * n + i] += across;
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)integer, (void)nint, (void)n_inputs, (void)n_roads;
  if (nsig != 2 && nsig != 3) return "a spring-damper needs the 2 or 3 components of a distance";
  if (nreal != ALI3_SPRING_PROGRESSION && nreal != ALI3_SPRING_REALS)
    return "a spring-damper has 7 numbers, 15 with progressive stops";
  if (real[ALI3_SPRING_FREE_LENGTH] < 0.0) return "the free length of a spring-damper must not be negative";
  if (real[ALI3_SPRING_BUMP_STIFFNESS] < 0.0 || real[ALI3_SPRING_REBOUND_STIFFNESS] < 0.0)
    return "the stiffness of a spring's stops must not be negative";
  if (nreal == ALI3_SPRING_PROGRESSION) return 0;
  for (int32_t i = ALI3_SPRING_PROGRESSION; i < nreal; i++)
    if (real[i] < 0.0) return "the numbers of a spring's progressive stops must not be negative";
  if (real[ALI3_SPRING_METAL_STIFFNESS] > 0.0 && !(real[ALI3_SPRING_METAL_ONSET] > 0.0))
    return "the metal end of a spring's stops needs a depth over which it sets in";
  return 0;
}

extern const ali3_element_type ali3_spring_damper;
const ali3_element_type ali3_spring_damper = {evaluate, 0, -1, -1, 0, 0, 3, check};
