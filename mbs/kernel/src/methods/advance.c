/* A step by the method of the settings, in halves where it does not converge. */
#include "../instance.h"
#include "../method.h"
#include "../state/inputs.h"
#include "../state/road_files.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "energy_balance.h"
#include "steps.h"

static ali3_status by_method(ali3_instance *in, double t, double h) {
  const ali3_method *method = ali3_method_of(in);
  const ali3_status inputs = ali3_inputs_begin(in, t, h);
  if (inputs != ALI3_OK) return inputs;
  if (method->before != NULL) method->before(in, h);
  if (method->fills)
    ali3_vectors_copy_unwritten(in, &in->next, &in->now);
  else if (!method->relative)
    ali3_vectors_copy(in, &in->next, &in->now);
  const bool by_powers = in->system->n_guide_work > 0 && !(method->has_guides_work && method->has_guides_work(in));
  const double power = by_powers ? ali3_guides_power(in, &in->now) : 0.0;
  const ali3_status status = method->step(in, t, h);
  if (status == ALI3_OK && by_powers)
    ali3_guides_work(in, &in->now, 0.5 * h * (power + ali3_guides_power(in, &in->now)));
  return status;
}

enum { MOST_ITERATIONS = 1000 }; /* of a step with all its parts */

/* A step to time t, in halves where it does not converge. */
ali3_status ali3_advance(ali3_instance *in, double t, double h, int32_t depth) {
  const ali3_method *method = ali3_method_of(in);
  if (in->report.iterations - in->iterations_before > MOST_ITERATIONS) return ALI3_TOO_DEAR;
  in->halves_left = depth > 0 && depth < in->settings.max_halvings;
  const ali3_status status = by_method(in, t, h);
  if (status == ALI3_OK) in->t_now = t;
  if (status == ALI3_OK && method->motion != NULL) method->motion(in, h);
  if (status != ALI3_OK && ali3_roads_status(in) != ALI3_OK) return ALI3_ROAD_LOST;
  if (status == ALI3_OK || status == ALI3_BAD_ARGUMENT || status == ALI3_BAD_NORMAL || depth <= 0 ||
      in->settings.step_iterations > 0)
    return status;
  in->report.halvings++;
  ali3_back_up(in);
  const ali3_status first = ali3_advance(in, t - 0.5 * h, 0.5 * h, depth - 1);
  return first == ALI3_OK ? ali3_advance(in, t, 0.5 * h, depth - 1) : first;
}
