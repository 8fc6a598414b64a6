/* Inverse tangent of two arguments, see elementary.h. */
#include "elementary.h"
#include "real.h"

static const double HALF_PI_PARTS[2] = {1.5707963267948966, 6.123233995736766e-17}; /* pi/2 and its round-off */

/* Arc tangent for 0 <= t <= 1: relative to pi/4 or 0, by one half-angle formula and the series. */
static real arc(real t) {
  static const double c[] = {-1.0 / 3.0,  1.0 / 5.0,  -1.0 / 7.0,  1.0 / 9.0,  -1.0 / 11.0, 1.0 / 13.0,
                             -1.0 / 15.0, 1.0 / 17.0, -1.0 / 19.0, 1.0 / 21.0, -1.0 / 23.0};
  const double quarter = 0.5 * HALF_PI_PARTS[0], rest = 0.5 * HALF_PI_PARTS[1];
  const lane_mask is_large = t > 0.41421356237309503;
  const real u = ali3_where(is_large, (t - 1.0) / (t + 1.0), t);
  const real half = u / (1.0 + ali3_sqrt(1.0 + u * u)), z = half * half;
  real sum = ali3_same(c[10]);
  for (int i = 9; i >= 0; i--) sum = sum * z + c[i];
  const real value = 2.0 * (half + half * z * sum);
  const real angle = ali3_where(is_large, quarter + (value + rest), value);
  return ali3_where(ali3_abs(u) < 1e-9, ali3_where(is_large, quarter + u, u), angle);
}

real ali3_atan2(real y, real x) {
  const real ay = ali3_abs(y), ax = ali3_abs(x), least = {0};
  const lane_mask is_steep = ay > ax, is_negative = ali3_negative(x);
  const real largest = ali3_where(is_steep, ay, ax), smallest = ali3_where(is_steep, ax, ay);
  const real slope = ali3_where(ay == ax, ali3_same(1.0), smallest / largest);
  const real near = ali3_where(largest > 0.0, arc(slope), least);
  const real from_axis_y = ali3_where(is_negative, HALF_PI_PARTS[0] + (near + HALF_PI_PARTS[1]),
                                      HALF_PI_PARTS[0] - (near - HALF_PI_PARTS[1]));
  const real from_axis_x = 2.0 * HALF_PI_PARTS[0] - (near - 2.0 * HALF_PI_PARTS[1]);
  const real angle = ali3_where(is_steep, from_axis_y, ali3_where(is_negative, from_axis_x, near));
  const lane_mask undefined = (y != y) | (x != x);
  return ali3_where(undefined, x + y, ali3_where(ali3_negative(y), -angle, angle));
}
