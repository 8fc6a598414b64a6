/* Force at a point of a body, given by inputs along the axes of a frame that may move with the body.
 * In the plane the second axis is the first turned left. */
#include "body_force_fields.h"
#include "element.h"
#include "element_math.h"

static void evaluate(ali3_element_args *a) {
  a->potential = 0.0;
  if (a->nsig == 4) {
    const double m1 = ali3_input_or_zero(a->input, a->integer[0]), m2 = ali3_input_or_zero(a->input, a->integer[1]);
    const double *axis = a->u + 2;
    a->f[0] = m1 * axis[0] - m2 * axis[1];
    a->f[1] = m1 * axis[1] + m2 * axis[0];
    if (!a->S) return;
    const double block[2][2] = {{m1, -m2}, {m2, m1}}; /* df_p / da */
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) a->S[i * 4 + 2 + j] = a->S[(2 + j) * 4 + i] = -0.5 * a->wK * block[i][j];
    return;
  }
  for (int j = 0; j < 3; j++) {
    const double m = ali3_input_or_zero(a->input, a->integer[j]);
    for (int i = 0; i < 3; i++) {
      const int s = 3 + 3 * j + i;
      a->f[i] += m * a->u[s];
      if (a->S) a->S[i * 12 + s] = a->S[s * 12 + i] = -0.5 * a->wK * m;
    }
  }
}

const ali3_element_type ali3_body_force = {
    ALI3_BODY_FORCE,
    .evaluate = evaluate,
    .conservative = true,
};
