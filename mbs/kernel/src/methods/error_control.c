/* Step sizes from the error: the error of each step may be its part of the tolerance (error per unit step), so that the
 * errors of a run add up to the tolerance. Where steps become much shorter than usual (a kink of a force, a velocity
 * jump at a singular position) an error may be a fixed fraction, and a step of the least size is accepted and counted.
 * Proportional-integral controller of Gustafsson 1991 (Hairer, Wanner, "Solving Ordinary Differential Equations II",
 * second edition, IV.2). */
#include <math.h>
#include <string.h>

#include "../algebra/elementary.h"
#include "../instance.h"
#include "../method.h"
#include "../rows/driving_functions.h"
#include "../start/initialise.h"
#include "../state/inputs.h"
#include "../state/road_files.h"
#include "../state/vectors.h"
#include "abrupt_force.h"
#include "branch_watch.h"
#include "energy_balance.h"
#include "error_control.h"

static const double MIN_FRACTION = 1e-3; /* of the tolerance */
static const double TARGET = 0.4; /* of the allowed error of a step */
static const double PROPORTIONAL = 0.4, INTEGRAL = 0.7;
static const double AFTER_OVER_SHARE = 1.5; /* factor of the step after one accepted above its part */
static const double GROW = 4.0; /* largest ratio of two steps; its inverse the least, and that after a failure */
/* Shortest steps, relative to the time scale of the motion: round-off of index three grows in shorter ones. */
static const double MIN_STEP[] = {[ALI3_ROUND_OFF_INDEX_3] = 1e-4, [ALI3_ROUND_OFF_INDEX_1] = 1e-6};
static const double UNUSUAL = 0.3; /* of the mean step: shorter ones may err more than their part */
static const double ROUND_OFF = 64.0 * 2.3e-16; /* of the time */
static const double FIRST_STEP = 1e-3; /* first step / span for a tolerance of 1, if none is given */
static const double ROAD_LENGTHS = 0.05; /* largest path in a step, in lengths: bumps within a step are missed */
static const double MIN_ERROR = 1e-4; /* of the allowed error of a step: smaller errors are round-off */

/* Whether the settings of the control are finite and in range. */
static bool valid(const ali3_control *c) {
  return c != NULL && c->tolerance > 0.0 && c->tolerance < 1e300 && c->length > 0.0 && c->length < 1e300 &&
         c->span > 0.0 && c->span < 1e300 && c->rate > 0.0 && c->rate < 1e300 && c->longest > 0.0 && c->h >= 0.0 &&
         c->longest < 1e300 && c->h < 1e300;
}

/* Sets the time at which the next step starts, s. */
static void set_time(ali3_instance *in, double t) {
  in->clock.base = t;
  in->clock.h = 0.0;
  in->clock.count = 0;
  in->clock.now = t;
}

/* Computes accelerations and multipliers after a jump of inputs or driving functions and clears the history. */
ali3_status ali3_refresh(ali3_instance *in) {
  if (in == NULL) return ALI3_BAD_ARGUMENT;
  if (!in->start.initialised) return ALI3_NOT_INITIALISED;
  in->clock.now = ali3_time(in);
  ali3_vectors_copy(in, &in->stored.start, &in->now);
  ali3_driving_time(in, &in->now, in->clock.now);
  ali3_status status = in->inputs.function != NULL ? ali3_inputs_begin(in, in->clock.now, 0.0) : ALI3_OK;
  if (in->inputs.function != NULL)
    memcpy(in->inputs.set, in->inputs.begin, (size_t)in->system->size.nu * sizeof(double));
  if (status == ALI3_OK) status = ali3_solve_rates(in, false);
  if (status != ALI3_OK) {
    ali3_vectors_copy(in, &in->now, &in->stored.start);
    return status;
  }
  memset(in->now.history, 0, ALI3_HISTORY * sizeof(double));
  return ALI3_OK;
}

/* A step of at most h towards `end` that does not leave a very short one before it. */
static double fit_step(double h, double remaining) {
  if (h >= remaining * (1.0 - 1e-9)) return remaining;
  return h > 0.5 * remaining ? 0.5 * remaining : h;
}

/* x^k for positive x, bit-identical on all platforms; the logarithm by the series of 2 artanh. */
static double power(double x, double k) {
  int exponent = 0;
  const double m = frexp(x, &exponent), z = (m - 1.0) / (m + 1.0), square = z * z;
  double sum = 0.0;
  for (int n = 21; n > 0; n -= 2) sum = sum * square + 1.0 / n;
  return ali3_exp(k * (2.0 * z * sum + 0.6931471805599453 * exponent));
}

/* Ratio of the next step to this one; `relative_error`, `last_error`: errors over their limits; last_error = 0:
 * unknown. */
