/* An input times constant weights: f_i = w_i * input. Reals: one weight per signal. Integers: input. Outputs: none. */
#include "element.h"

static void evaluate(ali3_element_args *a) {
  const double value = a->input[a->integer[0]];
  for (int32_t i = 0; i < a->nsig; i++) a->f[i] = a->real[i] * value;
  a->potential = 0.0;
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)real, (void)nint, (void)n_roads;
  if (nreal != nsig) return "an input force needs one weight per signal";
  if (integer[0] < 0 || integer[0] >= n_inputs) return "an input force names an input that does not exist";
  return 0;
}

const ali3_element_type ali3_input_force = {
    .evaluate = evaluate,
    .conservative = true,
    .nsig = -1,
    .nreal = -1,
    .nint = 1,
    .check = check,
};
