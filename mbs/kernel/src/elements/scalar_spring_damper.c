/* Spring and damper on one signal: torsional spring on an angle, or a spring along a coordinate.
 * f = constant - k (u - u0) - c u', with a factor on k and one on c. */
#include "element.h"
#include "scalar_spring_damper_fields.h"

static void evaluate(ali3_element_args *a) {
  const double *p = a->real;
  const double k = p[STIFFNESS] * p[STIFFNESS_FACTOR];
  const double c = p[DAMPING] * p[DAMPING_FACTOR];
  const double deflection = a->u[0] - p[FREE_VALUE];
  a->f[0] = p[CONSTANT] - k * deflection - c * a->ud[0];
  a->out[SCALAR_SPRING_DAMPER_OUT_FORCE] = a->f[0];
  a->potential = 0.5 * k * deflection * deflection - p[CONSTANT] * deflection;
  if (a->S) a->S[0] = a->wK * k + a->wC * c;
}

static bool is_lossy(const double *real, int32_t nreal, const int32_t *integer) {
  (void)nreal, (void)integer;
  return real[DAMPING] * real[DAMPING_FACTOR] != 0.0;
}

const ali3_element_type ali3_scalar_spring_damper = {
    ALI3_SCALAR_SPRING_DAMPER,
    .evaluate = evaluate,
    .conservative = true,
    .lossy = is_lossy,
};
