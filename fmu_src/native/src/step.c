/* A communication step: equal inner steps, inputs along their derivatives, all or nothing. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "slave.h"

static const double TIME_TOLERANCE = 1e-6; /* s: a host adds up its time in floating point */
static const double STEP_TOLERANCE = 1e-6; /* end points this near, in steps, are reached with the tuned step itself */
static const double STEP_DEVIATION = 0.05;
static const double CLOCK_TOLERANCE = 1e-3; /* neighbouring times are not farther apart than this share of a step */
static const double LOOKS = 10.0; /* a second: at outputs that no host reads, for what they tell */

/* Once of shorter inner steps, which are no worse, and once of longer ones. */
static void say_step(slave *s, double whole, double h, double step) {
  const int32_t said = h > step ? SLAVE_LONGER_STEPS : SLAVE_SHORTER_STEPS;
  if (said <= s->calls.step_warned) return;
  s->calls.step_warned = said;
  if (said == SLAVE_SHORTER_STEPS)
    slave_say(s, SLAVE_WARNING,
              "The communication step %.6g s gives inner steps of %.6g s, while step_size is %.6g s; results will "
              "differ a little. This is reported once.",
              whole, h, step);
  else
    slave_say(s, SLAVE_WARNING,
              "The communication step %.6g s gives inner steps of %.6g s, while step_size is %.6g s; their errors are "
              "%.2g times as large. A step_size of %.6g s or less has shorter ones. This is reported once.",
              whole, h, step, (h / step) * (h / step), whole / ceil(whole / step));
}

/* Number and size of the equal inner steps from time to end; halves go up, whatever the round-off of the host's times. */
static int64_t division(slave *s, double time, double end, double *h) {
  const double step = s->value[s->step_reference], ratio = floor((end - time) / step + 0.5 + STEP_TOLERANCE);
  const double n = ratio > 1.0 ? ratio : 1.0;
  *h = step;
  if (fabs(time + n * step - end) <= STEP_TOLERANCE * step) return (int64_t)n;
  *h = (end - time) / n;
  if (fabs(*h - step) > STEP_DEVIATION * step) say_step(s, end - time, *h, step);
  return (int64_t)n;
}

static bool any_slope(const slave *s) {
  for (size_t i = 0; i < slave_the_table.n_known * SLAVE_TERMS; i++)
    if (s->slope[i] != 0.0) return true;
  return false;
}

static ali3_status apply_pending(slave *s) {
  const slave_table *t = &slave_the_table;
  ali3_status status = ALI3_OK;
  for (size_t i = 0; i < t->n_known && status == ALI3_OK; i++) {
    const slave_variable *v = &t->variable[i];
    if (!s->pending[i]) continue;
    if (v->source == SLAVE_INPUT) {
      double begin = s->value[i] / v->scale;
      if (s->slope[i * SLAVE_TERMS] != 0.0) slave_add_slope(s->slope, i, 0.0, &begin);
      status = ali3_set_input(s->fidelity.kernel, v->index, begin);
    } else {
      status = ali3_set_parameter(s->fidelity.kernel, v->index, s->value[i]);
    }
  }
  return status;
}

/* *left: the largest residual of an inner step that ended at the limit of its iterations. */
static ali3_status advance(slave *s, int64_t *whole, double h, double *left) {
  const int64_t n = *whole;
  ali3_instance *kernel = s->fidelity.kernel;
  ali3_status status = apply_pending(s);
  *left = 0.0;
  if (status != ALI3_OK) return status;
  if (s->ask != NULL || s->early) return slave_asked_steps(s, whole, h, left);
  if (!any_slope(s)) {
    status = n == 1 ? ali3_step(kernel, h) : ali3_run(kernel, h, n, NULL, 1, NULL, NULL, NULL);
    *left = ali3_capped_residual(kernel);
    return status;
  }
  for (int64_t k = 0; k < n && status == ALI3_OK; k++) {
    slave_inputs_at(s, (double)(k + 1) * h, s->direction);
    status = ali3_run(kernel, h, 1, s->direction, 1, NULL, NULL, NULL);
    *left = fmax(*left, ali3_capped_residual(kernel));
  }
  return status;
}

/* What a derivative of this communication step begins with. */
static void keep_start(slave *s, int64_t n, double h) {
  slave_fidelity *f = &s->fidelity;
  void *const spare = f->start;
  f->start = f->snapshot;
  f->snapshot = spare;
  s->made.n = n;
  s->made.h = h;
  s->made.sloped = any_slope(s) || s->asked.n > 0;
  if (s->made.sloped) memcpy(s->made_slope, s->slope, slave_the_table.n_known * SLAVE_TERMS * sizeof(double));
}

