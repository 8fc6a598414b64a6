/* Normal force, loss and exact means of the contact law over the penetration. */
#include "contact_law.h"

#include <math.h>

real ali3_contact_force(const ali3_contact_law *law, real x, real *slope, real *energy) {
  const truth away = ali3_not(x > 0.0);
  const real none = {0}, k = law->stiffness;
  if (!ali3_any(ali3_not(away))) return none;
  const real part = ali3_where(law->progression > 0.0, x / law->progression, none), square = part * part;
  real force = k * x * (1.0 + square);
  *slope = ali3_add_unless(away, *slope, k * (1.0 + 3.0 * square));
  *energy = ali3_add_unless(away, *energy, 0.5 * k * x * x * (1.0 + 0.5 * square));
  const real deep = x - law->end, K = law->hard_stiffness, w = law->onset;
  const truth soft = away | ali3_not((K > 0.0) & (deep > 0.0)), sets_in = deep < w;
  if (ali3_any(ali3_not(soft))) {
    const real share = deep / w, beyond = deep - 0.5 * w;
    force = ali3_add_unless(soft, force, ali3_where(sets_in, 0.5 * K * deep * share, K * beyond));
    *slope = ali3_add_unless(soft, *slope, ali3_where(sets_in, K * share, K));
    *energy = ali3_add_unless(
        soft, *energy, ali3_where(sets_in, K * deep * deep * share / 6.0, K * (0.5 * deep * (deep - w) + w * w / 6.0)));
  }
  return ali3_where(away, none, force);
}

#ifndef ALI3_WIDTH
static double at(const ali3_contact_law *law, double x) {
  double slope = 0.0, energy = 0.0;
  return ali3_contact_force(law, x, &slope, &energy);
}

/* The force is a polynomial of degree three at most between its joints, where Simpson's rule is exact. */
double ali3_contact_mean(const ali3_contact_law *law, double x0, double x1) {
  const double low = fmin(x0, x1), high = fmax(x0, x1), width = high - low;
  if (!(width > 0.0)) return at(law, x0);
  const int hard = law->hard_stiffness > 0.0;
  const double joint[5] = {low, 0.0, hard ? law->end : 0.0, hard ? law->end + law->onset : 0.0, high};
  double mean = 0.0, from = low;
  for (int i = 1; i < 5; i++) {
    const double to = fmin(fmax(joint[i], from), high);
    if (to > from)
      mean += (to - from) / width * ((at(law, from) + 4.0 * at(law, 0.5 * (from + to)) + at(law, to)) / 6.0);
    from = to;
  }
  return mean;
}
#endif

real ali3_contact_loss(const ali3_contact_law *law, real rate, real *slope) {
  const real whole = law->loss * rate,
             kept = 1.0 / (1.0 + ali3_abs(whole) * (law->restitution / (1.0 - law->restitution)));
  const real w = whole * kept, behind = 1.0 / (1.0 - w), along = law->loss * kept * kept;
  const truth presses = w >= 0.0;
  *slope = ali3_where(presses, along, along * behind * behind);
  return ali3_where(presses, 1.0 + w, behind);
}
