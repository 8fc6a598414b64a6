/* Spring and damper on one signal: torsional spring on an angle, or a spring along a coordinate.
 * Reals: stiffness, damping, free value, constant force. Outputs: generalised force (N or N m). */
#include "element.h"

enum { STIFFNESS, DAMPING, FREE_VALUE, CONSTANT, REALS };

static void evaluate(ali3_element_args *a) {
  const double *p = a->real;
  const double stretch = a->u[0] - p[FREE_VALUE];
  a->f[0] = p[CONSTANT] - p[STIFFNESS] * stretch - p[DAMPING] * a->ud[0];
  a->out[0] = a->f[0];
  a->potential = 0.5 * p[STIFFNESS] * stretch * stretch - p[CONSTANT] * stretch;
  if (a->S) a->S[0] = a->wK * p[STIFFNESS] + a->wC * p[DAMPING];
}

static bool lossy(const double *real, int32_t nreal) {
  (void)nreal;
  return real[DAMPING] != 0.0;
}

const ali3_element_type ali3_scalar_spring_damper = {
    .evaluate = evaluate,
    .conservative = true,
    .lossy = lossy,
    .nsig = 1,
    .nreal = REALS,
    .nout = 1,
};