static double factor(double relative_error, double last_error, int32_t order) {
  const double k = 1.0 / (order + 1), e = fmax(relative_error, MIN_ERROR) / TARGET;
  const double f =
      last_error > 0.0 ? power(e, -INTEGRAL * k) * power(last_error / TARGET, PROPORTIONAL * k) : power(e, -k);
  return fmin(GROW, fmax(1.0 / GROW, f));
}

/* Shortest step, s: in a shorter one round-off would dominate. */
static double min_step(const ali3_instance *in, const ali3_measure *measure, double t) {
  return fmax(MIN_STEP[ali3_method_of(in)->round_off] *
                  fmin(measure->control->span, 1.0 / ali3_rate(in, measure, false)),
              ROUND_OFF * fabs(t));
}

enum { REJECT = 0, ACCEPT, OVER_SHARE, FORCE };

/* Verdict on a step of h by its error: REJECT, ACCEPT, OVER_SHARE (accepted, though above its part), FORCE (accepted
 * above the tolerance). Much shorter steps than usual occur at singular positions, where with index three shorter ones
 * gain little and end in round-off. */
static int judge_error(const ali3_control *c, double h, double error, bool is_shortest) {
  const bool small = error <= c->tolerance * MIN_FRACTION;
  if (error <= c->tolerance * h / c->span) return ACCEPT;
  if (small && (is_shortest || h < UNUSUAL * c->usual)) return OVER_SHARE;
  return is_shortest ? FORCE : REJECT;
}

/* Updates the statistics of the control by an accepted step. */
static void record_accepted(ali3_control *c, double h, double error, double relative_error, int verdict) {
  if (c->accepted == 0 || h < c->smallest) c->smallest = h;
  if (h > c->largest) c->largest = h;
  c->accepted++;
  c->error_sum += error;
  c->last = fmax(relative_error, MIN_ERROR);
  c->usual += (h - c->usual) / (double)c->accepted;
  if (verdict == OVER_SHARE) c->over_share++;
  if (verdict != FORCE) return;
  c->forced++;
  c->forced_error += error;
}

/* The next step after one of `tried` s where `wanted` s were planned; a step that was cut short by the end of the call
 * has little information. */
static double next_step(const ali3_control *c, double wanted, double tried, double relative_error, bool rejected,
                        int32_t order) {
  const double next = tried * factor(relative_error, c->last, order);
  if (rejected) return fmin(next, tried);
  return tried < wanted ? fmax(next, fmin(wanted, GROW * next)) : next;
}

/* Restores the state before a step that is not accepted. */
static void undo_step(ali3_instance *in, const ali3_report *end_before) {
  ali3_vectors_copy(in, &in->now, &in->stored.origin);
  in->report.steps = end_before->steps;
  ali3_balance_restore(&in->report, end_before);
}

/* The first step, s, in proportion to the later ones of a tolerance: steps that runs to two tolerances begin with alike
 * leave an error in both, which their difference does not show. */
static double first_step(const ali3_instance *in, const ali3_measure *measure) {
  const ali3_control *c = measure->control;
  const double h = FIRST_STEP * c->span * power(fmin(c->tolerance, 1.0), 1.0 / (ali3_method_order(in) + 1));
  return fmin(c->longest, fmax(h, min_step(in, measure, ali3_time(in))));
}

/* The longest step, s: as given, and shorter where errors of the motion may not show in the estimate. */
static double longest_step(const ali3_instance *in, const ali3_measure *measure) {
  const double limit = ali3_tables_resolved_step(in, measure->control->longest);
  if (in->system->nr > 0) return fmin(limit, ROAD_LENGTHS / ali3_rate(in, measure, false));
  /* in closed loops the error of a drive's displacement in a step, h w, does not show: half of what steps resolve */
  return in->system->n_mode_triad > 0 ? fmin(limit, ALI3_RESOLVED / ali3_rate(in, measure, true)) : limit;
}

