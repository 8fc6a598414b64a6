/* Order four by symmetric composition (Suzuki 1990) of energy-momentum steps: a h, a h, (1 - 4 a) h, a h, a h with
 * a = 1 / (4 - 4^(1/3)). The third is backwards in time, so that no element may dissipate energy. */
#include "../instance.h"
#include "../method.h"
#include "../state/vectors.h"
#include "check_method.h"
#include "energy_momentum.h"
#include "steps.h"

enum { STAGES = 5 };
static const double OUTER = 0.41449077179437573714;

/* Restarts with the length of the last of the composed steps. */
static void before(ali3_instance *in, const ali3_request *request) {
  ali3_energy_momentum_restart(in, OUTER * request->h, request->controlled);
}

static ali3_status step(ali3_instance *in, const ali3_request *request) {
  const double t = request->t, h = request->h;
  const double fraction[STAGES] = {OUTER, OUTER, 1.0 - 4.0 * OUTER, OUTER, OUTER};
  int32_t iterations = 0, most_iterations = in->report.max_iterations;
  double end_time = -1.0; /* time after the end of the step, in steps */
  ali3_vectors_copy(in, &in->stored.whole, &in->now);
  for (int stage = 0; stage < STAGES; stage++) {
    end_time = stage == STAGES - 1 ? 0.0 : end_time + fraction[stage];
    const ali3_status status =
        ali3_energy_momentum(in, t + end_time * h, fraction[stage] * h, 1.0 + end_time - 0.5 * fraction[stage],
                             stage == STAGES - 1 && request->reading != ALI3_READ_NOTHING);
    if (status != ALI3_OK) {
      ali3_vectors_copy(in, &in->now, &in->stored.whole);
      return status;
    }
    iterations += in->report.last_iterations;
  }
  in->report.last_iterations = iterations;
  in->report.max_iterations = iterations > most_iterations ? iterations : most_iterations;
  ali3_vectors_swap(&in->next, &in->stored.whole);
  return ALI3_OK;
}

static ali3_status check_system(const ali3_instance *in) {
  const ali3_status status = ali3_needs_no_states(in);
  if (status != ALI3_OK) return status;
  return ali3_conservative(in) && in->system->n_lookup == 0 ? ALI3_OK : ALI3_WRONG_METHOD;
}

const ali3_method ali3_method_energy_momentum_4 = {.step = step,
                                                   .before = before,
                                                   .motion = ali3_energy_momentum_motion,
                                                   .has_driving_work = ali3_always,
                                                   .check_system = check_system,
                                                   .excludes =
                                                       ALI3_STATES_IN_WORDS ", no lookup-table bodies, and no damping",
                                                   .after_unobserved = ali3_energy_momentum_report,
                                                   .owner = ALI3_METHOD_ENERGY_MOMENTUM,
                                                   .round_off = ALI3_ROUND_OFF_INDEX_3};
