/* Linear spring and damper between two points, with optional end stops.
 * Signals: d = p2 - p1 (2 or 3). Reals: as below; without the last eight the stops are linear.
 * Outputs: length m, force N (tension positive), rate m/s. */
#include <math.h>

#include "../algebra/small_vectors.h"
#include "contact_law.h"
#include "element.h"

enum { /* reals; progression and travel of bump, then of rebound; loss of bump, then of rebound */
       STIFFNESS,
       DAMPING,
       FREE_LENGTH,
       BUMP_LENGTH,
       BUMP_STIFFNESS,
       REBOUND_LENGTH,
       REBOUND_STIFFNESS,
       PROGRESSION,
       METAL_STIFFNESS = PROGRESSION + 4,
       METAL_ONSET,
       STOP_LOSS,
       REALS = STOP_LOSS + 2
};

#define SHORTEST 1e-12 /* m; below it there is no direction and no force */

/* Laws of the bump stop and the rebound stop over the length beyond them. */
static void end_stops(const double *p, int32_t nreal, ali3_contact_law law[2]) {
  const int progressive = nreal == REALS;
  for (int side = 0; side < 2; side++) {
    const double *q = p + PROGRESSION + 2 * side;
    law[side].stiffness = p[side ? REBOUND_STIFFNESS : BUMP_STIFFNESS];
    law[side].progression = progressive ? q[0] : 0.0;
    law[side].end = progressive ? q[1] : 0.0;
    law[side].hard_stiffness = progressive && law[side].stiffness > 0.0 ? p[METAL_STIFFNESS] : 0.0;
    law[side].onset = progressive ? p[METAL_ONSET] : 0.0;
    law[side].loss = progressive ? p[STOP_LOSS + side] : 0.0;
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
  double stretch = length - p[FREE_LENGTH], stiffness = p[STIFFNESS];
  double elastic = stiffness * stretch, damping = p[DAMPING];
  a->potential = 0.5 * p[STIFFNESS] * stretch * stretch;
  const double beyond[2] = {p[BUMP_LENGTH] - length, length - p[REBOUND_LENGTH]};
  double lost = 0.0;
  for (int side = 0; side < 2; side++) {
    if (!(beyond[side] > 0.0)) continue;
    const double sign = side ? 1.0 : -1.0;
    ali3_contact_law law[2];
    end_stops(p, a->nreal, law);
    double slope = 0.0, loss_slope;
    const double force = ali3_contact_force(&law[side], beyond[side], &slope, &a->potential);
    const double factor = ali3_contact_loss(&law[side], sign * rate, &loss_slope);
    elastic += sign * force;
    lost += sign * force * (factor - 1.0);
    stiffness += slope * factor;
    damping += force * loss_slope;
  }
  const double tension = elastic + p[DAMPING] * rate + lost;
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

/* Adds a stop's difference quotient dV / dl over the step and its slope; x0, x1: the length beyond it, signed. */
static void stop(const ali3_contact_law *law, double sign, double x0, double x1, double rate, double *quotient,
                 double *stiffness, double *damping) {
  if (!(x0 > 0.0 || x1 > 0.0)) return;
  double slope = 0.0, energy = 0.0, loss_slope;
  const double mean = ali3_contact_mean(law, x0, x1), factor = ali3_contact_loss(law, sign * rate, &loss_slope);
  const double end = ali3_contact_force(law, x1, &slope, &energy);
  /* twice d(mean)/d(x1): the element's length is that of the middle */
  if (fabs(x1 - x0) > 1e-6 * (fabs(x0) + fabs(x1))) slope = 2.0 * (end - mean) / (x1 - x0);
  *quotient += sign * mean * factor;
  *stiffness += slope * factor;
  *damping += mean * loss_slope;
}

/* V depends on the length l, l^2 is quadratic: l1^2 - l0^2 = 2 u . (u1 - u0). So f = -(dV / d(l^2)) 2 u with the
 * difference quotient dV / dl = k (mean l - free length) for a linear spring. */
static void discrete(ali3_element_args *a) {
  const double *p = a->real;
  const int32_t n = a->nsig;
  double square0 = 0.0, square1 = 0.0, along = 0.0;
  for (int32_t i = 0; i < n; i++) {
    const double u0 = a->u[i] - a->h * a->ud[i], u1 = a->u[i] + a->h * a->ud[i];
    square0 += u0 * u0;
    square1 += u1 * u1;
    along += a->u[i] * a->ud[i];
  }
  const double l0 = sqrt(square0), l1 = sqrt(square1), mean = 0.5 * (l0 + l1);
  if (mean <= SHORTEST) return;
  const double rate = along / mean;
  double quotient = p[STIFFNESS] * (mean - p[FREE_LENGTH]);
  double stiffness = p[STIFFNESS], damping = p[DAMPING];
  const double bump = p[BUMP_LENGTH], rebound = p[REBOUND_LENGTH];
  ali3_contact_law law[2];
  end_stops(p, a->nreal, law);
  stop(&law[0], -1.0, bump - l0, bump - l1, rate, &quotient, &stiffness, &damping);
  stop(&law[1], 1.0, l0 - rebound, l1 - rebound, rate, &quotient, &stiffness, &damping);
  const double tension = quotient + p[DAMPING] * rate;
  double dir[3] = {0}, turn[3] = {0};
  for (int32_t i = 0; i < n; i++) {
    dir[i] = a->u[i] / mean;
    turn[i] = (a->ud[i] - rate * dir[i]) / mean;
    a->f[i] = -tension * dir[i];
  }
  if (!a->S) return;
  const double across = a->wK * tension / mean;
  ali3_add_outer(a->S, n, a->wK * stiffness + a->wC * damping - across, dir);
  ali3_add_symmetric(a->S, n, a->wK * damping, dir, turn);
  for (int32_t i = 0; i < n; i++) a->S[i * n + i] += across;
}

static bool lossy(const double *real, int32_t nreal) {
  const double *loss = real + STOP_LOSS;
  return real[DAMPING] != 0.0 || (nreal == REALS && (loss[0] != 0.0 || loss[1] != 0.0));
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)integer, (void)nint, (void)n_inputs, (void)n_roads;
  if (nsig != 2 && nsig != 3) return "a spring-damper needs the 2 or 3 components of a distance";
  if (nreal != PROGRESSION && nreal != REALS) return "a spring-damper has 7 numbers, 15 with progressive stops";
  if (real[FREE_LENGTH] < 0.0) return "the free length of a spring-damper must not be negative";
  if (real[BUMP_STIFFNESS] < 0.0 || real[REBOUND_STIFFNESS] < 0.0)
    return "the stiffness of a spring's stops must not be negative";
  if (nreal == PROGRESSION) return 0;
  for (int32_t i = PROGRESSION; i < nreal; i++)
    if (real[i] < 0.0) return "the numbers of a spring's progressive stops must not be negative";
  if (real[METAL_STIFFNESS] > 0.0 && !(real[METAL_ONSET] > 0.0))
    return "the metal end of a spring's stops needs a depth over which it sets in";
  return 0;
}

const ali3_element_type ali3_spring_damper = {
    .evaluate = evaluate,
    .discrete = discrete,
    .conservative = true,
    .lossy = lossy,
    .nsig = -1,
    .nreal = -1,
    .nout = 3,
    .check = check,
};
