/* An input times constant weights: f_i = w_i input on signal i. Reals: a weight for each signal, in units of its force
 * per unit of the input. */
#include "element.h"
#include "input_force_fields.h"

static void evaluate(ali3_element_args *a) {
  const double value = a->input[a->integer[INPUT]];
  for (int32_t i = 0; i < a->nsig; i++) a->f[i] = a->real[i] * value;
  a->potential = 0.0;
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint) {
  (void)real, (void)integer, (void)nint;
  return nreal != nsig ? "an input force needs one weight per signal" : 0;
}

const ali3_element_type ali3_input_force = {
    ALI3_INPUT_FORCE,
    .evaluate = evaluate,
    .conservative = true,
    .check = check,
};
