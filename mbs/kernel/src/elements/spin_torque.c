/* Torque T = GAIN times an input, N m, on a wheel's spin about its axis; the carrier takes the reaction -T, by
 * generalised forces -T g/2 on f and T f/2 on g.
 * f and g are orthonormal on the carrier with f x g along the axis; the rate of the spin is absolute. */
#include "element.h"
#include "element_math.h"
#include "spin_torque_fields.h"

static void evaluate(ali3_element_args *a) {
  const double torque = a->real[GAIN] * a->input[a->integer[INPUT]];
  for (int i = 0; i < 3; i++) {
    a->f[i] = -0.5 * torque * a->u[3 + i]; /* no contribution to S: the tangent is antisymmetric */
    a->f[3 + i] = 0.5 * torque * a->u[i];
  }
  a->f[6] = torque;
  a->potential = 0.0;
  a->out[SPIN_TORQUE_OUT_TORQUE] = torque;
  a->out[SPIN_TORQUE_OUT_POWER] = torque * (a->ud[6] - 0.5 * (ali3_dot(a->ud, a->u + 3) - ali3_dot(a->ud + 3, a->u)));
}

const ali3_element_type ali3_spin_torque = {
    ALI3_SPIN_TORQUE,
    .evaluate = evaluate,
    .conservative = true,
};
