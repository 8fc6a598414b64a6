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

/* Writes the prediction of a step h, s; returns the lanes whose past steps were used. `from_past` false: none;
 * `controlled`: as in a request. */
ALI3_INLINED lane_mask predict(ali3_instance *in, double h, bool from_past, bool controlled) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  const real *qd = in->now.qd, *qdd = in->now.qdd, *last = in->now.lam;
  real *D = in->step.D, *x = in->step.x, *lam = in->next.lam;
  lane_mask extrapolates = {0};
  if (S->n_flexible > 0) {
    for (int32_t i = 0; i < nq; i++) D[i] = h * (2.0 * in->now.mean[i] - in->now.mean_before[i]);
    memcpy(lam, last, (size_t)nc * sizeof *lam);
    return extrapolates;
  }
  if (from_past && in->settings.predictor == ALI3_PREDICTOR_PARABOLA)
    extrapolates = ali3_history_smooth(in, ALI3_PARABOLA, h, controlled);
  if (ali3_any(extrapolates)) ali3_extrapolate(in, 0.5 * h, ALI3_PARABOLA, x, lam);
  if (ali3_any(ali3_not(extrapolates))) {
    ALI3_EACH(0, nq, ALI3_AT(x) = ali3_where(extrapolates, ALI3_AT(x), ALI3_AT(qdd)))
    ALI3_EACH(0, nc, ALI3_AT(lam) = ali3_where(extrapolates, ALI3_AT(lam), ALI3_AT(last)))
  }
  const double half = 0.5 * h * h;
  ALI3_EACH(0, nc, ALI3_AT(lam) = ALI3_AT(last) + ALI3_MULTIPLIER_FRACTION * (ALI3_AT(lam) - ALI3_AT(last)))
  ALI3_EACH(0, nq, ALI3_AT(D) = h * ALI3_AT(qd) + half * ALI3_AT(x))
  return extrapolates;
}

#ifndef ALI3_WIDTH
/* Writes the prediction with its own history; returns whether past steps were used. */
ALI3_INLINED bool predict_step(ali3_instance *in, const ali3_request *request, bool from_past) {
  if (in->system->n_flexible == 0) ali3_history_own(in, in->settings.method, in->now.qdd);
  return predict(in, request->h, from_past, request->controlled);
}

ALI3_BY_PROCESSOR(in->system, bool, predict_step, (ali3_instance * in, const ali3_request *request, bool from_past),
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
#endif
