#include <math.h>

#include "tmeasy.h"

/* y/q for y = q (2 y1 - y2/2 - (y1 - y2/2) q): through 0, y1 at q = 1, y2 at q = 2 */
static double force_per_load(const double pair[2], double q) {
  return 2.0 * pair[0] - 0.5 * pair[1] - (pair[0] - 0.5 * pair[1]) * q;
}

static double linear(const double pair[2], double q) { return pair[0] + (pair[1] - pair[0]) * (q - 1.0); }

static double some_friction(double ratio) { return ratio > 1e-6 ? ratio : 1e-6; }

ali3_tmeasy ali3_tmeasy_at(const double pairs[10], double q, double friction_ratio) {
  const double r = some_friction(friction_ratio);
  ali3_tmeasy t;
  t.slope = force_per_load(pairs, q);
  t.max_force = r * force_per_load(pairs + 2, q);
  t.max_slip = r * linear(pairs + 4, q);
  t.slide_force = r * force_per_load(pairs + 6, q);
  t.slide_slip = r * linear(pairs + 8, q);
  return t;
}

/* The parameters of one direction over its normalised slip, squared. */
static ali3_tmeasy squared(const ali3_tmeasy *t, double scale) {
  const double slope = t->slope * scale, max_slip = t->max_slip / scale, slide_slip = t->slide_slip / scale;
  return (ali3_tmeasy){slope * slope, t->max_force * t->max_force, max_slip * max_slip, t->slide_force * t->slide_force,
                       slide_slip * slide_slip};
}

ali3_tmeasy_pair ali3_tmeasy_pair_at(const double x_pairs[10], const double y_pairs[10], double q,
                                     double friction_ratio) {
  const ali3_tmeasy x = ali3_tmeasy_at(x_pairs, q, friction_ratio), y = ali3_tmeasy_at(y_pairs, q, friction_ratio);
  const double bx = x.max_force / x.slope, by = y.max_force / y.slope, slips = x.max_slip + y.max_slip;
  ali3_tmeasy_pair t;
  t.max_force[0] = x.max_force, t.max_force[1] = y.max_force;
  t.scale[0] = x.max_slip / slips + bx / (bx + by), t.scale[1] = y.max_slip / slips + by / (bx + by);
  const ali3_tmeasy xx = squared(&x, t.scale[0]);
  t.square = squared(&y, t.scale[1]);
  t.spread =
      (ali3_tmeasy){xx.slope - t.square.slope, xx.max_force - t.square.max_force, xx.max_slip - t.square.max_slip,
                    xx.slide_force - t.square.slide_force, xx.slide_slip - t.square.slide_slip};
  return t;
}

/* F(s)/s of one curve; by_s and by hold its derivatives with respect to s and to the parameters. */
static double curve(const ali3_tmeasy *t, double s, double *by_s, ali3_tmeasy *by) {
  *by = (ali3_tmeasy){0};
  if (s < t->max_slip) { /* rational rise */
    const double x = s / t->max_slip, rise = t->slope * s / t->max_force, d = (1.0 - x) * (1.0 - x) + rise,
                 secant = t->slope / d, by_d = -secant / d;
    *by_s = by_d * (t->slope / t->max_force - 2.0 * (1.0 - x) / t->max_slip);
    by->slope = (1.0 - rise / d) / d;
    by->max_force = -by_d * rise / t->max_force;
    by->max_slip = by_d * 2.0 * (1.0 - x) * x / t->max_slip;
    return secant;
  }
  double force = t->slide_force, force_slope = 0.0;
  by->slide_force = 1.0 / s;
  if (s < t->slide_slip) { /* cubic fall */
    const double width = t->slide_slip - t->max_slip, x = (s - t->max_slip) / width,
                 drop = t->max_force - t->slide_force, fallen = x * x * (3.0 - 2.0 * x);
    force = t->max_force - drop * fallen;
    force_slope = -drop * 6.0 * x * (1.0 - x) / width;
    by->max_force = (1.0 - fallen) / s;
    by->slide_force = fallen / s;
    by->max_slip = force_slope * (x - 1.0) / s;
    by->slide_slip = -force_slope * x / s;
  }
  const double secant = force / s;
  *by_s = (force_slope - secant) / s;
  return secant;
}

double ali3_tmeasy_secant(const ali3_tmeasy_pair *t, const double n[2], double gradient[2]) {
  const double s2 = n[0] * n[0] + n[1] * n[1], s = sqrt(s2), share = s2 > 0.0 ? n[0] * n[0] / s2 : 0.5;
  const ali3_tmeasy *a = &t->square, *b = &t->spread;
  const ali3_tmeasy at = {sqrt(a->slope + b->slope * share), sqrt(a->max_force + b->max_force * share),
                          sqrt(a->max_slip + b->max_slip * share), sqrt(a->slide_force + b->slide_force * share),
                          sqrt(a->slide_slip + b->slide_slip * share)};
  ali3_tmeasy by;
  double by_s;
  const double secant = curve(&at, s, &by_s, &by);
  gradient[0] = gradient[1] = 0.0;
  if (!(s > 0.0)) return secant;
  const double by_share =
      0.5 * (by.slope * b->slope / at.slope + by.max_force * b->max_force / at.max_force +
             by.max_slip * b->max_slip / at.max_slip + by.slide_force * b->slide_force / at.slide_force +
             by.slide_slip * b->slide_slip / at.slide_slip);
  const double across = 2.0 * by_share * (n[0] * n[1] / s2) / s2; /* of the share: (n1, -n0) times it */
  gradient[0] = by_s * n[0] / s + across * n[1];
  gradient[1] = by_s * n[1] / s - across * n[0];
  return secant;
}

double ali3_tmeasy_trail(const double pairs[6], double q, double friction_ratio, double s) {
  const double r = some_friction(friction_ratio), initial = linear(pairs, q), zero = r * linear(pairs + 2, q),
               end = r * linear(pairs + 4, q), w = zero / end, x = s / zero;
  if (s >= end) return 0.0;
  if (s >= zero) {
    const double left = (end - s) / (end - zero);
    return -initial * (1.0 - w) * (x - 1.0) * left * left;
  }
  return initial * ((1.0 - w) * (1.0 - x) + w * (1.0 - (3.0 - 2.0 * x) * x * x));
}
