/* Values and rates of signals, affine functions of the coordinates. */
#ifndef ALI3_SIGNAL_H
#define ALI3_SIGNAL_H
#include "../algebra/number_pairs.h"
#include "../instance.h"

/* Value of signal i at coordinates x; rate: x holds rates or accelerations, and the constant is left out. */
static inline double ali3_signal_at(const ali3_system *S, int32_t i, const double *x, bool rate) {
  double sum = rate ? 0.0 : S->sig_const[i];
  ALI3_SHORT
  for (int32_t k = S->sig_ptr[i]; k < S->sig_ptr[i + 1]; k++) sum += S->sig_val[k] * x[S->sig_col[k]];
  return sum;
}

/* Derivative of coordinate i (or of its rate) by the angle of a rotation of the scene to the left about the origin. */
static inline double ali3_turned(const ali3_system *S, int32_t i, const double *x, bool rate) {
  const int32_t partner = S->pose_partner[i];
  if (partner == 0) return 0.0;
  return partner < 0 ? -ali3_signal_at(S, -partner - 1, x, rate) : ali3_signal_at(S, partner - 1, x, rate);
}
#endif
