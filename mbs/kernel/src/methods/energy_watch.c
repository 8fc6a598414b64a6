/* Refusal of steps with large energy errors, and the trend of an energy that should be constant. */
#include <math.h>

#include "../instance.h"
#include "check_method.h"
#include "energy_balance.h"
#include "energy_watch.h"

/* Largest energy errors relative to the kinetic energy: of a requested step, and of a part that can be halved again. A
 * part that cannot has the limit of a requested step, as otherwise a series of short steps would pass where a long one
 * fails. */
static const double MAX_RATIO = 0.1, MAX_RATIO_OF_PART = 0.02;
static const double MAX_ENERGY = 1e100; /* J */

/* Whether this is a part of a requested step that can be halved again. */
static bool halves_left(const ali3_instance *in, const ali3_request *request) {
  return request->depth > 0 && request->depth < in->settings.max_halvings && in->settings.step_iterations == 0;
}

ali3_status ali3_energy_judge(ali3_instance *in, const ali3_request *request, double error, double size, double end,
                              double open, const double *weight) {
  const double predicted = fabs(error + 0.5 * request->h * (open - in->report.open_power)),
               worse = fmax(fabs(error), predicted);
  if (!(size + worse < 1e300)) return ALI3_NOT_FINITE;
  const bool driven = in->system->n_gterm_row > 0; /* a jump of the rate of a driving function adds energy */
  const bool resolved = driven || worse <= (halves_left(in, request) ? MAX_RATIO_OF_PART : MAX_RATIO) * size;
  if (!resolved && in->settings.step_iterations == 0) return ALI3_UNRESOLVED;
  in->bound.capped |= !resolved; /* not halved: the balance and the count of capped steps report it */
  ali3_balance_energy(in, error, end, weight);
  in->report.open_power = open;
  return ALI3_OK;
}

ali3_status ali3_energy_watch(ali3_instance *in, const ali3_request *request, double error, double kinetic, double end,
                              double open) {
  return ali3_energy_judge(in, request, error, ali3_energy_size(in, request->h, kinetic), end, open, NULL);
}

/* Updates the linear trend of the energy over the steps: at the start, after steps with a balance, and after steps
 * whose state is read. */
void ali3_energy_trend(ali3_instance *in, bool balanced) {
  const ali3_system *S = in->system;
  ali3_report *r = &in->report;
  if (S->size.nu > 0 || S->size.ng > 0 || !ali3_conservative(in)) return;
  const double energy = balanced ? r->energy : ali3_energy(in);
  if (!(fabs(energy) < MAX_ENERGY)) return; /* its square overflows */
  if (r->free_states == 0) {
    r->free_steps = r->free_energy = r->free_steps_squares = r->free_energy_squares = r->free_product = 0.0;
    r->free_start = energy;
  }
  const double n = (double)++r->free_states, steps = (double)r->steps - r->free_steps,
               deviation = energy - r->free_energy;
  r->free_steps += steps / n;
  r->free_energy += deviation / n;
  r->free_steps_squares += steps * ((double)r->steps - r->free_steps);
  r->free_energy_squares += deviation * (energy - r->free_energy);
  r->free_product += steps * (energy - r->free_energy);
}
