/* Sine, cosine, exponential, hyperbolic tangent and arc sine by sums, products, quotients and square roots, which are
 * the same bits on all platforms: reduction of the argument, then a Taylor polynomial whose remainder is below
 * round-off. */
#include "elementary.h"

#include <math.h>
#include <stdint.h>

#define COUNT(c) ((int)(sizeof(c) / sizeof *(c)))

/* pi/2 and ln 2 in parts whose products with integers below 2^20 are exact. */
static const double HALF_PI_1 = 1.5707963267341256, HALF_PI_2 = 6.077100506303966e-11,
                    HALF_PI_3 = 2.0222662487959506e-21, TWO_OVER_PI = 0.6366197723675814;
static const double LN2_1 = 0.6931471804855391, LN2_2 = 7.440617110012397e-11, ONE_OVER_LN2 = 1.4426950408889634;
static const double HALF_PI = 1.5707963267948966;
static const double MAX_ARGUMENT = 1048576.0;

/* c[0] + c[1] x + ... with n coefficients, by Horner's rule. */
static double polynomial(const double *c, int n, double x) {
  double sum = c[n - 1];
  for (int i = n - 2; i >= 0; i--) sum = sum * x + c[i];
  return sum;
}

/* Sine of r + low for |r| <= pi/4. */
static double sine_near(double r, double low) {
  static const double c[] = {-1.0 / 6.0,        1.0 / 120.0,        -1.0 / 5040.0,          1.0 / 362880.0,
                             -1.0 / 39916800.0, 1.0 / 6227020800.0, -1.0 / 1307674368000.0, 1.0 / 355687428096000.0};
  const double z = r * r;
  return r + (r * z * polynomial(c, COUNT(c), z) + low * (1.0 - 0.5 * z));
}

/* cos(r + low) for |r| <= pi/4, `low` below its last place. */
static double cosine_near(double r, double low) {
  static const double c[] = {1.0 / 24.0,        -1.0 / 720.0,         1.0 / 40320.0,         -1.0 / 3628800.0,
                             1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0};
  const double z = r * r, half = 0.5 * z, near = 1.0 - half;
  return near + (((1.0 - near) - half) + (z * z * polynomial(c, COUNT(c), z) - r * low));
}

/* x = quarter * pi/2 + r + low; larger arguments lose digits, as their representation does. */
static int reduce(double x, double *r, double *low) {
  if (fabs(x) > MAX_ARGUMENT) x = fmod(x, 4.0 * HALF_PI);
  const double k = floor(x * TWO_OVER_PI + 0.5), a = x - k * HALF_PI_1, b = k * HALF_PI_2;
  const double near = a - b, low_part = ((a - near) - b) - k * HALF_PI_3;
  *r = near + low_part;
  *low = (near - *r) + low_part;
  return (int)((int64_t)k & 3);
}

/* sin(x + quarters pi/2), x in rad */
static double sine_of(double x, int quarters) {
  double r, low;
  if (!(x - x == 0.0)) return x - x; /* NaN */
  const int quarter = (reduce(x, &r, &low) + quarters) & 3;
  const double value = quarter & 1 ? cosine_near(r, low) : sine_near(r, low);
  return quarter & 2 ? -value : value;
}

double ali3_sin(double x) { return x == 0.0 ? x : sine_of(x, 0); }

double ali3_cos(double x) { return sine_of(x, 1); }

/* Nearest integer, even at halves, by adding a number whose last bit is one. */
static double nearest(double x) { return (x + 6755399441055744.0) - 6755399441055744.0; }

void ali3_sine_cosine(int n, const double *x, double *sine, double *cosine) {
#if defined(__clang__)
#pragma clang loop vectorize(assume_safety) interleave(disable)
#endif
  for (int i = 0; i < n; i++) {
    const double k = nearest(x[i] * TWO_OVER_PI), a = x[i] - k * HALF_PI_1, b = k * HALF_PI_2;
    const double near = a - b, low_part = ((a - near) - b) - k * HALF_PI_3;
    const double r = near + low_part, low = (near - r) + low_part;
    /* k = 2 h + d and h = 2 h' + e with d, e of -1, 0, 1: selections are products, as branches prevent vectors */
    const double h = nearest(0.5 * k), d = k - 2.0 * h, e = h - 2.0 * nearest(0.5 * h);
    const double sign = 1.0 - 2.0 * (e * e), even = 1.0 - d * d;
    const double s = sine_near(r, low), c = cosine_near(r, low);
    sine[i] = sign * (even * s + d * c);
    cosine[i] = sign * (even * c - d * s);
  }
}

/* exp(r) - 1 for |r| <= 0.35 */
static double exp_near(double r) {
  static const double c[] = {1.0 / 2.0,       1.0 / 6.0,        1.0 / 24.0,        1.0 / 120.0,
                             1.0 / 720.0,     1.0 / 5040.0,     1.0 / 40320.0,     1.0 / 362880.0,
                             1.0 / 3628800.0, 1.0 / 39916800.0, 1.0 / 479001600.0, 1.0 / 6227020800.0};
  return r + r * r * polynomial(c, COUNT(c), r);
}

/* 2^k exp(r) with x = k ln 2 + r; beyond its limits the result overflows, or is below the smallest number. */
double ali3_exp(double x) {
  if (x != x) return x;
  if (x > 710.0) return HUGE_VAL;
  if (x < -746.0) return 0.0;
  const double k = floor(x * ONE_OVER_LN2 + 0.5), high = x - k * LN2_1, low = k * LN2_2, r = high - low;
  const double rest = (high - r) - low;
  return ldexp(1.0 + (exp_near(r) + rest), (int)k);
}

/* (exp(2 |x|) - 1)/(exp(2 |x|) + 1); from 22 on it is 1 to the last place. */
double ali3_tanh(double x) {
  const double a = fabs(x);
  if (x != x || x == 0.0) return x;
  if (a > 22.0) return x > 0.0 ? 1.0 : -1.0;
  const double e = a < 0.17 ? exp_near(2.0 * a) : ali3_exp(2.0 * a) - 1.0, value = e / (e + 2.0);
  return x > 0.0 ? value : -value;
}

double ali3_asin(double x) { return ali3_atan2(x, sqrt((1.0 - x) * (1.0 + x))); }
