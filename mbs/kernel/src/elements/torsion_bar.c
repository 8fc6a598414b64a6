/* Torsion bar of a steering, with the assistance that its torque controls.
 * Signals: angles of the steering wheel and of the pinion. Reals: stiffness N m/rad, damping N m s/rad, assistance per
 * torque of the bar, largest assistance N m. Outputs: torque of the bar on the pinion N m, assistance on the pinion
 * N m.
 *
 * T = k (u1 - u2) + c (u1' - u2') turns the wheel back and the pinion on; the motor adds A = g T / sqrt(1 + (g T / A1)^2)
 * on the pinion: g T where that is small, A1 at most. */
#include "element.h"
#include "element_math.h"

enum { STIFFNESS, DAMPING, GAIN, LARGEST, REALS };

static void evaluate(ali3_element_args *a) {
  const double *p = a->real, twist = a->u[0] - a->u[1];
  const double torque = p[STIFFNESS] * twist + p[DAMPING] * (a->ud[0] - a->ud[1]);
  const double wanted = p[GAIN] * torque, share = p[LARGEST] > 0.0 ? wanted / p[LARGEST] : 0.0;
  const double root = sqrt(1.0 + share * share), assistance = p[LARGEST] > 0.0 ? wanted / root : 0.0;
  a->f[0] = -torque;
  a->f[1] = torque + assistance;
  a->potential = 0.5 * p[STIFFNESS] * twist * twist;
  a->out[0] = torque;
  a->out[1] = assistance;
  if (!a->S) return;
  /* what the wheel's angle does to the pinion through the motor is left out: the tangent is symmetric, and positive */
  const double slope = a->wK * p[STIFFNESS] + a->wC * p[DAMPING];
  const double gain = p[LARGEST] > 0.0 ? p[GAIN] / (root * root * root) : 0.0;
  a->S[0] = slope;
  a->S[1] = a->S[2] = -slope;
  a->S[3] = slope * (1.0 + gain);
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)nsig, (void)nreal, (void)integer, (void)nint, (void)n_inputs, (void)n_roads;
  if (!(real[STIFFNESS] > 0.0)) return "the stiffness of a torsion bar must be positive";
  if (real[DAMPING] < 0.0) return "the damping of a torsion bar must not be negative";
  if (real[GAIN] < 0.0 || real[LARGEST] < 0.0) return "the assistance of a torsion bar must not be negative";
  return 0;
}

const ali3_element_type ali3_torsion_bar = {
    .evaluate = evaluate,
    .nsig = 2,
    .nreal = REALS,
    .nout = 2,
    .check = check,
};
