#include "tmeasy.h"

/* y/q for y = q (2 y1 - y2/2 - (y1 - y2/2) q): through 0, y1 at q = 1, y2 at q = 2 */
static double force_per_load(const double pair[2], double q) {
  return 2.0 * pair[0] - 0.5 * pair[1] - (pair[0] - 0.5 * pair[1]) * q;
}

static double linear(const double pair[2], double q) { return pair[0] + (pair[1] - pair[0]) * (q - 1.0); }

ali3_tmeasy ali3_tmeasy_at(const double pairs[10], double q, double friction_ratio) {
  const double r = friction_ratio > 1e-6 ? friction_ratio : 1e-6;
  ali3_tmeasy t;
  t.slope = force_per_load(pairs, q);
  t.max_force = r * force_per_load(pairs + 2, q);
  t.max_slip = r * linear(pairs + 4, q);
  t.slide_force = r * force_per_load(pairs + 6, q);
  t.slide_slip = r * linear(pairs + 8, q);
  return t;
}

double ali3_tmeasy_secant(const ali3_tmeasy *t, double s, double *derivative) {
  if (s < t->max_slip) { /* rational rise */
    const double x = s / t->max_slip, p = t->slope * t->max_slip / t->max_force, d = (1.0 - x) * (1.0 - x) + p * x;
    *derivative = -t->slope * (2.0 * x - 2.0 + p) / (d * d * t->max_slip);
    return t->slope / d;
  }
  double force = t->slide_force, force_slope = 0.0;
  if (s < t->slide_slip) { /* cubic fall */
    const double width = t->slide_slip - t->max_slip, x = (s - t->max_slip) / width,
                 drop = t->max_force - t->slide_force;
    force = t->max_force - drop * x * x * (3.0 - 2.0 * x);
    force_slope = -drop * 6.0 * x * (1.0 - x) / width;
  }
  const double secant = force / s;
  *derivative = (force_slope - secant) / s;
  return secant;
}

/* Falls from the initial value to zero at sy0, below zero until syE; both pieces are cubic and meet with one slope. */
double ali3_tmeasy_trail(const double pairs[6], double q, double s) {
  const double initial = linear(pairs, q), zero = linear(pairs + 2, q), end = linear(pairs + 4, q), w = zero / end;
  if (s >= end) return 0.0;
  if (s >= zero) {
    const double x = (s - zero) / (end - zero);
    return -initial * (1.0 - w) * x * (1.0 - x) * (1.0 - x);
  }
  const double x = s / zero, y = 1.0 - x;
  return initial * (y * y * (1.0 + 2.0 * x) - (1.0 - w) * x * y * y + w * x * x * y);
}
