/* Step sizes from the error: each step may err by its share of the tolerance (error per unit step), so that the errors
 * of a run add up to it. Where a shorter step does not err less in proportion (a kink of a force, a velocity kicked at
 * a singular position) it may err by a fixed share, and where its error does not fall at all it is accepted and
 * counted. Proportional-integral controller of Gustafsson 1991 (Hairer, Wanner, "Solving Ordinary Differential
 * Equations II", second edition, IV.2). */
#include <math.h>
#include <string.h>

#include "../algebra/elementary.h"
#include "../instance.h"
#include "../method.h"
#include "../rows/guides.h"
#include "../start/initialise.h"
#include "../state/inputs.h"
#include "../state/road_files.h"
#include "../state/vectors.h"
#include "branch_watch.h"
#include "energy_balance.h"
#include "error_control.h"

static const double LEAST_SHARE = 1e-3; /* of the tolerance */
static const double AIM = 0.4; /* of what a step may err */
static const double PROPORTIONAL = 0.4, INTEGRAL = 0.7;
static const double AGAIN = 1.5; /* after a step that stays without a share of its own */
static const double SHRINK = 0.15, GROW = 4.0, MOST_OF_REJECTED = 0.9, AFTER_FAILURE = 0.25;
/* Shortest steps, in parts of the time scale of the motion: shorter ones are not made for the sake of the error, since
 * round-off of index three grows there, and not for that of convergence. */
static const double SHORTEST[] = {
    [ALI3_ROUND_OFF_INDEX_3] = 1e-4, [ALI3_ROUND_OFF_COLLOCATION] = 1e-6, [ALI3_ROUND_OFF_INDEX_1] = 1e-10};
static const double SHORTEST_TRIED[] = {
    [ALI3_ROUND_OFF_INDEX_3] = 1e-6, [ALI3_ROUND_OFF_COLLOCATION] = 1e-7, [ALI3_ROUND_OFF_INDEX_1] = 1e-10};
static const double KINK = 0.5, KICK = 0.7; /* error over the one before: in parts of the steps' ratio, and plainly */
enum { KICKS = 2 };                         /* so often in one step */
static const double UNUSUAL = 0.3, USUAL_STEPS = 200.0;
static const double ROUND_OFF = 64.0 * 2.3e-16; /* of the time */
static const double FIRST = 1e-3;       /* of the span: first step where none is given */
static const double ON_A_ROAD = 0.05;   /* lengths on the way in a step: bumps between two evaluations are not seen */
static const double LEAST_ERROR = 1e-4; /* parts of what a step may err: below, errors are round-off */

static bool valid(const ali3_control *c) {
  return c != NULL && c->tolerance > 0.0 && c->tolerance < 1e300 && c->length > 0.0 && c->length < 1e300 &&
         c->span > 0.0 && c->span < 1e300 && c->rate > 0.0 && c->rate < 1e300 && c->longest > 0.0 && c->h >= 0.0 &&
         c->longest < 1e300 && c->h < 1e300;
}

static void set_time(ali3_instance *in, double t) {
  in->clock.base = t;
  in->clock.h = 0.0;
  in->clock.count = 0;
  in->clock.now = t;
}

/* Restarts where inputs or guides jump: accelerations and multipliers behind the jump, without a past. */
ali3_status ali3_refresh(ali3_instance *in) {
  if (in == NULL) return ALI3_BAD_ARGUMENT;
  if (!in->start.initialised) return ALI3_NOT_INITIALISED;
  in->clock.now = ali3_time(in);
  ali3_vectors_copy(in, &in->kept.start, &in->now);
  ali3_guides_time(in, &in->now, in->clock.now);
  ali3_status status = in->inputs.function != NULL ? ali3_inputs_begin(in, in->clock.now, 0.0) : ALI3_OK;
  if (in->inputs.function != NULL)
    memcpy(in->inputs.set, in->inputs.begin, (size_t)in->system->size.nu * sizeof(double));
  if (status == ALI3_OK) status = ali3_solve_rates(in, false);
  if (status != ALI3_OK) {
    ali3_vectors_copy(in, &in->now, &in->kept.start);
    return status;
  }
  memset(in->now.history, 0, ALI3_HISTORY * sizeof(double));
  return ALI3_OK;
}

/* A step of at most h towards `end`, so that no sliver is left before it. */
static double fitted(double h, double left) {
  if (h >= left * (1.0 - 1e-9)) return left;
  return h > 0.5 * left ? 0.5 * left : h;
}

