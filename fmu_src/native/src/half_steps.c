/* Error estimate by a second motion. After an abrupt change of a force of a tyre, a contact or a spring with end stops,
 * and after a start in long steps, the motion is computed again with 1/2 of a short step up to 1/8 of a long one, and
 * at most half of the mean part of a halved one, until both motions agree for 0.5 s or the budget is spent; the
 * difference of their outputs estimates the error of the step. Without a road the growth of the error is extrapolated.
 * If both lose the same energy, as past a singular position, shorter steps do not show the error, which is reported.
 * There is no second motion in runs without abrupt forces, or after a warning. It is a snapshot of the same instance;
 * pending steps are those that it has not computed yet: expensive ones are left to calls with fewer iterations. */
#include "half_steps.h"

enum { MOST_PENDING = 512 }; /* pending steps */

/* Length of n steps of h as it counts in durations of the second motion, s. */
static double counted_length(int64_t n, double h) { return (double)n * h / stretch(h); }

/* Whether the second motion has used its budget up to a step. */
static bool budget_is_spent(const slave_half_steps *t, const slave_pending_step *step) {
  return t->saved->spent > BUDGET + step->simulated / (double)ALI3_MOST_PARTS;
}

/* Number of steps so far that were halved or in which a force changed abruptly. */
static int64_t abrupt_steps(const ali3_report *report) { return report->abrupt_steps + report->halvings; }

/* Number of inputs of the kernel. */
static size_t input_count(const slave *s) { return (size_t)ali3_system_sizes(s->fidelity.system).nu; }

/* Allocates one block: what is part of a state; two snapshots; inputs, and of each pending step its inputs, compared
 * outputs and parameters; work and the comparison of each output. False: nothing is compared, or there is no memory. */
static bool allocate(slave *s) {
  slave_half_steps *t = &s->half_steps;
  const slave_table *table = &slave_the_table;
  const size_t n = compared_count(&s->fidelity), saved = slave_half_steps_size(&s->fidelity), nu = input_count(s),
               np = (size_t)ali3_system_sizes(s->fidelity.system).np, each = nu + n + np,
               snapshot = ali3_snapshot_size(s->fidelity.system);
  if (t->saved != NULL || n == 0) return t->saved != NULL;
  t->saved = s->memory.allocate(1, saved + 2 * snapshot + MOST_PENDING * sizeof(slave_pending_step) +
                                       (nu + MOST_PENDING * each + 2 * n) * sizeof(double) +
                                       n * (sizeof(ali3_judged) + sizeof(size_t) + sizeof(int32_t)));
  if (t->saved == NULL) return false;
  t->n = (int32_t)n;
  t->compared = (ali3_compared *)(t->saved + 1);
  t->second = t->compared + n;
  t->end = (unsigned char *)t->second + snapshot;
  t->start = (unsigned char *)t->end + snapshot;
  t->pending = (slave_pending_step *)((unsigned char *)t->start + snapshot);
  t->input = (double *)(t->pending + MOST_PENDING);
  t->output = t->input + nu;
  t->size = t->output + n;
  for (size_t i = 0; i < MOST_PENDING; i++) {
    t->pending[i].values = t->size + n + i * each;
    t->pending[i].parameter = t->pending[i].values + each - np;
  }
  t->judged = (ali3_judged *)(t->size + n + MOST_PENDING * each);
  t->variable = (size_t *)(t->judged + n);
  t->sensor = (int32_t *)(t->variable + n);
  for (size_t i = table->n_known, k = 0; k < n; i++) {
    if (!is_compared(&s->fidelity, table->variable + i)) continue;
    t->variable[k] = i;
    t->judged[k] = table->variable[i].judged;
    t->sensor[k++] = table->variable[i].index;
  }
  return true;
}

/* Takes the counts of the first motion from its report. */
static void take_counts(slave_half_steps *t, const ali3_report *report) {
  t->abrupt = abrupt_steps(report);
  t->halvings = report->halvings;
  t->iterations = report->iterations;
}

