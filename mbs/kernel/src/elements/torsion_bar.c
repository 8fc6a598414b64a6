/* Torsion bar of a steering with power assistance controlled by its torque.
 *
 * T = k (u1 - u2) + c (u1' - u2') acts on the pinion, -T on the wheel; the motor adds A = g T / sqrt(1 + (g T / A1)^2)
 * on the pinion: about g T if that is small, at most A1. */
#include "element.h"
#include "element_math.h"
#include "torsion_bar_fields.h"

static void evaluate(ali3_element_args *a) {
  const double *p = a->real, twist = a->u[0] - a->u[1];
  const double torque = p[STIFFNESS] * twist + p[DAMPING] * (a->ud[0] - a->ud[1]);
  const double unlimited = p[ASSISTANCE] * torque,
               ratio = p[ASSISTANCE_LIMIT] > 0.0 ? unlimited / p[ASSISTANCE_LIMIT] : 0.0;
  const double root = sqrt(1.0 + ratio * ratio), assistance = p[ASSISTANCE_LIMIT] > 0.0 ? unlimited / root : 0.0;
  a->f[0] = -torque;
  a->f[1] = torque + assistance;
  a->potential = 0.5 * p[STIFFNESS] * twist * twist;
  a->out[TORSION_BAR_OUT_TORQUE] = torque;
  a->out[TORSION_BAR_OUT_ASSISTANCE] = assistance;
  if (!a->S) return;
  /* neglects the dependence of the motor's torque on the wheel's angle, so that the tangent is symmetric and
   * positive */
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
