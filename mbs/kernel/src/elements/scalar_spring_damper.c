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

extern const ali3_element_type ali3_scalar_spring_damper;
const ali3_element_type ali3_scalar_spring_damper = {evaluate, 0, 1, REALS, 0, 0, 1, 0};
