/* Torque from an input between a wheel's spin and its carrier, which takes the reaction.
 * Signals: f (3), g (3) orthonormal on the carrier with f x g along the axis, chi with chi' = Omega the absolute rate
 * about it. Reals: torque on the wheel per unit of the input, N m. Integers: input. Outputs: torque on the wheel N m, its
 * power on wheel and carrier together W. */
#include "element.h"
#include "element_math.h"

static void evaluate(ali3_element_args *a) {
  const double torque = a->real[0] * a->input[a->integer[0]];
  for (int i = 0; i < 3; i++) {
    a->f[i] = -0.5 * torque * a->u[3 + i]; /* its tangent is antisymmetric */
    a->f[3 + i] = 0.5 * torque * a->u[i];
  }
  a->f[6] = torque;
  a->potential = 0.0;
  a->out[0] = torque;
  a->out[1] = torque * (a->ud[6] - 0.5 * (ali3_dot(a->ud, a->u + 3) - ali3_dot(a->ud + 3, a->u)));
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)nsig, (void)real, (void)nreal, (void)nint, (void)n_roads;
  return integer[0] < 0 || integer[0] >= n_inputs ? "a spin torque names an input that does not exist" : 0;
}

const ali3_element_type ali3_spin_torque = {
    .evaluate = evaluate,
    .conservative = true,
    .nsig = 7,
    .nreal = 1,
    .nint = 1,
    .nout = 2,
    .check = check,
};
