/* TMeasy characteristics: curves of one direction, combined forces by the slips of both directions, dynamic trail.
 *
 * With the slope D at s = 0, the largest force Fm at sm and the force of sliding Fs from ss on:
 *   F = D s/((1 - s/sm)^2 + D s/Fm) up to sm, F = Fm - (Fm - Fs) x^2 (3 - 2 x), x = (s - sm)/(ss - sm), up to ss.
 * Slips of both directions are divided by scale_i = sm_i/(smx + smy) + b_i/(bx + by), b = Fm/D; the curve of the
 * combined slip s at the angle phi has parameters sqrt(px^2 cos^2 phi + py^2 sin^2 phi). The trail over the contact
 * length is n0 at s = 0, 0 at s0 and from se on; with w = s0/se
 *   n = n0 ((1 - w)(1 - s/s0) + w (1 - (3 - 2 s/s0)(s/s0)^2)) up to s0,
 *   n = -n0 (1 - w)(s/s0 - 1)((se - s)/(se - s0))^2 up to se. */
#include "tmeasy.h"

/* y/q of the parabola y = q (2 y1 - y2/2 - (y1 - y2/2) q), which is 0, y1, y2 at q = 0, 1, 2. */
static real interpolate_force_per_load(const real pair[2], real q) {
  return 2.0 * pair[0] - 0.5 * pair[1] - (pair[0] - 0.5 * pair[1]) * q;
}

/* Value at the load factor q, linear between 1 and 2 times the nominal load. */
static real interpolate_by_load(const real pair[2], real q) { return pair[0] + (pair[1] - pair[0]) * (q - 1.0); }

/* A friction ratio that is large enough to divide by. */
static real limit_friction(real ratio) { return ali3_where(ratio > 1e-6, ratio, ali3_same(1e-6)); }

ali3_tmeasy ali3_tmeasy_at(const real pairs[10], real q, real friction_ratio) {
  const real r = limit_friction(friction_ratio);
  ali3_tmeasy t;
  t.slope = interpolate_force_per_load(pairs, q);
  t.max_force = r * interpolate_force_per_load(pairs + 2, q);
  t.max_slip = r * interpolate_by_load(pairs + 4, q);
  t.slide_force = r * interpolate_force_per_load(pairs + 6, q);
  t.slide_slip = r * interpolate_by_load(pairs + 8, q);
  return t;
}

/* Squares of the parameters of one direction as functions of its normalised slip. */
static ali3_tmeasy square_parameters(const ali3_tmeasy *t, real scale) {
  const real slope = t->slope * scale, max_slip = t->max_slip / scale, slide_slip = t->slide_slip / scale;
  return (ali3_tmeasy){slope * slope, t->max_force * t->max_force, max_slip * max_slip, t->slide_force * t->slide_force,
                       slide_slip * slide_slip};
}

ali3_tmeasy_pair ali3_tmeasy_pair_at(const real x_pairs[10], const real y_pairs[10], real q, real friction_ratio) {
  const ali3_tmeasy x = ali3_tmeasy_at(x_pairs, q, friction_ratio), y = ali3_tmeasy_at(y_pairs, q, friction_ratio);
  const real bx = x.max_force / x.slope, by = y.max_force / y.slope, slips = x.max_slip + y.max_slip;
  ali3_tmeasy_pair t;
  t.max_force[0] = x.max_force, t.max_force[1] = y.max_force;
  t.scale[0] = x.max_slip / slips + bx / (bx + by), t.scale[1] = y.max_slip / slips + by / (bx + by);
  const ali3_tmeasy xx = square_parameters(&x, t.scale[0]);
  t.square = square_parameters(&y, t.scale[1]);
  t.spread =
      (ali3_tmeasy){xx.slope - t.square.slope, xx.max_force - t.square.max_force, xx.max_slip - t.square.max_slip,
                    xx.slide_force - t.square.slide_force, xx.slide_slip - t.square.slide_slip};
  return t;
}

/* Secant F(s)/s of a curve with its derivatives by s and by the parameters of the curve. */
typedef struct {
  real secant, by_s;
  ali3_tmeasy by;
} point;

/* Rational part of the curve, up to the largest force. */
static point evaluate_rise(const ali3_tmeasy *t, real s) {
  const real x = s / t->max_slip, rise = t->slope * s / t->max_force, d = (1.0 - x) * (1.0 - x) + rise,
             secant = t->slope / d, by_d = -secant / d;
  point p = {.secant = secant};
  p.by_s = by_d * (t->slope / t->max_force - 2.0 * (1.0 - x) / t->max_slip);
  p.by.slope = (1.0 - rise / d) / d;
  p.by.max_force = -by_d * rise / t->max_force;
  p.by.max_slip = by_d * 2.0 * (1.0 - x) * x / t->max_slip;
  return p;
}

