/* Extrapolation of past steps by Lagrange's polynomial. */
#include "extrapolation.h"

#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"

static const double SMOOTH_RATIO = 0.25; /* largest prediction error relative to the last change of the accelerations */
static const double MAX_RATIO = 2.0; /* longest next step relative to the last one */
static const double CONTROLLED_MAX_RATIO = 4.5; /* of controlled steps: the last was a half, and steps grow */

void ali3_lagrange(const real *time, int32_t n, real t, real *weight) {
  for (int32_t k = 0; k < n; k++) {
    real numerator = ali3_same(1.0), denominator = numerator;
    for (int32_t j = 0; j < n; j++) {
      if (j == k) continue;
      numerator *= t - time[j];
      denominator *= time[k] - time[j];
    }
    weight[k] = numerator / denominator;
  }
}

/* Writes the last mean acceleration minus its prediction from the n steps before, with these weights, to in->step.w. */
ALI3_INLINED void history_miss(const ali3_instance *in, int32_t n, const real *weight) {
  const int32_t nq = in->system->size.nq;
  const real *a = in->now.past_a, *before = a + nq, first = weight[0];
  real *miss = in->step.w;
  ALI3_EACH(0, nq, ALI3_AT(miss) = ALI3_AT(a) - first * ALI3_AT(before))
  for (int32_t k = 1; k < n; k++) ali3_add_multiple(miss, a + (int64_t)(k + 1) * nq, -weight[k], nq);
}

ALI3_BY_PROCESSOR(in->system, void, history_miss, (const ali3_instance *in, int32_t n, const real *weight),
                  (in, n, weight))

/* Whether, before a step h, the n steps before the last predict it much better than constant acceleration. */
ALI3_INLINED lane_mask history_smooth(const ali3_instance *in, int32_t n, double h, bool controlled) {
  const int32_t nq = in->system->size.nq;
  const real *history = in->now.history, *time = history + ALI3_HISTORY_TIME, *a = in->now.past_a, *miss = in->step.w;
  real weight[ALI3_PAST], error = {0}, change = {0};
  const lane_mask near = (history[ALI3_HISTORY_COUNT] > (double)n) &
                         ((controlled ? CONTROLLED_MAX_RATIO : MAX_RATIO) * (time[0] - time[1]) > h);
  if (!ali3_any(near)) return near;
  ali3_lagrange(time + 1, n, time[0], weight);
  history_miss(in, n, weight);
  for (int32_t i = 0; i < nq; i++) {
    const real m = in->mass.floor[i], difference = a[i] - a[nq + i];
    error += m * miss[i] * miss[i];
    change += m * difference * difference;
  }
  return near & (error < SMOOTH_RATIO * SMOOTH_RATIO * change);
}

ALI3_BY_PROCESSOR(in->system, lane_mask, history_smooth,
                  (const ali3_instance *in, int32_t n, double h, bool controlled), (in, n, h, controlled))

/* Weighted sum of n vectors of a length. */
ALI3_INLINED void sum_weighted_vectors(real *restrict to, const real *restrict from, int64_t length, const real *weight,
                                       int32_t n) {
  const real w = weight[0];
  ALI3_EACH(0, length, ALI3_AT(to) = w * ALI3_AT(from))
  for (int32_t k = 1; k < n; k++) ali3_add_multiple(to, from + k * length, weight[k], length);
}

/* Acceleration a (nq) and multipliers (nc) at `time_ahead` from now, extrapolated from n > 0 past ones. */
ALI3_INLINED void extrapolate(const ali3_instance *in, double time_ahead, int32_t n, real *a, real *lam) {
  const ali3_vectors *v = &in->now;
  const int32_t nq = in->system->size.nq, nc = in->system->size.nc;
  real weight[ALI3_PAST];
  ali3_lagrange(v->history + ALI3_HISTORY_TIME, n, ali3_same(time_ahead), weight);
  sum_weighted_vectors(a, v->past_a, nq, weight, n);
  sum_weighted_vectors(lam, v->past_lam, nc, weight, n);
}

ALI3_BY_PROCESSOR(in->system, void, extrapolate,
                  (const ali3_instance *in, double time_ahead, int32_t n, real *a, real *lam),
                  (in, time_ahead, n, a, lam))
