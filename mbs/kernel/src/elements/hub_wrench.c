/* Force F, N, and moment M, N m, on the hub of a wheel by inputs in earth axes, instead of a tyre. Generalised forces:
 * F on the centre (signals 0 to 2) and M x e on the axis e (3 to 5), both on the carrier, M . e on the spin (6). */
#include "element.h"
#include "element_math.h"
#include "hub_wrench_fields.h"

static void evaluate(ali3_element_args *a) {
  double force[3], moment[3];
  const double *e = a->u + 3;
  for (int i = 0; i < 3; i++) {
    force[i] = a->input[a->integer[FORCE_X + i]];
    moment[i] = a->input[a->integer[MOMENT_X + i]];
    a->f[i] = force[i];
  }
  ali3_cross(moment, e, a->f + 3); /* no contribution to S: the tangent is antisymmetric */
  a->f[6] = ali3_dot(moment, e);
  a->potential = 0.0;
  a->out[HUB_WRENCH_OUT_POWER] = 0.0;
  for (int i = 0; i < 7; i++) a->out[HUB_WRENCH_OUT_POWER] += a->f[i] * a->ud[i];
  for (int i = 0; a->S && i < 3; i++) a->S[6 * 7 + 3 + i] = a->S[(3 + i) * 7 + 6] = -0.5 * a->wK * moment[i];
}

const ali3_element_type ali3_hub_wrench = {
    ALI3_HUB_WRENCH,
    .evaluate = evaluate,
    .conservative = true,
};