/* Cubic part of the curve, from the largest force to sliding, and the constant force of sliding. */
static point evaluate_fall(const ali3_tmeasy *t, real s) {
  const lane_mask slides = ali3_not(s < t->slide_slip);
  real force = t->slide_force, force_slope = {0};
  point p = {.by.slide_force = 1.0 / s};
  if (ali3_any(ali3_not(slides))) {
    const real none = {0}, width = t->slide_slip - t->max_slip, x = (s - t->max_slip) / width,
               difference = t->max_force - t->slide_force, fallen = x * x * (3.0 - 2.0 * x);
    force = ali3_where(slides, force, t->max_force - difference * fallen);
    force_slope = ali3_where(slides, none, -difference * 6.0 * x * (1.0 - x) / width);
    p.by.max_force = ali3_where(slides, none, (1.0 - fallen) / s);
    p.by.slide_force = ali3_where(slides, p.by.slide_force, fallen / s);
    p.by.max_slip = ali3_where(slides, none, force_slope * (x - 1.0) / s);
    p.by.slide_slip = ali3_where(slides, none, -force_slope * x / s);
  }
  p.secant = force / s;
  p.by_s = (force_slope - p.secant) / s;
  return p;
}

/* Force characteristic at slip s: rising part, then falling part. */
static point evaluate_curve(const ali3_tmeasy *t, real s) {
  const lane_mask rises = s < t->max_slip;
  if (!ali3_any(ali3_not(rises))) return evaluate_rise(t, s);
  if (!ali3_any(rises)) return evaluate_fall(t, s);
  const point rising = evaluate_rise(t, s), falling = evaluate_fall(t, s);
  return (point){ali3_where(rises, rising.secant, falling.secant),
                 ali3_where(rises, rising.by_s, falling.by_s),
                 {ali3_where(rises, rising.by.slope, falling.by.slope),
                  ali3_where(rises, rising.by.max_force, falling.by.max_force),
                  ali3_where(rises, rising.by.max_slip, falling.by.max_slip),
                  ali3_where(rises, rising.by.slide_force, falling.by.slide_force),
                  ali3_where(rises, rising.by.slide_slip, falling.by.slide_slip)}};
}

real ali3_tmeasy_secant(const ali3_tmeasy_pair *t, const real n[2], real gradient[2]) {
  const real s2 = n[0] * n[0] + n[1] * n[1], s = ali3_sqrt(s2), none = {0};
  const real weight = ali3_where(s2 > 0.0, n[0] * n[0] / s2, ali3_same(0.5));
  const ali3_tmeasy *a = &t->square, *b = &t->spread;
  const ali3_tmeasy current = {ali3_sqrt(a->slope + b->slope * weight), ali3_sqrt(a->max_force + b->max_force * weight),
                               ali3_sqrt(a->max_slip + b->max_slip * weight),
                               ali3_sqrt(a->slide_force + b->slide_force * weight),
                               ali3_sqrt(a->slide_slip + b->slide_slip * weight)};
  const point p = evaluate_curve(&current, s);
  const lane_mask slips = s > 0.0;
  gradient[0] = gradient[1] = none;
  if (!ali3_any(slips)) return p.secant;
  const real by_weight =
      0.5 * (p.by.slope * b->slope / current.slope + p.by.max_force * b->max_force / current.max_force +
             p.by.max_slip * b->max_slip / current.max_slip + p.by.slide_force * b->slide_force / current.slide_force +
             p.by.slide_slip * b->slide_slip / current.slide_slip);
  /* gradient of the weight by n: (n1, -n0) times this */
  const real by_angle = 2.0 * by_weight * (n[0] * n[1] / s2) / s2;
  gradient[0] = ali3_where(slips, p.by_s * n[0] / s + by_angle * n[1], none);
  gradient[1] = ali3_where(slips, p.by_s * n[1] / s - by_angle * n[0], none);
  return p.secant;
}

real ali3_tmeasy_trail(const real pairs[6], real q, real friction_ratio, real s) {
  const real r = limit_friction(friction_ratio), initial = interpolate_by_load(pairs, q),
             zero = r * interpolate_by_load(pairs + 2, q), end = r * interpolate_by_load(pairs + 4, q), w = zero / end,
             x = s / zero;
  const lane_mask past_zero = s >= zero, ended = s >= end;
  const real remaining = (end - s) / (end - zero), none = {0};
  const real falls = -initial * (1.0 - w) * (x - 1.0) * remaining * remaining;
  const real rises = initial * ((1.0 - w) * (1.0 - x) + w * (1.0 - (3.0 - 2.0 * x) * x * x));
  return ali3_where(ended, none, ali3_where(past_zero, falls, rises));
}
