/* Torsion bar of a steering, with the assistance that its torque controls.
 *
 * T = k (u1 - u2) + c (u1' - u2') turns the wheel back and the pinion on; the motor adds A = g T / sqrt(1 + (g T / A1)^2)
 * on the pinion: g T where that is small, A1 at most. */
#include "element.h"
#include "element_math.h"
#include "torsion_bar_fields.h"

static void evaluate(ali3_element_args *a) {
  const double *p = a->real, twist = a->u[0] - a->u[1];
  const double torque = p[STIFFNESS] * twist + p[DAMPING] * (a->ud[0] - a->ud[1]);
  const double wanted = p[ASSISTANCE] * torque, share = p[ASSISTANCE_LIMIT] > 0.0 ? wanted / p[ASSISTANCE_LIMIT] : 0.0;
  const double root = sqrt(1.0 + share * share), assistance = p[ASSISTANCE_LIMIT] > 0.0 ? wanted / root : 0.0;
  a->f[0] = -torque;
  a->f[1] = torque + assistance;
  a->potential = 0.5 * p[STIFFNESS] * twist * twist;
  a->out[0] = torque;
  a->out[1] = assistance;
  if (!a->S) return;
  /* what the wheel's angle does to the pinion through the motor is left out: the tangent is symmetric, and positive */
  const double slope = a->wK * p[STIFFNESS] + a->wC * p[DAMPING];
  const double gain = p[ASSISTANCE_LIMIT] > 0.0 ? p[ASSISTANCE] / (root * root * root) : 0.0;
  a->S[0] = slope;
  a->S[1] = a->S[2] = -slope;
  a->S[3] = slope * (1.0 + gain);
}

const ali3_element_type ali3_torsion_bar = {
    ALI3_TORSION_BAR,
    .evaluate = evaluate,
};
