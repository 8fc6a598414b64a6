/* Constants of an ALi3-P step. */
#ifndef ALI3_ALI3P_H
#define ALI3_ALI3P_H
#include <math.h>

#include "../system.h"

enum { MAX_SWEEPS = 3 };
/* Relative violations at which projections end: velocities at round-off; accelerations only steer the next
 * prediction. */
static const double VELOCITY_TOLERANCE = 1e-12, ACCELERATION_TOLERANCE = 1e-9;
/* A tangent serves the next iteration too where rows are open by at most so many m/s2 (or so) times h^2, no more than at
 * 10 ms, and the last one left at most so much of the residual. What is left open is an error of the multipliers where
 * a row loses its lever. */
static const double KEPT_VIOLATION = 2e-5, KEPT_RESIDUAL = 0.3;

/* Round-off of positions, m, that projections leave in rates: what it makes of accelerations, and so of multipliers, is
 * small beside those of bodies that fall. */
static inline double ali3_round_left(const ali3_system *S, double c) {
  return fmin(S->largest_round, ACCELERATION_TOLERANCE * S->fall * c);
}
#endif
