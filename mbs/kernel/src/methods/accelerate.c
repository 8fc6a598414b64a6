/* Anderson mixing of depth one for Newton iterations that converge only linearly: element tangents leave out their
 * unsymmetric part (friction depends on the load), which costs a factor per iteration and mostly along one
 * direction. The last two corrections show that direction. Where Newton converges quadratically the corrections
 * shrink faster than SLOW and nothing is mixed. */
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../algebra/real.h"
#include "../instance.h"
#include "newton.h"

static const double SLOW = 0.05; /* ratio of two corrections from which on convergence counts as linear */
static const double LEAST = -100.0, MOST = 0.5; /* bounds of a mixing factor; -6 is a factor of 6/7 per iteration */

/* in->step.x and in->step.lam hold the correction of D and of the multipliers; they become the step to take. `mixes`:
 * where the correction before this one shows it. */
ALI3_INLINED void accelerate(ali3_instance *in, truth mixes) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  real present = {0}, last = {0}, change = {0}, along = {0}, theta = {0};
  if (ali3_any(mixes)) {
    for (int32_t i = 0; i < nq; i++) {
      const real m = in->mass.floor[i], difference = in->step.x[i] - in->mixing.correction_q[i];
      present += m * in->step.x[i] * in->step.x[i];
      last += m * in->mixing.correction_q[i] * in->mixing.correction_q[i];
      change += m * difference * difference;
      along += m * in->step.x[i] * difference;
    }
    const truth slow = mixes & (present > SLOW * SLOW * last) & (change > 0.0);
    theta = ali3_where(slow, along / change, theta);
    theta = ali3_where((theta >= LEAST) & (theta <= MOST), theta, ali3_same(0.0));
  }
  const truth mixed = theta != 0.0;
  if (!ali3_any(mixed)) {
    ali3_copy(in->mixing.correction_q, in->step.x, nq);
    ali3_copy(in->mixing.step_q, in->step.x, nq);
    ali3_copy(in->mixing.correction_lam, in->step.lam, nc);
    ali3_copy(in->mixing.step_lam, in->step.lam, nc);
    return;
  }
  for (int32_t i = 0; i < nq; i++) {
    const real correction = in->step.x[i];
    const real other = correction - theta * (in->mixing.step_q[i] + correction - in->mixing.correction_q[i]);
    in->step.x[i] = ali3_where(mixed, other, correction);
    in->mixing.correction_q[i] = correction;
    in->mixing.step_q[i] = in->step.x[i];
  }
  for (int32_t k = 0; k < nc; k++) {
    const real correction = in->step.lam[k];
    const real other = correction - theta * (in->mixing.step_lam[k] + correction - in->mixing.correction_lam[k]);
    in->step.lam[k] = ali3_where(mixed, other, correction);
    in->mixing.correction_lam[k] = correction;
    in->mixing.step_lam[k] = in->step.lam[k];
  }
}

ALI3_BY_PROCESSOR(in->system, void, accelerate, (ali3_instance * in, truth mixes), (in, mixes))