/* Makes one accepted step from t, at most to `end`; *h is its length. */
static ali3_status controlled_step(ali3_instance *in, const ali3_measure *measure, double t, double end, double *h) {
  ali3_control *c = measure->control;
  const int32_t order = ali3_method_order(in);
  const double min_h = min_step(in, measure, t), longest_h = longest_step(in, measure);
  bool rejected = false;
  for (;;) {
    double error = 0.0;
    const ali3_report end_before = in->report;
    const double wanted = fmin(c->h, longest_h), tried = fit_step(wanted, end - t);
    const ali3_status status = ali3_step_doubling(in, measure, t, tried, &error);
    *h = tried;
    if (status == ALI3_BAD_ARGUMENT || ali3_roads_status(in) != ALI3_OK) return status;
    if (status != ALI3_OK) {
      in->report.failures++;
      c->failed++;
      if (tried <= 1.5 * min_h) return status;
      c->h = fmax(tried / GROW, min_h);
      c->last = 0.0;
      rejected = true;
      continue;
    }
    const double relative_error = error * c->span / (c->tolerance * tried);
    const int verdict = judge_error(c, tried, error, tried <= 1.5 * min_h);
    const double fraction =
        verdict == ACCEPT && tried > 1.5 * min_h ? ali3_branch_fraction(in, measure, t, tried) : 1.0;
    if (fraction < 1.0) {
      rejected = true;
      c->rejected++;
      c->h = fmax(min_h, fraction * tried);
      undo_step(in, &end_before);
      continue;
    }
    if (verdict != REJECT) {
      c->h = verdict == ACCEPT ? fmax(min_h, next_step(c, wanted, tried, relative_error, rejected, order))
                               : AFTER_OVER_SHARE * tried;
      record_accepted(c, tried, error, verdict == ACCEPT ? relative_error : 1.0, verdict);
      return ALI3_OK;
    }
    c->rejected++;
    c->h = fmax(min_h, tried * factor(relative_error, 0.0, order));
    rejected = true;
    undo_step(in, &end_before);
  }
}

/* Updates the report for in->now, which was not read during the steps. */
static void update_report(ali3_instance *in) {
  const ali3_method *method = ali3_method_of(in);
  if (method->after_sampled != NULL && in->now.history[ALI3_HISTORY_OWNER] == (double)method->owner)
    method->after_sampled(in);
}

/* Whether inputs differ from those at the end of the last step. */
static bool inputs_have_jumped(ali3_instance *in) {
  if (in->inputs.function == NULL)
    return memcmp(in->inputs.set, in->now.used, (size_t)in->system->size.nu * sizeof(double)) != 0;
  in->clock.now = ali3_time(in);
  return ali3_inputs_begin(in, in->clock.now, 0.0) != ALI3_OK || ali3_inputs_jump(in);
}

/* Makes at most most_steps steps up to t_end, s; *done: their number. */
static ali3_status run(ali3_instance *in, const ali3_measure *measure, double t_end, int64_t most_steps,
                       const ali3_record *record, int64_t *done) {
  const int32_t ns = in->system->size.ns, nq = in->system->size.nq;
  ali3_status status = ALI3_OK;
  double t = ali3_time(in);
  for (int64_t n = 0; n < most_steps && t < t_end && status == ALI3_OK; n++) {
    const double piece_end = ali3_driving_until(in, t, t_end);
    const double end_before = fmax(t, piece_end - 4.0 * 2.3e-16 * fabs(piece_end)); /* still in this piece */
    double h = 0.0;
    status = controlled_step(in, measure, t, piece_end < t_end ? end_before : t_end, &h);
    if (status != ALI3_OK) break;
    double next = t + h;
    if (next >= piece_end - ROUND_OFF * fabs(piece_end)) next = piece_end;
    for (; *done < record->n && record->time[*done] <= next && status == ALI3_OK; ++*done)
      status = ali3_dense_output(in, measure, t, h, record->time[*done],
                                 record->sensors != NULL ? record->sensors + *done * ns : NULL,
                                 record->positions != NULL ? record->positions + *done * nq : NULL);
    t = next;
    set_time(in, t);
    ali3_branch_check(in, t);
    if (t == piece_end && piece_end < t_end && status == ALI3_OK) status = ali3_refresh(in);
  }
  return status;
}

ali3_status ali3_control_run(ali3_instance *in, ali3_control *control, const double *scale, double t_end,
                             int64_t most_steps, const ali3_record *record, int64_t *done) {
  if (in == NULL || !valid(control) || record == NULL || done == NULL || *done < 0 || !(t_end - t_end == 0.0) ||
      (record->n > 0 && record->time == NULL))
    return ALI3_BAD_ARGUMENT;
  if (!in->start.initialised) return ALI3_NOT_INITIALISED;
  ali3_status status = ali3_check_method(in);
  if (status != ALI3_OK) return status;
  const ali3_measure measure = {control, scale};
  ali3_roads_clear_read_errors(in);
  if (control->h == 0.0) control->h = first_step(in, &measure);
  if (inputs_have_jumped(in)) status = ali3_refresh(in);
  if (status == ALI3_OK) status = ali3_inputs_set_end(in, 0.0, NULL);
  ali3_branch_before(in); /* assembly modes of the start, if not evaluated yet */
  if (status == ALI3_OK) status = run(in, &measure, t_end, most_steps, record, done);
  update_report(in);
  in->report.last_status = (int32_t)status;
  return status;
}
