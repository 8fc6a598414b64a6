/* First guess of the increment and the multipliers of an ALi3-P step. Where the motion has been smooth, mean accelerations
 * and multipliers go on along the parabola through those of the last three steps; else the present ones stay. Flexible
 * bodies have modes that vibrate faster than the step can follow; the trapezoidal rule lets their rates and accelerations
 * ring, and with them those of all that is tied to them, but not the positions. There the mean rates of the last two
 * steps go on. */
#include <string.h>

#include "ali3_internal.h"

enum { PARABOLA = 3 };
static const double SMOOTH =
    0.25; /* error of the parabola at the last step, by the change of the accelerations there */
static const double FAR = 2.0; /* times the last step that the next may be long */
/* Share of the change of the multipliers that is taken: no step corrects what they have along dependent rows, and
 * whole extrapolations of it would grow. */
static const double SHARE = 0.9;

/* Whether the parabola through the three steps before the last would have told the last. */
static bool smooth(const ali3_instance *in, double h) {
  const int32_t nq = in->system->size.nq;
  const double *memory = in->now.memory, *time = memory + ALI3_MEMORY_TIME, *a = in->now.past_a;
  double weight[PARABOLA], error = 0.0, change = 0.0;
  if (!(memory[ALI3_MEMORY_COUNT] > (double)PARABOLA && h < FAR * (time[0] - time[1]))) return false;
  for (int32_t k = 0; k < PARABOLA; k++) {
    weight[k] = 1.0; /* Lagrange */
    for (int32_t j = 0; j < PARABOLA; j++)
      if (j != k) weight[k] *= (time[0] - time[j + 1]) / (time[k + 1] - time[j + 1]);
  }
  for (int32_t i = 0; i < nq; i++) {
    const double m = in->system->mass_floor[i], one = a[i] - a[nq + i];
    const double all = a[i] - weight[0] * a[nq + i] - weight[1] * a[2 * nq + i] - weight[2] * a[3 * nq + i];
    error += m * all * all;
    change += m * one * one;
  }
  return error < SMOOTH * SMOOTH * change;
}

void ali3_predict(ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  const ali3_vectors *from = &in->now;
  double *lam = in->next.lam;
  if (S->n_flexible > 0) {
    for (int32_t i = 0; i < S->size.nq; i++) in->D[i] = h * (2.0 * from->mean[i] - from->mean_before[i]);
    memcpy(lam, from->lam, (size_t)S->size.nc * sizeof *lam);
    return;
  }
  ali3_history_own(in, in->settings.method, from->qdd);
  const bool goes_on = in->settings.predictor == ALI3_PREDICTOR_PARABOLA && smooth(in, h);
  ali3_history_predict(in, 0.5 * h, goes_on ? PARABOLA : 0, in->x, lam);
  for (int32_t k = 0; k < S->size.nc; k++) lam[k] = from->lam[k] + SHARE * (lam[k] - from->lam[k]);
  for (int32_t i = 0; i < S->size.nq; i++) in->D[i] = h * from->qd[i] + 0.5 * h * h * in->x[i];
}

/* Keeps the mean acceleration and the multipliers of the step from in->now to in->next. */
void ali3_predict_accept(ali3_instance *in, double h) {
  if (in->system->n_flexible > 0) return;
  for (int32_t i = 0; i < in->system->size.nq; i++) in->x[i] = 2.0 * (in->D[i] - h * in->now.qd[i]) / (h * h);
  ali3_history_append(in, h, in->x);
}

/* Keeps the mean rate of the step from in->now to in->next, of systems with flexible bodies. */
void ali3_predict_rates(ali3_instance *in, double h) {
  if (in->system->n_flexible == 0) return;
  for (int32_t i = 0; i < in->system->size.nq; i++) {
    in->next.mean[i] = in->D[i] / h;
    in->next.mean_before[i] = in->now.mean[i];
  }
}
