/* Force and moment on the hub of a wheel from inputs, earth axes, in place of a tyre: what turns about the axis acts on
 * the spin, the rest on the carrier.
 * Signals: wheel centre r (3), unit spin axis e (3), chi with chi' = Omega the absolute rate about it.
 * Integers: the inputs of F (3) and M (3). Outputs: power of both W. */
#include "element.h"
#include "element_math.h"

enum { INPUTS = 6 };

static void evaluate(ali3_element_args *a) {
  double force[3], moment[3];
  const double *e = a->u + 3;
  for (int i = 0; i < 3; i++) {
    force[i] = a->input[a->integer[i]];
    moment[i] = a->input[a->integer[3 + i]];
    a->f[i] = force[i];
  }
  ali3_cross(moment, e, a->f + 3); /* its tangent is antisymmetric */
  a->f[6] = ali3_dot(moment, e);
  a->potential = 0.0;
  a->out[0] = 0.0;
  for (int i = 0; i < 7; i++) a->out[0] += a->f[i] * a->ud[i];
  for (int i = 0; a->S && i < 3; i++) a->S[6 * 7 + 3 + i] = a->S[(3 + i) * 7 + 6] = -0.5 * a->wK * moment[i];
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)nsig, (void)real, (void)nreal, (void)nint, (void)n_roads;
  for (int i = 0; i < INPUTS; i++)
    if (integer[i] < 0 || integer[i] >= n_inputs) return "a wrench on a hub names an input that does not exist";
  return 0;
}

const ali3_element_type ali3_hub_wrench = {
    .evaluate = evaluate,
    .conservative = true,
    .nsig = 7,
    .nint = INPUTS,
    .nout = 1,
    .check = check,
};
