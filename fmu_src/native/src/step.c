/* A communication step: equal inner steps, inputs along their derivatives; if one inner step fails, the state before
 * the communication step is restored. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "slave.h"

static const double TIME_TOLERANCE = 1e-6; /* s: hosts add up times in floating point */
static const double STEP_TOLERANCE = 1e-6; /* in inner steps: an end this near is reached with step_size itself, or,
                                              where it is the start, without a step */
static const double STEP_DEVIATION = 0.05;
static const double CLOCK_TOLERANCE = 1e-3; /* largest distance of neighbouring floating-point times, in inner steps */
static const double OBSERVATIONS =
    10.0; /* per second: evaluations of outputs for run warnings and ranges, whether read or not */

/* Warns once of shorter inner steps, which are at least as accurate, and once of longer ones. */
static void warn_step_size(slave *s, double n_inner, double h, double step) {
  const int32_t warning = h > step ? SLAVE_LONGER_STEPS : SLAVE_SHORTER_STEPS;
  if (warning <= s->calls.step_warned) return;
  s->calls.step_warned = warning;
  if (warning == SLAVE_SHORTER_STEPS)
    slave_log(s, SLAVE_WARNING,
              "The communication step %.6g s gives inner steps of %.6g s, while step_size is %.6g s; results will "
              "differ a little. This is reported once.",
              n_inner, h, step);
  else
    slave_log(s, SLAVE_WARNING,
              "The communication step %.6g s gives inner steps of %.6g s, while step_size is %.6g s; their errors are "
              "%.2g times as large. A step_size of %.6g s or less has shorter ones. This is reported once.",
              n_inner, h, step, (h / step) * (h / step), n_inner / ceil(n_inner / step));
}

/* Number and length *h, s, of the equal inner steps from `time` to `end`; halves are rounded up, whatever the round-off
 * of the host's times. */
static int64_t divide_step(slave *s, double time, double end, double *h) {
  const double step = s->value[s->step_reference], ratio = floor((end - time) / step + 0.5 + STEP_TOLERANCE);
  const double n = ratio > 1.0 ? ratio : 1.0;
  *h = step;
  if (fabs(time + n * step - end) <= STEP_TOLERANCE * step) return (int64_t)n;
  *h = (end - time) / n;
  if (fabs(*h - step) > STEP_DEVIATION * step) warn_step_size(s, end - time, *h, step);
  return (int64_t)n;
}

/* Whether an input has a derivative other than zero. */
static bool has_slopes(const slave *s) {
  for (size_t i = 0; i < slave_the_table.n_known * SLAVE_TERMS; i++)
    if (s->slope[i] != 0.0) return true;
  return false;
}

/* Passes the values set since the last step to the kernel. */
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

/* Makes the inner steps; *n_inner becomes their number after an early return. *largest_residual: m, of inner steps that
 * ended at the limit of their iterations. */
static ali3_status advance(slave *s, int64_t *n_inner, double h, double *largest_residual) {
  const int64_t n = *n_inner;
  ali3_instance *kernel = s->fidelity.kernel;
  ali3_status status = apply_pending(s);
  *largest_residual = 0.0;
  if (status != ALI3_OK) return status;
  if (s->request_inputs != NULL || s->early_return) return slave_intermediate_steps(s, n_inner, h, largest_residual);
  if (!has_slopes(s)) {
    status = n == 1 ? ali3_step(kernel, h) : ali3_run(kernel, h, n, NULL, 1, NULL, NULL, NULL);
    *largest_residual = ali3_capped_residual(kernel);
    return status;
  }
  for (int64_t k = 0; k < n && status == ALI3_OK; k++) {
    slave_inputs_at(s, (double)(k + 1) * h, s->direction);
    status = ali3_run(kernel, h, 1, s->direction, 1, NULL, NULL, NULL);
    *largest_residual = fmax(*largest_residual, ali3_capped_residual(kernel));
  }
  return status;
}

/* Stores the start and the division of the step, for its derivatives. */
static void store_completed(slave *s, int64_t n, double h) {
  slave_fidelity *f = &s->fidelity;
  void *const swapped = f->start;
  f->start = f->snapshot;
  f->snapshot = swapped;
  s->completed.n = n;
  s->completed.h = h;
  s->completed.sloped = has_slopes(s) || s->intermediate.n > 0;
  if (s->completed.sloped) memcpy(s->completed_slope, s->slope, slave_the_table.n_known * SLAVE_TERMS * sizeof(double));
}

/* Clears the slopes after a step; inputs are again the values that the host set. */
static void forget_slopes(slave *s) {
  const slave_table *t = &slave_the_table;
  if (!s->completed.sloped) return;
  memset(s->slope, 0, t->n_known * SLAVE_TERMS * sizeof(double));
  for (size_t i = 0; i < t->n_known; i++)
    if (t->variable[i].source == SLAVE_INPUT)
      ali3_set_input(s->fidelity.kernel, t->variable[i].index, s->value[i] / t->variable[i].scale);
}

