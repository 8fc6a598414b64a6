/* Force F = F_1 a + F_2 b + F_3 c, N, at a point of a body by inputs along the axes a, b, c of a frame that may move
 * with the body; earth axes. Signals: point, then a, b, c, on which there is no force. In the plane only a: the second
 * axis is the first rotated to the left. */
#include "body_force_fields.h"
#include "element.h"
#include "element_math.h"

/* Forces of two inputs along an axis and its normal to the left, and their tangent. */
static void evaluate_in_plane(ali3_element_args *a) {
  const double force1 = ali3_input_or_zero(a->input, a->integer[FIRST]),
               force2 = ali3_input_or_zero(a->input, a->integer[SECOND]);
  const double *axis = a->u + 2;
  a->f[0] = force1 * axis[0] - force2 * axis[1];
  a->f[1] = force1 * axis[1] + force2 * axis[0];
  if (!a->S) return;
  const double block[2][2] = {{force1, -force2}, {force2, force1}}; /* df_p / da */
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) a->S[i * 4 + 2 + j] = a->S[(2 + j) * 4 + i] = -0.5 * a->wK * block[i][j];
}

/* Forces of three inputs along three axes, and their tangent. */
static void evaluate_in_space(ali3_element_args *a) {
  for (int j = 0; j < 3; j++) {
    const double force = ali3_input_or_zero(a->input, a->integer[FIRST + j]);
    for (int i = 0; i < 3; i++) {
      const int s = 3 + 3 * j + i;
      a->f[i] += force * a->u[s];
      if (a->S) a->S[i * 12 + s] = a->S[s * 12 + i] = -0.5 * a->wK * force;
    }
  }
}

static void evaluate(ali3_element_args *a) {
  a->potential = 0.0;
  if (a->nsig == 4)
    evaluate_in_plane(a);
  else
    evaluate_in_space(a);
}

const ali3_element_type ali3_body_force = {
    ALI3_BODY_FORCE,
    .evaluate = evaluate,
    .conservative = true,
};
