/* Contact of a disc with the half-space below a plane. In the plane of the disc, with axis e, the plane through q with
 * normal n is nearest along down = -(n - (n . e) e)/s at the distance n . (centre - q)/s, s = |n - (n . e) e|, the sine
 * of the angle between e and n. */
#include "half_space.h"

#include "../algebra/small_vectors.h"

/* Sine between wheel axis and road normal below which the width of a wheel matters: lying flat its centre is LYING/2
 * radii high, half its width, and it is 4/LYING^2 times as stiff as upright. */
#define LYING 0.5

/* Divisor instead of the sine, and its slope: the sine, below LYING a parabola with the same slope there. */
static real find_divisor(real sine, real *slope) {
  const real ratio = sine / LYING;
  const lane_mask is_lying = ratio < 1.0;
  *slope = ali3_where(is_lying, ratio, ali3_same(1.0));
  return ali3_where(is_lying, 0.5 * LYING * (1.0 + ratio * ratio), sine);
}

real ali3_half_space(const real centre[3], const real axis[3], real radius, const real q[3], const real n[3],
                     ali3_contact *out) {
  real normal_component = ali3_dot(n, axis), inplane[3], height = {0};
  for (int i = 0; i < 3; i++) {
    inplane[i] = n[i] - normal_component * axis[i];
    height += n[i] * (centre[i] - q[i]);
  }
  real size = ali3_norm(inplane);
  const lane_mask is_flat = size < 1e-9;
  out->cosine = find_divisor(ali3_where(is_flat, ali3_same(0.0), size), &out->leaning);
  if (ali3_any(is_flat)) { /* any direction in the plane of the wheel */
    const real none = {0}, one = ali3_same(1.0);
    const lane_mask steep = ali3_abs(axis[0]) < 0.6;
    const real auxiliary[3] = {ali3_where(steep, one, none), ali3_where(steep, none, one), none};
    real arbitrary[3];
    ali3_cross(axis, auxiliary, arbitrary);
    for (int i = 0; i < 3; i++) inplane[i] = ali3_where(is_flat, arbitrary[i], inplane[i]);
    size = ali3_norm(inplane);
  }
  const real distance = height / out->cosine;
  out->penetration = radius - distance;
  for (int i = 0; i < 3; i++) {
    out->normal[i] = n[i];
    out->down[i] = -inplane[i] / size;
    out->point[i] = centre[i] + distance * out->down[i];
  }
  return distance;
}