void slave_half_steps_begin(slave *s) {
  slave_half_steps *t = &s->half_steps;
  t->n_pending = 0;
  t->n_made = 0;
  const ali3_report report = get_report(s);
  take_counts(t, &report);
  if (!allocate(s)) {
    if (compared_count(&s->fidelity) > 0)
      slave_log_unchecked(s, ali3_time(s->fidelity.kernel), "there is not enough memory for it");
    return;
  }
  *t->saved =
      (slave_second_motion){.scheduled = -HUGE_VAL, .predicted = HUGE_VAL, .shared = HUGE_VAL, .checked = -HUGE_VAL};
  memset(t->compared, 0, (size_t)t->n * sizeof *t->compared);
  ali3_snapshot_take(s->fidelity.kernel, t->second); /* a valid one until the second motion starts */
  if (ali3_some_sensors(s->fidelity.kernel, t->n, t->sensor, t->output) == ALI3_OK)
    ali3_compare(t->judged, t->n, 1, NULL, NULL, t->output, t->compared);
}

void slave_half_steps_observe(slave *s) {
  slave_half_steps *t = &s->half_steps;
  for (int32_t i = 0; i < t->n; i++) t->output[i] = s->sensors[t->sensor[i]];
  ali3_compare(t->judged, t->n, 1, NULL, NULL, t->output, t->compared);
}

size_t slave_half_steps_size(const slave_fidelity *f) {
  return sizeof(slave_second_motion) + compared_count(f) * sizeof(ali3_compared) + ali3_snapshot_size(f->system);
}

void slave_half_steps_free(slave *s) {
  if (s->half_steps.saved != NULL) s->memory.release(s->half_steps.saved);
  memset(&s->half_steps, 0, sizeof s->half_steps);
}

/* One inner step of the second motion, which the kernel has, in the first pending step. A step with slopes is never pending,
 * so that the present slopes are its own. */
static ali3_status make_inner_step(slave *s, const slave_pending_step *step) {
  slave_half_steps *t = &s->half_steps;
  const size_t nu = input_count(s);
  const double h = step->h / (double)step->parts;
  memcpy(t->input, step->values, nu * sizeof(double));
  if (t->n_made++ == 0) {
    const ali3_status status = slave_restore_step(s, step->parameter, t->input);
    if (status != ALI3_OK) return status;
  }
  if (step->sloped) slave_inputs_at(s, (double)t->n_made * h, t->input);
  return ali3_run(s->fidelity.kernel, h, 1, t->input, 1, NULL, NULL, NULL);
}

/* Before the first inner step of a pending step. Returns whether the second motion computes it: for SPAN after the last
 * abrupt step or difference, within the budget. */
static bool begin_pending_step(slave *s, const slave_pending_step *step) {
  slave_half_steps *t = &s->half_steps;
  const bool rests = !(t->saved->remaining > 0.0);
  t->start_needed = t->start_needed && !step->starts;
  if (step->span > 0.0 && budget_is_spent(t, step)) {
    slave_log_unchecked(s, step->end, "the time of the second motion is spent");
  } else if (step->span > 0.0 && (!rests || step->starts)) {
    if (rests) ali3_snapshot_restore(s->fidelity.kernel, t->start);
    t->saved->remaining = fmax(t->saved->remaining, step->span);
  }
  return t->saved->remaining > 0.0;
}

/* Energy balance times (1 + rotation of the motion, rad), as errors of positions accumulate. */
static double energy_drift(const ali3_report *report) {
  const double rotation = report->speed_peak > 0.0 ? report->velocity_path / report->speed_peak : 0.0;
  return ali3_energy_balance(report) * (1.0 + rotation);
}

/* Whether the second motion has a wrong energy, and not by less than half of the error of the first: both share an
 * error. Roads, driving functions and abrupt forces have errors of the energy by which positions are not wrong. */
static bool shares_error(const slave *s, const slave_pending_step *step, const ali3_report *second) {
  return !has_road(s) && ali3_system_sizes(s->fidelity.system).ng == 0 &&
         second->abrupt_steps + second->divisions == 0 && fabs(second->energy_error) > second->energy_floor &&
         2.0 * fabs(second->energy_error) > fabs(step->energy_error) && energy_drift(second) > ALI3_WRONG_ERROR;
}

/* Whether the second motion has run from the start, without a road, and not ended: only then it shows whether the
 * motion, and not its steps, changes an assembly mode. */
