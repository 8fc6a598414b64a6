/* Time within a step at which a gap closes or opens. */
#ifndef ALI3_CROSSING_H
#define ALI3_CROSSING_H

/* Least distance of a division of a step from its ends, as a fraction of the step. */
#define ALI3_AT_END 0.01

/* First fraction of a step of length h, s, from ALI3_AT_END to 1 - ALI3_AT_END, at which the cubic through the gaps, m,
 * and their rates at both ends is zero; 1: none. */
double ali3_crossing(double h, const double gap[2], const double rate[2]);
#endif
