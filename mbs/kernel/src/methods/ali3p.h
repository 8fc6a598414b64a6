/* Constants of an ALi3-P step. */
#ifndef ALI3_ALI3P_H
#define ALI3_ALI3P_H
#include <math.h>

#include "../system.h"
#include "defect_correction.h"

enum { MAX_SWEEPS = 3 };
/* Relative violations at which projections end: of velocities round-off; accelerations are only used in the next
 * prediction. */
static const double VELOCITY_TOLERANCE = 1e-12, ACCELERATION_TOLERANCE = 1e-9;
/* A tangent is reused if the violation is at most REUSE_VIOLATION h^2, with h at most 10 ms, and the last iteration
 * reduced the residual to REUSE_RESIDUAL or less. The remaining violation is an error of the multipliers where the
 * lever of a row vanishes. */
static const double CLOSES = 0.5; /* ratio of violations above which rows have converged as far as they can */
static const double REUSE_VIOLATION = 2e-5, REUSE_RESIDUAL = 0.3;

/* If the residual decreases, rates of signals change by less than REACH residuals times 2/h afterwards (`reach` of
 * ali3_element_args); used in Systems with flexible bodies, whose iterations are expensive. With an eighth of it some
 * steps did not converge; after MAX_SETTLING iterations sliders use their secants again. */
static const double REACH = 4.0;
enum { MAX_SETTLING = 12 };
/* Whether sliders use REACH after this number of iterations. */
static inline bool ali3_settles(const ali3_system *S, int32_t iterations) {
  return ali3_defect_corrected(S) && iterations <= MAX_SETTLING;
}

/* Round-off of positions, m, that projections may leave in rates: its effect on accelerations and multipliers is small
 * against that of gravity. */
static inline double ali3_allowed_round_off(const ali3_system *S, double c) {
  return fmin(S->largest_round, ACCELERATION_TOLERANCE * S->fall * c);
}
#endif