/* Whether the times of a step are valid; if not, an error is logged. */
static bool check_step(slave *s, double time, double step, double now) {
  if (!(fabs(time) < HUGE_VAL && step > 0.0 && step < HUGE_VAL))
    slave_log(s, SLAVE_ERROR, "A step from %g s over %g s: a finite time and a positive step are needed.", time, step);
  else if (fabs(time - now) > TIME_TOLERANCE)
    slave_log(s, SLAVE_ERROR, "The step starts at %.10g s, but the time of this instance is %.10g s.", time, now);
  else if (time + step > s->calls.stop_time + TIME_TOLERANCE)
    slave_log(s, SLAVE_ERROR, "The step from %g s over %g s goes beyond the stop time %g s.", time, step,
              s->calls.stop_time);
  else if (step / s->value[s->step_reference] > slave_steps_left(s))
    slave_log(
        s, SLAVE_ERROR,
        "The step of %g s has more than %g inner steps of %g s, and a step that has begun cannot be cancelled; take "
        "shorter communication steps.",
        step, slave_steps_left(s), s->value[s->step_reference]);
  else if (fabs(time) * DBL_EPSILON > CLOCK_TOLERANCE * s->value[s->step_reference])
    slave_log(
        s, SLAVE_ERROR,
        "At %g s neighbouring floating-point times are %.2g s apart, too far for a step of %g s with inner steps of %g "
        "s; begin nearer to zero.",
        time, fabs(time) * DBL_EPSILON, step, s->value[s->step_reference]);
  else
    return true;
  return false;
}

/* Ends a step that is round-off of the host's times. In so short a one the round-off of positions would be taken for
 * motion; values that were set wait for the next step, without their derivatives. */
static slave_status stand_still(slave *s) {
  memset(s->slope, 0, slave_the_table.n_known * SLAVE_TERMS * sizeof(double));
  s->calls.phase = SLAVE_STEPPING;
  return SLAVE_OK;
}

/* Makes a communication step from `time`, s; if it fails the state before it is restored. */
static slave_status try_step(slave *s, double time, double step) {
  char details[SLAVE_TEXT / 2];
  const double now = ali3_time(s->fidelity.kernel);
  double h, largest_residual;
  if (!check_step(s, time, step, now)) return SLAVE_ERROR;
  if (time + step - now <= STEP_TOLERANCE * s->value[s->step_reference]) return stand_still(s);
  slave_hold_normals(s);
  slave_begin_ramps(s, step);
  const slave_variable *const largest_jump = slave_watch_jumps(s);
  int64_t n = divide_step(s, now, time + step, &h);
  const bool intermediate_replaced = s->intermediate.n > 0; /* intermediate inputs of the last step are overwritten */
  s->intermediate.n = 0;
  ali3_snapshot_take(s->fidelity.kernel, s->fidelity.snapshot); /* a failed step also undoes inputs and parameters */
  const ali3_status status = advance(s, &n, h, &largest_residual);
  if (status != ALI3_OK) {
    details[0] = 0;
    if (ali3_status_cause(status) == ALI3_CAUSE_EQUATIONS) slave_worst_row_text(s, details, sizeof details);
    if (status == ALI3_ROAD_LOST)
      snprintf(details, sizeof details, " Of the road %s.", ali3_road_lost(s->fidelity.kernel));
    if (status == ALI3_BEYOND_TABLE) slave_beyond_table_text(s, details, sizeof details);
    if (status == ALI3_BAD_NORMAL) slave_bad_normal_text(s, details, sizeof details);
    if (status == ALI3_WHEEL_IN_ROAD) {
      char reason[SLAVE_TEXT / 2 - 16];
      ali3_wheel_in_road(s->fidelity.kernel, NULL, reason, sizeof reason);
      snprintf(details, sizeof details, " Here %s.", reason);
    }
    ali3_snapshot_restore(s->fidelity.kernel, s->fidelity.snapshot);
    if (intermediate_replaced) s->completed = (slave_completed){0};
    slave_end_ramps(s);
    return slave_refuse_step(s, status, now, step, details, largest_jump);
  }
  store_completed(s, n, h);
  const slave_status second_motion = slave_half_steps_advance(s);
  slave_intermediate_accept(s);
  forget_slopes(s);
  slave_watch_ports(s, now);
  memset(s->pending, 0, slave_the_table.n_known);
  s->outputs = SLAVE_STALE;
  s->calls.phase = SLAVE_STEPPING;
  s->calls.capped_residual = largest_residual;
  slave_forget_refusal(s);
  const slave_status warnings = slave_watch(s);
  if (floor(OBSERVATIONS * ali3_time(s->fidelity.kernel)) != floor(OBSERVATIONS * now) && slave_compute_outputs(s))
    slave_half_steps_observe(s);
  return second_motion > warnings ? second_motion : warnings;
}

slave_status slave_step(slave *s, double time, double step) {
  s->returned_early = false;
  s->last_step = try_step(s, time, step);
  return s->last_step;
}
