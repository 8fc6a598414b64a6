#include "contact_law.h"

#include <math.h>

double ali3_contact_force(const ali3_contact_law *law, double x, double *slope, double *energy) {
  if (!(x > 0.0)) return 0.0;
  const double k = law->stiffness, part = law->progression > 0.0 ? x / law->progression : 0.0, square = part * part;
  double force = k * x * (1.0 + square);
  *slope += k * (1.0 + 3.0 * square);
  *energy += 0.5 * k * x * x * (1.0 + 0.5 * square);
  const double deep = x - law->end, K = law->hard_stiffness, w = law->onset;
  if (!(K > 0.0 && deep > 0.0)) return force;
  if (deep < w) {
    const double share = deep / w;
    force += 0.5 * K * deep * share;
    *slope += K * share;
    *energy += K * deep * deep * share / 6.0;
  } else {
    force += K * (deep - 0.5 * w);
    *slope += K;
    *energy += K * (0.5 * deep * (deep - w) + w * w / 6.0);
  }
  return force;
}

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

double ali3_contact_loss(const ali3_contact_law *law, double rate, double *slope) {
  const double w = law->loss * rate, behind = 1.0 / (1.0 - w);
  *slope = w >= 0.0 ? law->loss : law->loss * behind * behind;
  return w >= 0.0 ? 1.0 + w : behind;
}