/* After a step with slopes the inputs are again what the host set them to. */
static void forget_slopes(slave *s) {
  const slave_table *t = &slave_the_table;
  if (!s->made.sloped) return;
  memset(s->slope, 0, t->n_known * SLAVE_TERMS * sizeof(double));
  for (size_t i = 0; i < t->n_known; i++)
    if (t->variable[i].source == SLAVE_INPUT)
      ali3_set_input(s->fidelity.kernel, t->variable[i].index, s->value[i] / t->variable[i].scale);
}

/* Whether a step can be asked for here at all; said if not. */
static bool possible(slave *s, double time, double step, double now) {
  if (!(fabs(time) < HUGE_VAL && step > 0.0 && step < HUGE_VAL))
    slave_say(s, SLAVE_ERROR, "A step from %g s over %g s: a finite time and a positive step are needed.", time, step);
  else if (fabs(time - now) > TIME_TOLERANCE)
    slave_say(s, SLAVE_ERROR, "The step starts at %.10g s, but this instance stands at %.10g s.", time, now);
  else if (time + step > s->calls.stop_time + TIME_TOLERANCE)
    slave_say(s, SLAVE_ERROR, "The step from %g s over %g s goes beyond the stop time %g s.", time, step,
              s->calls.stop_time);
  else if (step / s->value[s->step_reference] > slave_steps_left(s))
    slave_say(
        s, SLAVE_ERROR,
        "The step of %g s has more than %g inner steps of %g s, and a step that has begun cannot be cancelled; take "
        "shorter communication steps.",
        step, slave_steps_left(s), s->value[s->step_reference]);
  else if (!(time + step > time) || fabs(time) * DBL_EPSILON > CLOCK_TOLERANCE * s->value[s->step_reference])
    slave_say(
        s, SLAVE_ERROR,
        "At %g s neighbouring floating-point times are %.2g s apart, too far for a step of %g s with inner steps of %g "
        "s; begin nearer to zero.",
        time, fabs(time) * DBL_EPSILON, step, s->value[s->step_reference]);
  else
    return true;
  return false;
}

static slave_status try_step(slave *s, double time, double step) {
  char worst[SLAVE_TEXT / 2];
  const double now = ali3_time(s->fidelity.kernel);
  double h, left;
  if (!possible(s, time, step, now)) return SLAVE_ERROR;
  slave_hold_normals(s);
  slave_begin_ramps(s, step);
  const slave_variable *const jumped = slave_watch_jumps(s);
  int64_t n = division(s, now, time + step, &h);
  const bool replaced = s->asked.n > 0; /* what was given in the last step makes room for this one */
  s->asked.n = 0;
  ali3_snapshot_take(s->fidelity.kernel,
                     s->fidelity.snapshot); /* inputs, parameters and inner steps go back together */
  const ali3_status status = advance(s, &n, h, &left);
  if (status != ALI3_OK) {
    worst[0] = 0;
    if (ali3_status_cause(status) == ALI3_CAUSE_EQUATIONS) slave_worst_row(s, worst, sizeof worst);
    if (status == ALI3_ROAD_LOST) snprintf(worst, sizeof worst, " Of the road %s.", ali3_road_lost(s->fidelity.kernel));
    if (status == ALI3_BEYOND_TABLE) slave_beyond_table(s, worst, sizeof worst);
    if (status == ALI3_BAD_NORMAL) slave_bad_normal(s, worst, sizeof worst);
    if (status == ALI3_WHEEL_IN_ROAD) {
      char words[SLAVE_TEXT / 2 - 16];
      ali3_wheel_in_road(s->fidelity.kernel, NULL, words, sizeof words);
      snprintf(worst, sizeof worst, " Here %s.", words);
    }
    ali3_snapshot_restore(s->fidelity.kernel, s->fidelity.snapshot);
    if (replaced) s->made = (slave_made){0};
    slave_end_ramps(s);
    return slave_refuse_step(s, status, now, step, worst, jumped);
  }
  keep_start(s, n, h);
  const slave_status halved = slave_halve_steps(s);
  slave_asked_taken(s);
  forget_slopes(s);
  slave_watch_ports(s, now);
  memset(s->pending, 0, slave_the_table.n_known);
  s->outputs = SLAVE_STALE;
  s->calls.phase = SLAVE_STEPPING;
  s->calls.capped_residual = left;
  slave_forget_refusal(s);
  const slave_status watched = slave_watch(s);
  if (floor(LOOKS * ali3_time(s->fidelity.kernel)) != floor(LOOKS * now) && slave_outputs(s)) slave_half_steps_look(s);
  return halved > watched ? halved : watched;
}

slave_status slave_step(slave *s, double time, double step) {
  s->returned_early = false;
  s->last_step = try_step(s, time, step);
  return s->last_step;
}
