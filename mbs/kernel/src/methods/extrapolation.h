/* Extrapolation of past accelerations and multipliers (in->now.past_a, past_lam) by Lagrange's polynomial; times in s,
 * relative to now. */
#ifndef ALI3_EXTRAPOLATION_H
#define ALI3_EXTRAPOLATION_H
#include "../algebra/real.h"
#include "../instance.h"

/* Lagrange weights (n) by which values at n times extrapolate to time t. */
ALI3_PER_WIDTH void ali3_lagrange(const real *time, int32_t n, real t, real *weight);
/* Writes the last mean acceleration minus its prediction from the n steps before, with these weights, to in->step.w
 * (nq). */
ALI3_PER_WIDTH void ali3_history_miss(const ali3_instance *in, int32_t n, const real *weight);
/* Whether, before a step h, s, the n steps before the last predict it much better than constant acceleration. */
ALI3_PER_WIDTH lane_mask ali3_history_smooth(const ali3_instance *in, int32_t n, double h, bool controlled);
/* Acceleration a (nq) and multipliers lam (nc) `time_ahead` ahead of now, s, extrapolated from n > 0 past ones. */
ALI3_PER_WIDTH void ali3_extrapolate(const ali3_instance *in, double time_ahead, int32_t n, real *a, real *lam);
#endif
