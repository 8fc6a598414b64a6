/* Functions that force elements share: friction in the tangent, optional inputs, first-order states. */
#ifndef ALI3_ELEMENT_MATH_H
#define ALI3_ELEMENT_MATH_H
#include <stdint.h>

#include "../algebra/small_vectors.h"

/* Friction saturates, and Newton's method with its exact, zero tangent may alternate between both signs. The secant of
 * friction over rate majorises it: with any tangent above half the secant each iteration is a descent. This is the
 * least fraction used. */
#define ALI3_SECANT_FRACTION 0.55

/* Value of an optional input; index -1: none. */
static inline real ali3_input_or_zero(const real *input, int32_t index) {
  return index >= 0 ? input[index] : ali3_same(0.0);
}

/* Slope of a slider of damping D by its rate, for the tangent: its own, zero, if the rate cannot return to sticking. */
static inline real ali3_slider_slope(truth sticks, real D, real trial, real bound, real reach) {
  const real size = ali3_abs(trial), none = {0};
  const truth stays = (reach > 0.0) & (size - bound > D * reach);
  return ali3_where(sticks, D, ali3_where(stays, none, ALI3_SECANT_FRACTION * D * (bound / size)));
}

/* Pieces of the law of a slider: it sticks, or slips in one direction; none without friction. */
enum { ALI3_STICKS = 1, ALI3_SLIPS_UP = 2, ALI3_SLIPS_DOWN = 4 };
/* Adds the active piece to *piece. */
static inline void ali3_slider_piece(uint32_t *piece, truth sticks, real trial, real bound) {
  const truth holds = bound > 0.0, slips = holds & ali3_not(sticks);
  ALI3_PIECE(piece, holds & sticks, ALI3_STICKS);
  ALI3_PIECE(piece, slips & (trial > 0.0), ALI3_SLIPS_UP);
  ALI3_PIECE(piece, slips & ali3_not(trial > 0.0), ALI3_SLIPS_DOWN);
}

/* Weight of the new rate in x_new = x_old + h ((1 - theta) x'_old + theta x'_new) for x' = -rate x + ...: 1/2
 * (trapezoidal rule, order two) while it does not oscillate, above that as much more as x needs to keep its sign. */
static inline real ali3_theta(double h, real rate) {
  real z = h * rate;
  return ali3_where(z > 2.0, 1.0 - 1.0 / z, ali3_same(0.5));
}
#endif