static bool runs_from_start(const slave *s) {
  const slave_second_motion *saved = s->half_steps.saved;
  return saved != NULL && !has_road(s) && saved->checked == -HUGE_VAL &&
         (saved->remaining > 0.0 || s->half_steps.n_pending > 0);
}

bool slave_half_steps_may_follow(const slave *s, double time) {
  return !s->error_warned && runs_from_start(s) &&
         (s->half_steps.n_pending > 0 || ali3_time(s->fidelity.kernel) < time + SPAN * stretch(s->completed.h));
}

/* Compares both motions at the end of a pending step. */
static void compare(slave *s, const slave_pending_step *step) {
  slave_half_steps *t = &s->half_steps;
  const double length = counted_length(step->n, step->h), start = start_span(s, step->h);
  const ali3_report second = get_report(s);
  int32_t worst;
  ali3_some_sensors(s->fidelity.kernel, t->n, t->sensor, t->output);
  ali3_compare(t->judged, t->n, 1, &step->end, step->values + input_count(s), t->output, t->compared);
  ali3_compared_sizes(t->judged, t->n, t->compared, slave_the_table.length, second.energy_floor, 0, t->size);
  const double difference = ali3_compared_error(t->n, t->compared, t->size, 1, &worst);
  t->saved->shared = shares_error(s, step, &second) ? fmin(t->saved->shared, step->end) : HUGE_VAL;
  if (runs_from_start(s) && step->branch_changes > 0 && second.branch_changes > 0)
    s->calls.mode_warned = 1; /* the motion changes its mode and not its steps */
  if (difference > t->saved->difference) {
    t->saved->difference = difference;
    t->saved->time = step->end;
    t->saved->h = step->h;
    t->saved->parts = step->parts;
    t->saved->ratio = step->ratio;
  }
  if (step->simulated <= 0.5 * start) {
    if (step->simulated > 0.25 * start) t->saved->early_difference = fmax(t->saved->early_difference, difference);
  } else if (difference > t->saved->late_difference) {
    t->saved->late_difference = difference;
    t->saved->worst = worst;
  }
  t->saved->remaining -= length;
  if (disagree(difference) && !budget_is_spent(t, step))
    t->saved->remaining = fmax(t->saved->remaining, SPAN); /* it may still grow, as with a spinning wheel */
  t->saved->spent += length;
  if (!(t->saved->remaining > 0.0)) slave_log_conclusion(s, step, difference);
}

/* One inner step of the second motion in the first pending step; none where it rests. Returns the iterations. */
static int64_t advance_second(slave *s) {
  slave_half_steps *t = &s->half_steps;
  const slave_pending_step *step = t->pending + t->first;
  int64_t cost = 0;
  if (t->n_made > 0 || begin_pending_step(s, step)) {
    const int64_t before = get_report(s).iterations;
    const bool good = make_inner_step(s, step) == ALI3_OK;
    cost = get_report(s).iterations - before;
    if (good && t->n_made < step->parts * step->n) return cost;
    if (good) {
      compare(s, step);
    } else {
      t->saved->remaining = 0.0;
      slave_log_unchecked(s, step->end, "a step of it failed");
    }
  }
  t->n_made = 0;
  t->first = (t->first + 1) % MOST_PENDING;
  t->n_pending--;
  return cost;
}

/* Advances the second motion until `most` pending steps are left, and further while its next inner step fits into `room`
 * iterations, of which `made` are used. The kernel has the first motion again afterwards. */
static void run_second(slave *s, size_t most, int64_t made, int64_t room) {
  slave_half_steps *t = &s->half_steps;
  ali3_instance *kernel = s->fidelity.kernel;
  if (t->n_pending <= most && made + t->cost > room) {
    if (t->cost > 0) t->cost--; /* after one expensive step others may be cheaper */
    return;
  }
  ali3_snapshot_take(kernel, t->end);
  ali3_snapshot_restore(kernel, t->second);
  while (t->n_pending > 0 && (t->n_pending > most || made + t->cost <= room)) {
    const int64_t cost = advance_second(s);
    made += cost;
    if (cost > 0) t->cost = cost;
  }
  ali3_snapshot_take(kernel, t->second);
  ali3_snapshot_restore(kernel, t->end);
}

