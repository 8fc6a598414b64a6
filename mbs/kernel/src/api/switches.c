/* Rows that are switched on and off at run time: a joint that closes or opens without a new System. A row that is off
 * is zero; one that is switched on holds its value at that time (its anchor). */
#include <math.h>
#include <string.h>

#include "../instance.h"
#include "../method.h"
#include "../methods/energy_balance.h"
#include "../rows/constraints.h"
#include "../start/initialise.h"
#include "../state/vectors.h"

/* Switches rows on or off; after the start rows hold their present values. */
static void set_switch(ali3_instance *in, int32_t number, bool on) {
  const ali3_system *S = in->system;
  in->now.on[number] = 1.0;
  for (int32_t k = 0; k < S->size.nc; k++)
    if (S->row_switch[k] == number) in->now.anchor[k] = 0.0;
  if (!on) {
    in->now.on[number] = 0.0;
    return;
  }
  if (!in->start.initialised) return; /* at the start rows hold the values of the model */
  ali3_constraints(in, in->now.q, in->now.s, in->step.Phi, in->tangent.J);
  for (int32_t k = 0; k < S->size.nc; k++)
    if (S->row_switch[k] == number) in->now.anchor[k] = in->step.Phi[k];
}

/* Projects velocities in the metric of the mass (an impact without rebound) and computes accelerations and multipliers
 * again; the energy of the impact is in report.energy_jump. */
ali3_status ali3_set_switch(ali3_instance *in, int32_t number, int32_t on) {
  if (in == NULL || number < 0 || number >= in->system->size.n_switch || (on != 0 && on != 1)) return ALI3_BAD_ARGUMENT;
  if ((in->now.on[number] != 0.0) == (on == 1)) return ALI3_OK;
  if (!in->start.initialised) {
    set_switch(in, number, on == 1);
    return ALI3_OK;
  }
  ali3_vectors_copy(in, &in->stored.start, &in->now);
  const double before = ali3_kinetic_energy(in);
  set_switch(in, number, on == 1);
  const ali3_status status = ali3_solve_rates(in, false);
  in->report.last_status = (int32_t)status;
  if (status != ALI3_OK) {
    ali3_vectors_copy(in, &in->now, &in->stored.start);
    in->report.failures++;
    return status;
  }
  in->report.energy_jump = ali3_kinetic_energy(in) - before;
  in->report.free_states = 0;
  memset(in->now.history, 0, ALI3_HISTORY * sizeof(double));
  ali3_balance_start(in, ali3_has_balance(in));
  return ALI3_OK;
}

ali3_status ali3_get_switch(const ali3_instance *in, int32_t number, int32_t *on) {
  if (in == NULL || on == NULL || number < 0 || number >= in->system->size.n_switch) return ALI3_BAD_ARGUMENT;
  *on = in->now.on[number] != 0.0;
  return ALI3_OK;
}
