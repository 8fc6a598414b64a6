/* Constants of an ALi3-P step. */
#ifndef ALI3_ALI3P_H
#define ALI3_ALI3P_H
#include <math.h>

#include "../system.h"
#include "defect_correction.h"

enum { MAX_SWEEPS = 3 };
/* Relative violations at which projections end: velocities at round-off; accelerations only steer the next
 * prediction. */
static const double VELOCITY_TOLERANCE = 1e-12, ACCELERATION_TOLERANCE = 1e-9;
/* A tangent serves the next iteration too where rows are open by at most so many m/s2 (or so) times h^2, no more than at
 * 10 ms, and the last one left at most so much of the residual. What is left open is an error of the multipliers where
 * a row loses its lever. */
static const double CLOSES = 0.5; /* of the violation before: rows that stay above it close no further */
static const double KEPT_VIOLATION = 2e-5, KEPT_RESIDUAL = 0.3;

/* If the last iteration left less than the one before, rates of signals change by less than REACH residuals times 2/h
 * from there on (`reach` of ../elements/element.h), in Systems whose iterations are dear. With an eighth of it wild
 * steps went round in circles; after MOST_SETTLING iterations sliders have their secants again. */
static const double REACH = 4.0;
enum { MOST_SETTLING = 12 };
static inline bool ali3_settles(const ali3_system *S, int32_t iterations) {
  return ali3_defect_corrected(S) && iterations <= MOST_SETTLING;
}

/* Round-off of positions, m, that projections leave in rates: what it makes of accelerations, and so of multipliers, is
 * small beside those of bodies that fall. */
static inline double ali3_round_left(const ali3_system *S, double c) {
  return fmin(S->largest_round, ACCELERATION_TOLERANCE * S->fall * c);
}
#endif