/* x^k for positive x, the same bits everywhere; the logarithm by the series of 2 artanh. */
static double power(double x, double k) {
  int exponent = 0;
  const double m = frexp(x, &exponent), z = (m - 1.0) / (m + 1.0), square = z * z;
  double sum = 0.0;
  for (int n = 21; n > 0; n -= 2) sum = sum * square + 1.0 / n;
  return ali3_exp(k * (2.0 * z * sum + 0.6931471805599453 * exponent));
}

/* Ratio of the next step to this one; `part`, `last`: errors over their limits; last = 0: unknown or of no use. */
static double factor(double part, double last, int32_t order) {
  const double k = 1.0 / (order + 1), e = fmax(part, LEAST_ERROR) / AIM;
  const double f = last > 0.0 ? power(e, -INTEGRAL * k) * power(last / AIM, PROPORTIONAL * k) : power(e, -k);
  return fmin(GROW, fmax(SHRINK, f));
}

static double shortest(const ali3_instance *in, const ali3_measure *measure, double t, const double *share) {
  return fmax(share[ali3_method_of(in)->round_off] * fmin(measure->control->span, 1.0 / ali3_rate(in, measure, false)),
              ROUND_OFF * fabs(t));
}

/* Record of the tries of one step. */
typedef struct {
  double first, h, error; /* the first one that erred too much, and the last with its error; 0: none */
  int32_t kicks;
  bool rejected, force;
} tries;

enum { REJECT = 0, ACCEPT, OVER_SHARE, FORCE };

/* Whether a step of h that errs so much stays: REJECT, ACCEPT, OVER_SHARE (accepted, though above its share), FORCE (the
 * tolerance does not hold). Much shorter steps than usual are a sign of a singular position: with index three those have least
 * to gain there, and in the end only round-off. */
static int judge(const ali3_control *c, tries *seen, double h, double error, bool least) {
  const bool small = error <= c->tolerance * LEAST_SHARE;
  if (error <= c->tolerance * h / c->span) return ACCEPT;
  if (small && h < UNUSUAL * c->usual) return OVER_SHARE;
  if (seen->force || least) return small ? OVER_SHARE : FORCE;
  if (seen->h > 0.0) {
    const double fall = error / seen->error;
    if (small && fall > KINK * h / seen->h) return OVER_SHARE;
    seen->kicks = fall > KICK && h < KICK * seen->h ? seen->kicks + 1 : 0;
  } else {
    seen->first = h;
  }
  seen->h = h;
  seen->error = error;
  seen->force = seen->kicks == KICKS;
  return REJECT;
}

static void accepted(ali3_control *c, double h, double error, double part, int verdict) {
  if (c->accepted == 0 || h < c->smallest) c->smallest = h;
  if (h > c->largest) c->largest = h;
  c->accepted++;
  c->error_sum += error;
  c->last = fmax(part, LEAST_ERROR);
  c->usual += (c->accepted > USUAL_STEPS ? 1.0 / USUAL_STEPS : 1.0 / (double)c->accepted) * (h - c->usual);
  if (verdict == OVER_SHARE) c->over_share++;
  if (verdict != FORCE) return;
  c->forced++;
  c->forced_error += error;
}

/* The next step after one of `tried` s, when `size` was wished; a step cut short by the end of the call says little. */
static double next_step(const ali3_control *c, double size, double tried, double part, bool rejected, int32_t order) {
  const double next = tried * factor(part, c->last, order);
  if (rejected) return fmin(next, tried);
  return tried < size ? fmax(next, fmin(size, GROW * next)) : next;
}

/* Back to before a step that was made and is not kept. */
static void take_back(ali3_instance *in, const ali3_report *before) {
  ali3_vectors_copy(in, &in->now, &in->kept.origin);
  in->report.steps = before->steps;
  ali3_balance_restore(&in->report, before);
}

/* The longest step, s: as given, and shorter where the motion may hold more than its error shows. */
static double longest(const ali3_instance *in, const ali3_measure *measure) {
  const double given = measure->control->longest;
  if (in->system->nr > 0) return fmin(given, ON_A_ROAD / ali3_rate(in, measure, false));
  /* In closed loops what a drive turns or moves in a step, h w, shows in no error: half of what steps resolve. */
  return in->system->n_mode_triad > 0 ? fmin(given, ALI3_RESOLVED / ali3_rate(in, measure, true)) : given;
}

