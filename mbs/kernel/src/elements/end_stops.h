/* Bump and rebound stops of springs: laws of contact_law.h beyond two lengths. */
#ifndef ALI3_END_STOPS_H
#define ALI3_END_STOPS_H
#include <stdbool.h>
#include <stdint.h>

#include "../algebra/real.h"

/* Reals of stops (m, N/m, s/m); without the last eight they are linear. */
enum {
  ALI3_BUMP_LENGTH,
  ALI3_BUMP_STIFFNESS,
  ALI3_REBOUND_LENGTH,
  ALI3_REBOUND_STIFFNESS,
  ALI3_LINEAR_STOPS,
  ALI3_PROGRESSION = ALI3_LINEAR_STOPS, /* of bump, then of rebound, as travel and loss */
  ALI3_STOP_TRAVEL = ALI3_PROGRESSION + 2,
  ALI3_METAL_STIFFNESS = ALI3_STOP_TRAVEL + 2,
  ALI3_METAL_ONSET,
  ALI3_STOP_LOSS
};

/* A tension, positive where it pulls the ends together. */
typedef struct {
  real elastic, lost; /* N: its conservative and its dissipative part */
  real stiffness, damping; /* its slopes by the length, N/m, and by the rate, N s/m */
  real potential; /* J: energy of the elastic part */
  uint32_t piece; /* bits: bump stop, rebound stop in contact */
} ali3_tension;

/* Adds the tension of the stops at a length, m, and its rate, m/s. */
ALI3_PER_WIDTH void ali3_end_stops_at(const real *p, int progressive, real length, real rate, ali3_tension *t);

/* Adds their mean over a step from length l0 to l1, with slopes by the length and rate in its middle. */
void ali3_end_stops_between(const double *p, int progressive, double l0, double l1, double rate, ali3_tension *t);

/* Fraction of a step of size h, s, at which a stop is met or left, from length and rate at both ends; 1: none is. */
double ali3_end_stops_event(const double *p, const double length[2], const double rate[2], double h);

/* Whether a length lies beyond a stop. */
bool ali3_end_stops_beyond(const double *p, double length);

/* NULL or one sentence about progressive stops. */
const char *ali3_end_stops_check(const double *p);
#endif
