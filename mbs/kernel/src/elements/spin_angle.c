/* Rotation angle of an axisymmetric wheel, reduced to one coordinate, relative to its carrier since the start. f, g are
 * orthonormal on the carrier with f x g = e along the axis; the spin chi has chi' = Omega, the absolute rate about it.
 * States: `turn`, and f, g at the end of the last step. The angle is chi + turn. The element has no force.
 *
 * The rate of the angle is Omega - e . w with the angular velocity w of the carrier, and turn = -(chi at the start)
 * minus the integral of e . w. That integral is not a function of the position, so it is summed over the steps: the
 * frame of the last step is transported by the smallest rotation of its axis e0 to the present axis e1, P v = v - (e1 .
 * v)/(1 + e0 . e1) (e0 + e1) for v normal to e0, and the angle from P f to the present f is added. This is exact for a
 * carrier that rotates about a fixed axis; otherwise a step neglects the small area between the path of the axis and a
 * great circle. */
#include "../algebra/elementary.h"
#include "element.h"
#include "element_math.h"
#include "spin_angle_fields.h"

enum { TURN, F, G = F + 3, STATES = G + 3 };
#define OPPOSITE 1e-9 /* least 1 + e0 . e1: the angle is undefined if the axis reverses within a step */

/* Rotation of the carrier about the axis from the last step to the present one, rad. */
static real find_carrier_turn(const real *last, const real *f, const real *g) {
  real e0[3], e1[3], transported[3];
  ali3_cross(last + F, last + G, e0);
  ali3_cross(f, g, e1);
  const real divisor = 1.0 + ali3_dot(e0, e1), least = ali3_same(OPPOSITE);
  const real factor = ali3_dot(e1, last + F) / ali3_where(divisor > OPPOSITE, divisor, least);
  for (int i = 0; i < 3; i++) transported[i] = last[F + i] - factor * (e0[i] + e1[i]);
  return ali3_atan2(-ali3_dot(transported, g), ali3_dot(transported, f));
}

static void evaluate(ali3_element_args *a) {
  const real *f = a->u, *g = a->u + 3;
  for (int i = 0; i < STATES; i++) a->y_new[i] = a->y_old[i];
  if (a->h != 0.0) {
    a->y_new[TURN] -= find_carrier_turn(a->y_old, f, g);
    for (int i = 0; i < 3; i++) a->y_new[F + i] = f[i], a->y_new[G + i] = g[i];
  }
  a->out[SPIN_ANGLE_OUT_ANGLE] = a->u[6] + a->y_new[TURN];
  a->potential = ali3_same(0.0);
  a->idle = 1;
}

#ifndef ALI3_WIDTH
/* At a start the angle is zero. */
static void accept(ali3_element_args *a) {
  if (a->h != 0.0) return;
  a->y_new[TURN] = -a->u[6];
  for (int i = 0; i < 6; i++) a->y_new[F + i] = a->u[i];
}

const ali3_element_type ali3_spin_angle = {
    ALI3_SPIN_ANGLE,
    .evaluate = evaluate,
    .accept = accept,
    .conservative = true,
};
#endif