/* One accepted step from t, at most to `end`; *h is its length. */
static ali3_status controlled_step(ali3_instance *in, const ali3_measure *measure, double t, double end, double *h) {
  ali3_control *c = measure->control;
  const int32_t order = ali3_method_order(in);
  const double least = shortest(in, measure, t, SHORTEST), end_of_tries = shortest(in, measure, t, SHORTEST_TRIED);
  const double most = longest(in, measure);
  tries seen = {0};
  for (;;) {
    double error = 0.0;
    const ali3_report before = in->report;
    const double size = fmin(c->h, most), tried = fitted(size, end - t);
    const ali3_status status = ali3_step_doubling(in, measure, t, tried, &error);
    *h = tried;
    if (status == ALI3_BAD_ARGUMENT || ali3_roads_status(in) != ALI3_OK) return status;
    if (status != ALI3_OK) {
      in->report.failures++;
      c->failed++;
      if (tried <= 1.5 * end_of_tries) return status;
      c->h = fmax(AFTER_FAILURE * tried, end_of_tries);
      c->last = 0.0;
      seen.rejected = true;
      continue;
    }
    const double part = error * c->span / (c->tolerance * tried);
    const int verdict = judge(c, &seen, tried, error, tried <= 1.5 * least);
    const double share = verdict == ACCEPT && tried > 1.5 * least ? ali3_branch_share(in, measure, t, tried) : 1.0;
    if (share < 1.0) {
      seen.rejected = true;
      c->rejected++;
      c->h = fmax(least, share * tried);
      take_back(in, &before);
      continue;
    }
    if (verdict != REJECT) {
      c->h = verdict == ACCEPT ? fmax(least, next_step(c, size, tried, part, seen.rejected, order)) : AGAIN * tried;
      accepted(c, tried, error, verdict == ACCEPT ? part : 1.0, verdict);
      return ALI3_OK;
    }
    c->rejected++;
    c->h = seen.force ? seen.first : fmax(least, tried * fmin(MOST_OF_REJECTED, factor(part, 0.0, order)));
    seen.rejected = true;
    take_back(in, &before);
  }
}

/* Sets the report to the state in in->now, which was not read while steps were made. */
static void finish(ali3_instance *in) {
  const ali3_method *method = ali3_method_of(in);
  if (method->after_sampled != NULL && in->now.history[ALI3_HISTORY_OWNER] == (double)method->owner)
    method->after_sampled(in);
}

/* Whether inputs are others than those that the last step ended with. */
static bool jumped(ali3_instance *in) {
  if (in->inputs.function == NULL)
    return memcmp(in->inputs.set, in->now.used, (size_t)in->system->size.nu * sizeof(double)) != 0;
  in->clock.now = ali3_time(in);
  return ali3_inputs_begin(in, in->clock.now, 0.0) != ALI3_OK || ali3_inputs_jump(in);
}

static ali3_status run(ali3_instance *in, const ali3_measure *measure, double t_end, int64_t most_steps,
                       const ali3_record *record, int64_t *done) {
  const int32_t ns = in->system->size.ns, nq = in->system->size.nq;
  ali3_status status = ALI3_OK;
  double t = ali3_time(in);
  for (int64_t n = 0; n < most_steps && t < t_end && status == ALI3_OK; n++) {
    const double until = ali3_guides_until(in, t, t_end);
    const double before = fmax(t, until - 4.0 * 2.3e-16 * fabs(until)); /* the guide's piece that ends there */
    double h = 0.0;
    status = controlled_step(in, measure, t, until < t_end ? before : t_end, &h);
    if (status != ALI3_OK) break;
    double next = t + h;
    if (next >= until - ROUND_OFF * fabs(until)) next = until;
    for (; *done < record->n && record->time[*done] <= next && status == ALI3_OK; ++*done)
      status = ali3_dense_output(in, measure, t, h, record->time[*done],
                                 record->sensors != NULL ? record->sensors + *done * ns : NULL,
                                 record->positions != NULL ? record->positions + *done * nq : NULL);
    t = next;
    set_time(in, t);
    ali3_branch_look(in, t);
    if (t == until && until < t_end && status == ALI3_OK) status = ali3_refresh(in);
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
  ali3_roads_forgive(in);
  if (control->h == 0.0) control->h = fmin(control->longest, FIRST * control->span);
  if (jumped(in)) status = ali3_refresh(in);
  if (status == ALI3_OK) status = ali3_inputs_aim(in, 0.0, NULL);
  ali3_branch_before(in); /* the modes of the start, where they have not been evaluated yet */
  if (status == ALI3_OK) status = run(in, &measure, t_end, most_steps, record, done);
  finish(in);
  in->report.last_status = (int32_t)status;
  return status;
}
