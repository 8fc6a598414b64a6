/* Forces of a step by discrete gradients: f . (u1 - u0) = -(V(u1) - V(u0)) minus what the damper takes, exactly. An
 * element sees the middle of the step, u, and ud = (u1 - u0) / (2 h), its h being half a step. Elements whose potential
 * is quadratic in u are exact in the middle as they are. */
#include <math.h>
#include <stddef.h>

#include "ali3_internal.h"
#include "element_math.h"

/* spring_damper.c: reals */
enum { STIFFNESS, DAMPING, FREE_LENGTH, BUMP_LENGTH, BUMP_STIFFNESS, REBOUND_LENGTH, REBOUND_STIFFNESS };
#define SHORTEST 1e-12

/* Difference quotient of k x^2 / 2 over the length, x the part of the length beyond a stop; *active: of x. */
static double stop(double stiffness, double x0, double x1, double change, double *active) {
  if (stiffness == 0.0 || (x0 == 0.0 && x1 == 0.0)) return 0.0;
  *active = change != 0.0 ? (x1 - x0) / change : 1.0;
  return 0.5 * stiffness * (x0 + x1) * *active;
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
  const double rate = along / mean, change = 2.0 * a->h * rate; /* l1 - l0 */
  double bump = 0.0, rebound = 0.0;
  const double quotient =
      p[STIFFNESS] * (mean - p[FREE_LENGTH]) +
      stop(p[BUMP_STIFFNESS], fmin(l0 - p[BUMP_LENGTH], 0.0), fmin(l1 - p[BUMP_LENGTH], 0.0), change, &bump) +
      stop(p[REBOUND_STIFFNESS], fmax(l0 - p[REBOUND_LENGTH], 0.0), fmax(l1 - p[REBOUND_LENGTH], 0.0), change,
           &rebound);
  const double tension = quotient + p[DAMPING] * rate;
  double dir[3] = {0}, turn[3] = {0};
  for (int32_t i = 0; i < n; i++) {
    dir[i] = a->u[i] / mean;
    turn[i] = (a->ud[i] - rate * dir[i]) / mean;
    a->f[i] = -tension * dir[i];
  }
  if (!a->S) return;
  const double across = a->wK * tension / mean;
  const double stiffness = p[STIFFNESS] + bump * p[BUMP_STIFFNESS] + rebound * p[REBOUND_STIFFNESS];
  ali3_add_outer(a->S, n, a->wK * stiffness + a->wC * p[DAMPING] - across, dir);
  ali3_add_symmetric(a->S, n, a->wK * p[DAMPING], dir, turn);
  for (int32_t i = 0; i < n; i++) a->S[i * n + i] += across;
}

ali3_element_function *ali3_discrete_gradient(int32_t type) {
  return type == ALI3_SPRING_DAMPER ? spring_damper : NULL;
}
