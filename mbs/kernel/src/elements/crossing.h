/* Time within a step at which a gap closes or opens. */
#ifndef ALI3_CROSSING_H
#define ALI3_CROSSING_H

/* Share of a step: nearer to one of its ends a step is not divided. */
#define ALI3_AT_END 0.01

/* The first share of a step of size h, from ALI3_AT_END to 1 - ALI3_AT_END, at which the cubic through the gaps at both
 * ends with their rates passes through zero; else 1. */
double ali3_crossing(double h, const double gap[2], const double rate[2]);
#endif
