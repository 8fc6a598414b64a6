/* Order four by symmetric composition (Suzuki 1990) of energy-momentum steps: a h, a h, (1 - 4 a) h, a h, a h with
 * a = 1 / (4 - 4^(1/3)). The third goes backwards in time, so nothing may dissipate. */
#include "../instance.h"
#include "../state/vectors.h"
#include "energy_momentum.h"
#include "steps.h"

enum { STAGES = 5 };
static const double OUTER = 0.41449077179437573714;

/* The last of the steps that a step of h is composed of. */
double ali3_composed(double h) { return OUTER * h; }

ali3_status ali3_composition(ali3_instance *in, double t, double h) {
  const double share[STAGES] = {OUTER, OUTER, 1.0 - 4.0 * OUTER, OUTER, OUTER};
  int32_t iterations = 0, most = in->report.max_iterations;
  double done = -1.0; /* time from the end of the step, in steps */
  ali3_vectors_copy(in, &in->whole, &in->now);
  for (int stage = 0; stage < STAGES; stage++) {
    done = stage == STAGES - 1 ? 0.0 : done + share[stage];
    const ali3_status status = ali3_energy_momentum(in, t + done * h, share[stage] * h, 1.0 + done - 0.5 * share[stage],
                                                    stage == STAGES - 1 && !in->quiet);
    if (status != ALI3_OK) {
      ali3_vectors_copy(in, &in->now, &in->whole);
      return status;
    }
    iterations += in->report.last_iterations;
  }
  in->report.last_iterations = iterations;
  in->report.max_iterations = iterations > most ? iterations : most;
  return ALI3_OK;
}
