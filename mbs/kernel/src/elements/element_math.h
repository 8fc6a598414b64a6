/* What force elements share: friction in the tangent, optional inputs, first-order states. */
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

/* A deflection that has decreased to less is set to 0 with its rate, which avoids denormal numbers. */
#define ALI3_NEGLIGIBLE 1e-100

/* Weight of the new rate in x_new = x_old + h ((1 - theta) x'_old + theta x'_new) for x' = -rate x + ...: 1/2
 * (trapezoidal rule, order two) while it does not oscillate, above that as much more as x needs to keep its sign. */
static inline real ali3_theta(double h, real rate) {
  real z = h * rate;
  return ali3_where(z > 2.0, 1.0 - 1.0 / z, ali3_same(0.5));
}
#endif
