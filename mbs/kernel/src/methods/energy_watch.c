/* The refusal of steps that do not resolve the motion, and the trend of an energy that should stay. */
#include <math.h>

#include "../instance.h"
#include "check_method.h"
#include "energy_balance.h"
#include "energy_watch.h"

/* Shares of the kinetic energy: of a step as asked for, and of a part of one that was halved. A part that cannot be
 * halved again may have what it might have if it had been asked for: else ten short steps pass where a long one does
 * not. */
static const double MOST = 0.1, MOST_OF_A_PART = 0.02;
static const double MOST_ENERGY = 1e100; /* J */

/* Whether this is a part of a step that was asked for, and may still be halved. */
static bool halves_left(const ali3_instance *in, const ali3_request *request) {
  return request->depth > 0 && request->depth < in->settings.max_halvings && in->settings.step_iterations == 0;
}

/* Adds an error of the energy to the balance and, where no row is driven, judges it beside `size`; so also with what the
 * forces left without balance, of power `open`, would do in a next step of this size. `end` is the kinetic energy at its
 * end, `weight` that of gravity as ali3_balance_energy takes it. */
ali3_status ali3_energy_judge(ali3_instance *in, const ali3_request *request, double error, double size, double end,
                              double open, const double *weight) {
  const double coming = fabs(error + 0.5 * request->h * (open - in->report.open_power)),
               worse = fmax(fabs(error), coming);
  if (!(size + worse < 1e300)) return ALI3_NOT_FINITE;
  const bool driven = in->system->n_gterm_row > 0; /* a guide whose rate jumps adds energy instantly */
  const bool resolved = driven || worse <= (halves_left(in, request) ? MOST_OF_A_PART : MOST) * size;
  if (!resolved && in->settings.step_iterations == 0) return ALI3_UNRESOLVED;
  in->bound.capped |= !resolved; /* no halves: the balance and the count say it */
  ali3_balance_energy(in, error, end, weight);
  in->report.open_power = open;
  return ALI3_OK;
}

ali3_status ali3_energy_watch(ali3_instance *in, const ali3_request *request, double error, double kinetic, double end,
                              double open) {
  return ali3_energy_judge(in, request, error, ali3_energy_size(in, request->h, kinetic), end, open, NULL);
}

/* At the start, and after a whole step whose energy is known, as it is where the method has a balance, or whose state is
 * read: the straight line through the energies. */
void ali3_energy_trend(ali3_instance *in, bool balanced) {
  const ali3_system *S = in->system;
  ali3_report *r = &in->report;
  if (S->size.nu > 0 || S->size.ng > 0 || !ali3_conservative(in)) return;
  const double energy = balanced ? r->energy : ali3_energy(in);
  if (!(fabs(energy) < MOST_ENERGY)) return; /* whose squares are no numbers */
  if (r->free_states == 0) {
    r->free_steps = r->free_energy = r->free_steps_squares = r->free_energy_squares = r->free_product = 0.0;
    r->free_start = energy;
  }
  const double n = (double)++r->free_states, steps = (double)r->steps - r->free_steps, off = energy - r->free_energy;
  r->free_steps += steps / n;
  r->free_energy += off / n;
  r->free_steps_squares += steps * ((double)r->steps - r->free_steps);
  r->free_energy_squares += off * (energy - r->free_energy);
  r->free_product += steps * (energy - r->free_energy);
}