/* Appends the communication step to the pending steps. `span`: s for which the second motion runs after an abrupt force;
 * 0: there was none. `halvings`: of its inner steps; the parts of the second motion are at most half as long as the
 * mean part of the first one. */
static void store_pending_step(slave *s, double now, double span, int64_t halvings) {
  slave_half_steps *t = &s->half_steps;
  const double made = 1.0 + (double)halvings / (double)s->completed.n;
  const int64_t n_parts = (int64_t)fmax((double)nominal_parts(s, s->completed.h), ceil(2.0 * made - 1e-9));
  const double begin = now - (double)s->completed.n * s->completed.h;
  /* times of both motions differ by round-off */
  const bool starts = span > 0.0 && !(begin < t->saved->scheduled - 0.5 * (now - begin));
  if (starts && t->n_pending > 0 && t->start_needed) run_second(s, 0, 0, 0); /* `start` is still needed */
  slave_pending_step *step = t->pending + (t->first + t->n_pending++) % MOST_PENDING;
  if (starts) memcpy(t->start, s->fidelity.start, ali3_snapshot_size(s->fidelity.system));
  t->start_needed = starts || (t->start_needed && t->n_pending > 1);
  if (span > 0.0) t->saved->scheduled = fmax(t->saved->scheduled, begin + span * stretch(s->completed.h));
  const ali3_report report = get_report(s);
  slave_read_step(s, step->parameter, step->values);
  slave_inputs_at(s, 0.0, step->values);
  ali3_some_sensors(s->fidelity.kernel, t->n, t->sensor, step->values + input_count(s));
  *step = (slave_pending_step){.n = s->completed.n,
                               .h = s->completed.h,
                               .end = now,
                               .parts = n_parts,
                               .ratio = (double)n_parts / made,
                               .span = span,
                               .simulated = t->saved->simulated,
                               .energy_error = report.energy_error,
                               .branch_changes = report.branch_changes,
                               .values = step->values,
                               .parameter = step->parameter,
                               .sloped = s->completed.sloped,
                               .starts = starts};
}

void slave_half_steps_settle(slave *s) {
  if (s->error_warned && s->half_steps.saved != NULL) s->half_steps.saved->remaining = 0.0; /* it was left behind */
  if (!s->error_warned && s->half_steps.n_pending > 0) run_second(s, 0, 0, 0);
}

void slave_half_steps_end(slave *s) {
  if (s->half_steps.saved == NULL || s->error_warned || !(s->calls.phase & (SLAVE_STEPPING | SLAVE_STEP_FAILED)))
    return;
  slave_half_steps_settle(s);
  slave_report_motion(s, ali3_time(s->fidelity.kernel), true);
  s->half_steps.saved->remaining = 0.0; /* no more is to be known of assembly modes */
}

slave_status slave_half_steps_advance(slave *s) {
  slave_half_steps *t = &s->half_steps;
  if (t->saved == NULL || s->error_warned) return SLAVE_OK;
  const ali3_report report = get_report(s);
  /* a mechanism without a road swings; driven tyres slip at once, which long steps miss */
  const bool at_start =
      !(t->saved->simulated > 0.0) && (!has_road(s) || 2.0 * s->completed.h > (double)ALI3_MOST_PARTS * SHORT);
  const int64_t made = report.iterations - t->iterations, halvings = report.halvings - t->halvings;
  const double length = counted_length(s->completed.n, s->completed.h), now = ali3_time(s->fidelity.kernel);
  const double span = at_start ? start_span(s, s->completed.h) : abrupt_steps(&report) > t->abrupt ? SPAN : 0.0;
  take_counts(t, &report);
  if (at_start) t->saved->spent = -span; /* besides the budget of abrupt forces */
  t->saved->simulated += length;
  if (span > 0.0 || t->saved->remaining > 0.0 || t->n_pending > 0) {
    const bool waits = (nominal_parts(s, s->completed.h) == 2 || halvings > 0) && !s->completed.sloped;
    store_pending_step(s, now, span, halvings);
    run_second(s, waits ? MOST_PENDING - 1 : 0, made, ALI3_MOST_PARTS * s->completed.n);
  }
  return slave_report_motion(s, now, false);
}
