/* Warnings of a run after a step, each logged once: conditions under which its results are not those of the model. */
#include <math.h>
#include <stdio.h>

#include "slave.h"

static const double LARGE_RESIDUAL = 1e-3; /* m */
static const double QUARTER_TURN = 1.5707963267948966;

/* Warns of a violated energy balance. */
static slave_status watch_energy(slave *s, const ali3_report *report) {
  if (s->calls.energy_warned || report->balance != ALI3_BALANCE_WRONG) return SLAVE_OK;
  s->calls.energy_warned = 1;
  return slave_log(
      s, SLAVE_WARNING,
      "At %.6g s the energy balance is violated: the steps have added or lost %.3g J without a force, %.2g %% of the "
      "energy in the motion. The results are not reliable. Run again with a step_size below %g s. This is reported "
      "once.",
      ali3_time(s->fidelity.kernel), report->energy_error, 100.0 * ali3_energy_balance(report),
      s->value[s->step_reference]);
}

/* Warns of a closed loop that changed its assembly mode, of one that left it unless the second motion does so, too. */
static slave_status watch_modes(slave *s, const ali3_report *report) {
  char text[SLAVE_TEXT / 2];
  if (s->calls.mode_warned || report->branch_changes == 0) return SLAVE_OK;
  if (report->branch_kind == ALI3_BRANCH_LEFT && slave_half_steps_may_follow(s, report->branch_time)) return SLAVE_OK;
  if (ali3_branch_text(s->fidelity.kernel, text, sizeof text) != ALI3_OK) return SLAVE_OK;
  s->calls.mode_warned = 1;
  return slave_log(s, SLAVE_WARNING, "%s This is reported once.", text);
}

/* Warns of the first step that ended at the limit of its iterations, and of the first with a large residual, as the
 * first is often harmless. */
static slave_status watch_limit(slave *s, const ali3_report *report) {
  const double residual = s->calls.capped_residual;
  const int level = report->capped == 0         ? SLAVE_NOT_CAPPED
                    : residual > LARGE_RESIDUAL ? SLAVE_CAPPED_BADLY
                                                : SLAVE_CAPPED;
  if (level <= s->calls.capped_warned) return SLAVE_OK;
  s->calls.capped_warned = level;
  char effect[SLAVE_TEXT / 4] = "the balance of energy or an abrupt force is not resolved";
  if (residual > 0.0) snprintf(effect, sizeof effect, "positions are off by about %.2g mm", 1e3 * residual);
  return slave_log(s, SLAVE_WARNING,
                   "Up to %.6g s %lld of %lld steps ended at the limit of their iterations, solver.step_iterations = "
                   "%g; after this one %s. If that is too much, raise the limit or take a step_size below %g s. %s",
                   ali3_time(s->fidelity.kernel), (long long)report->capped, (long long)report->steps,
                   s->value[s->iterations_reference], effect, s->value[s->step_reference],
                   level == SLAVE_CAPPED ? "This is reported again only where it is more than 1 mm."
                                         : "This is reported once.");
}

/* Warns of a wheel that hit a wall or fell deep into the ground: the step converges, so that there is no other
 * message. Wheels of a vehicle that has rolled over fall in any direction, which was said. */
static slave_status watch_rims(slave *s, const ali3_report *report) {
  const slave_table *t = &slave_the_table;
  char text[SLAVE_TEXT / 2];
  int32_t element = -1;
  if (s->rim_warned || s->overturned_warned || !(report->rim_pressed > 0.0)) return SLAVE_OK;
  if (ali3_rim_text(s->fidelity.kernel, &element, text, sizeof text) != ALI3_OK || element < 0) return SLAVE_OK;
  s->rim_warned = true;
  return slave_log(s, SLAVE_WARNING, "%s It is the wheel of '%.64s'. This is reported once.", text,
                   t->element[t->first_element[s->fidelity.number] + (size_t)element]);
}

/* The worse of two statuses. */
static slave_status worse(slave_status a, slave_status b) { return a > b ? a : b; }

slave_status slave_watch(slave *s) {
  ali3_report report;
  if (ali3_report_get(s->fidelity.kernel, &report) != ALI3_OK) return SLAVE_OK;
  const slave_status modes = watch_modes(s, &report), energy = watch_energy(s, &report);
  const slave_status rims = watch_rims(s, &report), limits = watch_limit(s, &report);
  return worse(worse(modes, energy), worse(rims, limits));
}

void slave_watch_outputs(slave *s) {
  const slave_table *t = &slave_the_table;
  if (s->overturned_warned || t->roll >= t->n_variables ||
      !(fabs(s->value[t->roll] / t->variable[t->roll].scale) > QUARTER_TURN))
    return;
  s->overturned_warned = true;
  const char *follows =
      t->ground < t->n_variables
          ? "What follows is a vehicle that slides on its body, as far as points of it touch the ground."
          : "What follows is wrong: no point of its body touches the ground, so it sinks in as far as "
            "its wheels let it. A car file gives such points as chassis.ground_contact.";
  slave_log(s, SLAVE_WARNING,
            "At %.6g s the vehicle has rolled over: %s is %.4g%s, more than a quarter turn. %s This is reported once.",
            ali3_time(s->fidelity.kernel), t->variable[t->roll].name, s->value[t->roll], t->variable[t->roll].unit,
            follows);
}

void slave_watch_start(slave *s) {
  const slave_table *t = &slave_the_table;
  for (size_t k = t->first_notice[s->fidelity.number]; k < t->first_notice[s->fidelity.number + 1]; k++)
    slave_log(s, SLAVE_WARNING, "%s", t->notice[k]);
  if (t->ground >= t->n_variables || ali3_sensors(s->fidelity.kernel, s->sensors) != ALI3_OK) return;
  const slave_variable *v = &t->variable[t->ground];
  const double ground_force = s->sensors[v->index]; /* under a name of another program its sign may differ */
  if (ground_force > ali3_no_force(s->fidelity.kernel))
    slave_log(s, SLAVE_WARNING,
              "At the start the vehicle rests on its body: %s is %.4g%s, which its wheels do not bear. Set masses, "
              "springs and tyres, or the place on the road, so that it is 0.",
              v->name, v->scale * ground_force, v->unit);
}
