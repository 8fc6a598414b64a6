/* Forces of a step by discrete gradients: f . (u1 - u0) = -(V(u1) - V(u0)) minus what the damper takes, exactly. An
 * element sees the middle of the step, u, and ud = (u1 - u0) / (2 h), its h being half a step. Elements whose potential
 * is quadratic in u are exact in the middle as they are. */
#include <math.h>
#include <stddef.h>

#include "contact_law.h"
#include "contact_points.h"
#include "discrete_gradient.h"
#include "element.h"
#include "element_math.h"
#include "spring_damper.h"

#define SHORTEST 1e-12

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
static void spring_damper(ali3_element_args *a) {
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
  double quotient = p[ALI3_SPRING_STIFFNESS] * (mean - p[ALI3_SPRING_FREE_LENGTH]);
  double stiffness = p[ALI3_SPRING_STIFFNESS], damping = p[ALI3_SPRING_DAMPING];
  const double bump = p[ALI3_SPRING_BUMP_LENGTH], rebound = p[ALI3_SPRING_REBOUND_LENGTH];
  ali3_contact_law law[2];
  ali3_end_stops(p, a->nreal, law);
  stop(&law[0], -1.0, bump - l0, bump - l1, rate, &quotient, &stiffness, &damping);
  stop(&law[1], 1.0, l0 - rebound, l1 - rebound, rate, &quotient, &stiffness, &damping);
  const double tension = quotient + p[ALI3_SPRING_DAMPING] * rate;
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

ali3_element_function *ali3_discrete_gradient(int32_t type) {
  switch (type) {
  case ALI3_SPRING_DAMPER:
    return spring_damper;
  case ALI3_CONTACT_POINTS:
    return ali3_contact_points_discrete;
  default:
    return NULL;
  }
}
