/* What force elements share: friction in the tangent, inputs that may be missing, first-order states. */
#ifndef ALI3_ELEMENT_MATH_H
#define ALI3_ELEMENT_MATH_H
#include <stdint.h>

#include "../algebra/small_vectors.h"

/* Friction saturates, and Newton's method with its true, flat tangent may jump between both signs for ever. The secant
 * of friction over rate majorises it: any tangent of more than half the secant makes every iteration a descent. This
 * is the least share used. */
#define ALI3_SECANT_SHARE 0.55

static inline double ali3_input_or_zero(const double *input, int32_t index) { return index >= 0 ? input[index] : 0.0; }

/* Pieces of the law of a slider: it sticks, or slips to one side; one that holds nothing has one piece. */
static inline uint32_t ali3_slider_piece(int sticks, double trial, double bound) {
  return !(bound > 0.0) ? 0u : sticks ? 1u : trial > 0.0 ? 2u : 3u;
}

/* Weight of the new rate in x_new = x_old + h ((1 - theta) x'_old + theta x'_new) for x' = -rate x + ...:
 * 1/2 (trapezoidal rule, order two) while it does not ring, then just enough more that x keeps its sign. */
static inline double ali3_theta(double h, double rate) {
  double z = h * rate;
  return z > 2.0 ? 1.0 - 1.0 / z : 0.5;
}
#endif
