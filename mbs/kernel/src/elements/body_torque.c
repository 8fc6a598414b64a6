/* Torque on a body from inputs, in earth or body axes. For orthonormal a, b, c the generalised forces (m x a)/2, (m x
 * b)/2, (m x c)/2 do the work m . dtheta, and none on the conditions that keep the frame orthonormal.
 * Signals: the vectors a, b, c of the frame; in the plane only a, with the third input. Integer AXES: 1: inputs are
 * components in body axes, 0: in earth axes. */
#include "body_torque_fields.h"
#include "element.h"
#include "element_math.h"

/* f = m x a: in the plane the frame is the vector a only. */
static void evaluate_planar(ali3_element_args *a) {
  const double m = ali3_input_or_zero(a->input, a->integer[THIRD]);
  a->f[0] = -m * a->u[1]; /* its tangent is antisymmetric */
  a->f[1] = m * a->u[0];
}

static void evaluate(ali3_element_args *a) {
  a->potential = 0.0;
  if (a->nsig == 2) {
    evaluate_planar(a);
    return;
  }
  double input[3], m[3];
  for (int j = 0; j < 3; j++) m[j] = input[j] = ali3_input_or_zero(a->input, a->integer[j]);
  if (a->integer[AXES])
    for (int i = 0; i < 3; i++) m[i] = input[0] * a->u[i] + input[1] * a->u[3 + i] + input[2] * a->u[6 + i];
  for (int j = 0; j < 3; j++) {
    ali3_cross(m, a->u + 3 * j, a->f + 3 * j);
    for (int i = 0; i < 3; i++) a->f[3 * j + i] *= 0.5;
  }
  if (!a->S || !a->integer[AXES]) return; /* in earth axes the tangent is antisymmetric */
  for (int j = 0; j < 3; j++)
    for (int k = 0; k < 3; k++) { /* block (j, k): (m_k [v_j]x - m_j [v_k]x) / 4 */
      double x[3];
      for (int i = 0; i < 3; i++) x[i] = 0.25 * a->wK * (input[k] * a->u[3 * j + i] - input[j] * a->u[3 * k + i]);
      double *S = a->S + 27 * j + 3 * k;
      S[1] = -x[2], S[2] = x[1];
      S[9] = x[2], S[11] = -x[0];
      S[18] = -x[1], S[19] = x[0];
    }
}

const ali3_element_type ali3_body_torque = {
    ALI3_BODY_TORQUE,
    .evaluate = evaluate,
    .conservative = true,
};
