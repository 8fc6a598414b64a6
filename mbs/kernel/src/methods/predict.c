/* Prediction of the increment and multipliers of an ALi3-P step. After smooth motion mean accelerations and multipliers
 * are extrapolated by the parabola through the last three steps; otherwise the present ones are used. Flexible bodies
 * have modes that steps do not resolve; the trapezoidal rule lets their rates and accelerations oscillate, but not
 * their positions, so that the mean velocities of the last two steps are extrapolated. */
#include <string.h>

#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../instance.h"
#include "extrapolation.h"
#include "history.h"
#include "predict.h"

/* Writes the prediction; returns whether past steps were used. `from_past` false: they are not. */
ALI3_INLINED bool predict(ali3_instance *in, const ali3_request *request, bool from_past) {
  const double h = request->h;
  const ali3_system *S = in->system;
  const ali3_vectors *from = &in->now;
  double *lam = in->next.lam;
  if (S->n_flexible > 0) {
    for (int32_t i = 0; i < S->size.nq; i++) in->step.D[i] = h * (2.0 * from->mean[i] - from->mean_before[i]);
    memcpy(lam, from->lam, (size_t)S->size.nc * sizeof *lam);
    return false;
  }
  ali3_history_own(in, in->settings.method, from->qdd);
  const bool extrapolates = from_past && in->settings.predictor == ALI3_PREDICTOR_PARABOLA &&
                            ali3_history_smooth(in, ALI3_PARABOLA, h, request->controlled);
  ali3_history_predict(in, 0.5 * h, extrapolates ? ALI3_PARABOLA : 0, in->step.x, lam);
  const double *last = from->lam, *qd = from->qd, *x = in->step.x, half = 0.5 * h * h;
  double *D = in->step.D;
  ALI3_EACH(0, S->size.nc, ALI3_AT(lam) = ALI3_AT(last) + ALI3_MULTIPLIER_FRACTION * (ALI3_AT(lam) - ALI3_AT(last)))
  ALI3_EACH(0, S->size.nq, ALI3_AT(D) = h * ALI3_AT(qd) + half * ALI3_AT(x))
  return extrapolates;
}

ALI3_BY_PROCESSOR(in->system, bool, predict, (ali3_instance * in, const ali3_request *request, bool from_past),
                  (in, request, from_past))

void ali3_predict_accept(ali3_instance *in, double h) {
  if (in->system->n_flexible > 0) return;
  const double *D = in->step.D, *qd = in->now.qd, square = h * h;
  double *x = in->step.x;
  ALI3_EACH(0, in->system->size.nq, ALI3_AT(x) = 2.0 * (ALI3_AT(D) - h * ALI3_AT(qd)) / square)
  ali3_history_append(in, h, x);
}

void ali3_predict_rates(ali3_instance *in, double h) {
  if (in->system->n_flexible == 0) return;
  for (int32_t i = 0; i < in->system->size.nq; i++) {
    in->next.mean[i] = in->step.D[i] / h;
    in->next.mean_before[i] = in->now.mean[i];
  }
}
