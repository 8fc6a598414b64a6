/* History of the methods besides q, qd, qdd, and start values from it: mean accelerations and multipliers of past
 * steps, extrapolated by the polynomial through the middles of the steps. */
#include <math.h>
#include <string.h>

#include "../instance.h"
#include "../state/vectors.h"
#include "extrapolation.h"
#include "history.h"

static const double GOOD_GUESS = 1e-4;   /* squared relative error of a good guess */

/* Number of past steps, at most `most`; a restored state may hold any number there. */
static int32_t past_count(const ali3_vectors *v, int32_t most) {
  const double count = v->history[ALI3_HISTORY_COUNT];
  return count < (double)most ? (count > 0.0 ? (int32_t)count : 0) : most;
}

void ali3_history_own(ali3_instance *in, int32_t method, const double *own) {
  double *history = in->now.history;
  if (history[ALI3_HISTORY_OWNER] == (double)method) return;
  ali3_back_up(in);
  memset(history, 0, ALI3_HISTORY * sizeof *history);
  history[ALI3_HISTORY_OWNER] = (double)method;
  memcpy(in->now.own, own, (size_t)in->system->size.nq * sizeof *own);
}

/* Number of past steps, at most `most`, to extrapolate from: those that predict the last step best; all if all before
 * it do, or well enough. In fast oscillations old steps are misleading. */
int32_t ali3_history_order(const ali3_instance *in, int32_t most) {
  const ali3_vectors *v = &in->now;
  const int32_t nq = in->system->size.nq, n = past_count(v, most);
  const double *time = v->history + ALI3_HISTORY_TIME;
  double smallest = HUGE_VAL, weight[ALI3_PAST];
  int32_t best = n;
  if (n <= 2) return n;
  for (int32_t m = n - 1; m > 0; m--) {
    double error = 0.0, square = 0.0;
    ali3_lagrange(time + 1, m, time[0], weight);
    ali3_history_miss(in, m, weight);
    for (int32_t i = 0; i < nq; i++) {
      error += in->step.w[i] * in->step.w[i];
      square += v->past_a[i] * v->past_a[i];
    }
    if (error < smallest) {
      smallest = error;
      best = m == n - 1 ? n : m;
    }
    if (smallest <= GOOD_GUESS * square) break;
  }
  return best;
}

void ali3_history_predict(const ali3_instance *in, double time_ahead, int32_t most, double *a, double *lam) {
  const ali3_vectors *v = &in->now;
  const int32_t nq = in->system->size.nq, nc = in->system->size.nc;
  const int32_t n = past_count(v, most);
  if (n == 0) {
    memcpy(a, v->qdd, (size_t)nq * sizeof *a);
    memcpy(lam, v->lam, (size_t)nc * sizeof *lam);
    return;
  }
  ali3_extrapolate(in, time_ahead, n, a, lam);
}

void ali3_history_shift(ali3_instance *in, double h) {
  const ali3_vectors *from = &in->now, *to = &in->next;
  const size_t nq = (size_t)in->system->size.nq, nc = (size_t)in->system->size.nc;
  const int32_t n = past_count(from, ALI3_PAST);
  to->history[ALI3_HISTORY_OWNER] = from->history[ALI3_HISTORY_OWNER];
  to->history[ALI3_HISTORY_COUNT] = n < ALI3_PAST ? n + 1 : n;
  to->history[ALI3_HISTORY_TIME] = -0.5 * h;
  for (int32_t k = 1; k < ALI3_PAST; k++)
    to->history[ALI3_HISTORY_TIME + k] = from->history[ALI3_HISTORY_TIME + k - 1] - h;
  memcpy(to->past_a + nq, from->past_a, (ALI3_PAST - 1) * nq * sizeof(double));
  memcpy(to->past_lam + nc, from->past_lam, (ALI3_PAST - 1) * nc * sizeof(double));
}

void ali3_history_append(ali3_instance *in, double h, const double *a) {
  ali3_history_shift(in, h);
  memcpy(in->next.past_a, a, (size_t)in->system->size.nq * sizeof *a);
  memcpy(in->next.past_lam, in->next.lam, (size_t)in->system->size.nc * sizeof *a);
}

/* Velocity at the end of the step for the states of elements: linear through the mean velocities of this step and the
 * last. The deviation of the carried velocity from it alternates in sign; a sticking tyre or brake would follow it as a
 * motion, and creep. Summed over many steps these velocities give the displacement. */
void ali3_history_velocity(const ali3_instance *in, double h, double *v) {
  const ali3_vectors *from = &in->now;
  const int32_t nq = in->system->size.nq;
  const double half = -from->history[ALI3_HISTORY_TIME]; /* of the last step */
  if (!(from->history[ALI3_HISTORY_COUNT] >= 1.0)) {
    memcpy(v, in->next.own, (size_t)nq * sizeof *v);
    return;
  }
  const double weight = 0.5 * h / (0.5 * h + half);
  double projection = 0.0, square = 0.0;
  for (int32_t i = 0; i < nq; i++) {
    const double last = from->own[i] - half * from->past_a[i];
    const double linear = weight * (in->discrete.rate[i] - last), m = in->mass.floor[i];
    v[i] = in->next.own[i] - in->discrete.rate[i];
    projection += m * v[i] * linear;
    square += m * v[i] * v[i];
  }
  const double factor = square > 0.0 ? fmin(1.0, fmax(0.0, projection / square)) : 0.0;
  for (int32_t i = 0; i < nq; i++) v[i] = in->discrete.rate[i] + factor * v[i];
}
