/* Normal force, loss and exact means of the contact law over the penetration x; contact_law.h has its equations. */
#include "contact_law.h"

#include <math.h>

real ali3_contact_force(const ali3_contact_law *law, real x, real *slope, real *energy) {
  const lane_mask is_open = ali3_not(x > 0.0);
  const real none = {0}, k = law->stiffness;
  if (!ali3_any(ali3_not(is_open))) return none;
  const real ratio = ali3_where(law->progression > 0.0, x / law->progression, none), square = ratio * ratio;
  real force = k * x * (1.0 + square);
  *slope = ali3_add_unless(is_open, *slope, k * (1.0 + 3.0 * square));
  *energy = ali3_add_unless(is_open, *energy, 0.5 * k * x * x * (1.0 + 0.5 * square));
  const real hard_depth = x - law->end, K = law->hard_stiffness, w = law->onset;
  const lane_mask no_hard_end = is_open | ali3_not((K > 0.0) & (hard_depth > 0.0)), in_onset = hard_depth < w;
  if (ali3_any(ali3_not(no_hard_end))) {
    const real fraction = hard_depth / w, beyond = hard_depth - 0.5 * w;
    force = ali3_add_unless(no_hard_end, force, ali3_where(in_onset, 0.5 * K * hard_depth * fraction, K * beyond));
    *slope = ali3_add_unless(no_hard_end, *slope, ali3_where(in_onset, K * fraction, K));
    *energy = ali3_add_unless(no_hard_end, *energy,
                              ali3_where(in_onset, K * hard_depth * hard_depth * fraction / 6.0,
                                         K * (0.5 * hard_depth * (hard_depth - w) + w * w / 6.0)));
  }
  return ali3_where(is_open, none, force);
}

#ifndef ALI3_WIDTH
/* Conservative force at penetration x. */
static double find_force(const ali3_contact_law *law, double x) {
  double slope = 0.0, energy = 0.0;
  return ali3_contact_force(law, x, &slope, &energy);
}

/* Between these points the force is a polynomial of degree three at most, for which Simpson's rule is exact. */
double ali3_contact_mean(const ali3_contact_law *law, double x0, double x1) {
  const double low = fmin(x0, x1), high = fmax(x0, x1), width = high - low;
  if (!(width > 0.0)) return find_force(law, x0);
  const int hard = law->hard_stiffness > 0.0;
  const double joint[5] = {low, 0.0, hard ? law->end : 0.0, hard ? law->end + law->onset : 0.0, high};
  double mean = 0.0, from = low;
  for (int i = 1; i < 5; i++) {
    const double to = fmin(fmax(joint[i], from), high);
    if (to > from)
      mean += (to - from) / width *
              ((find_force(law, from) + 4.0 * find_force(law, 0.5 * (from + to)) + find_force(law, to)) / 6.0);
    from = to;
  }
  return mean;
}
#endif

real ali3_contact_loss(const ali3_contact_law *law, real rate, real *slope) {
  const real undamped = law->loss * rate,
             saturation = 1.0 / (1.0 + ali3_abs(undamped) * (law->restitution / (1.0 - law->restitution)));
  const real w = undamped * saturation, unloading = 1.0 / (1.0 - w),
             loading_slope = law->loss * saturation * saturation;
  const lane_mask presses = w >= 0.0;
  *slope = ali3_where(presses, loading_slope, loading_slope * unloading * unloading);
  return ali3_where(presses, 1.0 + w, unloading);
}
