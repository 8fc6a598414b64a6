/* Force at a point of a body, given by inputs along the axes of a frame that may move with the body.
 * Signals: p (3), a, b, c (9); in the plane p (2), a (2), the second axis being a turned left.
 * Integers: the inputs along a, b, c, -1 for none. Outputs: none. */
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

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)real, (void)nreal, (void)n_roads;
  if (nsig != 12 && nsig != 4) return "a body force needs 12 signals in space or 4 in the plane";
  for (int32_t i = 0; i < nint; i++)
    if (integer[i] < -1 || integer[i] >= n_inputs) return "a body force names an input that does not exist";
  return 0;
}

const ali3_element_type ali3_body_force = {
    .evaluate = evaluate,
    .conservative = true,
    .nsig = -1,
    .nint = 3,
    .check = check,
};
