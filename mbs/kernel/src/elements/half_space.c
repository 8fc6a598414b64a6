#include "half_space.h"

#include "../algebra/small_vectors.h"

/* Sine between wheel axis and road normal below which the width of a wheel matters: lying flat it touches with its
 * centre LYING/2 radii high, half as high as it is wide, and is 4/LYING^2 times as stiff as upright. */
#define LYING 0.5

/* What stands for the sine as a divisor, and its slope: the sine itself, and below LYING a parabola of the same slope
 * there. */
static double upright(double sine, double *slope) {
  const double part = sine / LYING;
  *slope = part < 1.0 ? part : 1.0;
  return part < 1.0 ? 0.5 * LYING * (1.0 + part * part) : sine;
}

double ali3_half_space(const double centre[3], const double axis[3], double radius, const double q[3],
                       const double n[3], ali3_contact *out) {
  double across = ali3_dot(n, axis), inplane[3], height = 0.0;
  for (int i = 0; i < 3; i++) {
    inplane[i] = n[i] - across * axis[i];
    height += n[i] * (centre[i] - q[i]);
  }
  double size = ali3_norm(inplane);
  if (size < 1e-9) { /* the wheel lies flat: any direction in its plane */
    const double other[3] = {fabs(axis[0]) < 0.6 ? 1.0 : 0.0, fabs(axis[0]) < 0.6 ? 0.0 : 1.0, 0.0};
    ali3_cross(axis, other, inplane);
    out->cosine = upright(0.0, &out->leaning);
    size = ali3_norm(inplane);
  } else {
    out->cosine = upright(size, &out->leaning);
  }
  const double distance = height / out->cosine;
  out->penetration = radius - distance;
  for (int i = 0; i < 3; i++) {
    out->normal[i] = n[i];
    out->down[i] = -inplane[i] / size;
    out->point[i] = centre[i] + distance * out->down[i];
  }
  return distance;
}
