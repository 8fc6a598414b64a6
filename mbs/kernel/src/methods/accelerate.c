/* Anderson acceleration of depth one for Newton iterations with linear convergence: tangents of elements lack their
 * unsymmetric part (friction depends on the load), which slows convergence mostly in one direction, found from the last
 * two corrections. With quadratic convergence corrections decrease faster than LINEAR_RATIO and are not changed. */
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../algebra/real.h"
#include "../instance.h"
#include "newton.h"

static const double LINEAR_RATIO = 0.05; /* ratio of two corrections above which convergence is linear */
/* Bounds of the mixing factor; -6 belongs to a contraction by 6/7 per iteration. */
static const double MIN_FACTOR = -100.0, MAX_FACTOR = 0.5;

/* in->step.x and in->step.lam have the corrections of D and of the multipliers and become the accelerated ones.
 * `enabled`: lanes that have a correction before this one. */
ALI3_INLINED void accelerate(ali3_instance *in, lane_mask enabled) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  real present = {0}, last = {0}, change = {0}, projection = {0}, theta = {0};
  if (ali3_any(enabled)) {
    for (int32_t i = 0; i < nq; i++) {
      const real m = in->mass.floor[i], difference = in->step.x[i] - in->mixing.correction_q[i];
      present += m * in->step.x[i] * in->step.x[i];
      last += m * in->mixing.correction_q[i] * in->mixing.correction_q[i];
      change += m * difference * difference;
      projection += m * in->step.x[i] * difference;
    }
    const lane_mask slow = enabled & (present > LINEAR_RATIO * LINEAR_RATIO * last) & (change > 0.0);
    theta = ali3_where(slow, projection / change, theta);
    theta = ali3_where((theta >= MIN_FACTOR) & (theta <= MAX_FACTOR), theta, ali3_same(0.0));
  }
  const lane_mask mixed = theta != 0.0;
  if (!ali3_any(mixed)) {
    ali3_copy(in->mixing.correction_q, in->step.x, nq);
    ali3_copy(in->mixing.step_q, in->step.x, nq);
    ali3_copy(in->mixing.correction_lam, in->step.lam, nc);
    ali3_copy(in->mixing.step_lam, in->step.lam, nc);
    return;
  }
  for (int32_t i = 0; i < nq; i++) {
    const real correction = in->step.x[i];
    const real mixed_step = correction - theta * (in->mixing.step_q[i] + correction - in->mixing.correction_q[i]);
    in->step.x[i] = ali3_where(mixed, mixed_step, correction);
    in->mixing.correction_q[i] = correction;
    in->mixing.step_q[i] = in->step.x[i];
  }
  for (int32_t k = 0; k < nc; k++) {
    const real correction = in->step.lam[k];
    const real mixed_step = correction - theta * (in->mixing.step_lam[k] + correction - in->mixing.correction_lam[k]);
    in->step.lam[k] = ali3_where(mixed, mixed_step, correction);
    in->mixing.correction_lam[k] = correction;
    in->mixing.step_lam[k] = in->step.lam[k];
  }
}

ALI3_BY_PROCESSOR(in->system, void, accelerate, (ali3_instance * in, lane_mask enabled), (in, enabled))
