/* Error of a step by step doubling: one whole step and two halves, whose result is used (Hairer, Norsett, Wanner,
 * "Solving Ordinary Differential Equations I", second edition, II.4). */
#include <math.h>
#include <string.h>

#include "../instance.h"
#include "../method.h"
#include "../state/vectors.h"
#include "contact_event.h"
#include "energy_balance.h"
#include "error_control.h"
#include "steps.h"

/* Largest order assumed in the error estimate: long steps of order eight at loose tolerances turn by radians, and their
 * errors were up to four times the estimate for order eight. */
enum { MAX_ORDER = 6 };

ali3_status ali3_trial_step(ali3_instance *in, double t, double h, ali3_reading reading) {
  in->stored.backed_up = false;
  in->bound.iterations_before = in->report.iterations;
  in->clock.now = t;
  const ali3_request request = {.t = t + h, .h = h, .reading = reading, .controlled = true};
  return ali3_advance(in, &request);
}

/* Size of a unit of coordinate i, m. */
static double unit_length(const ali3_measure *measure, int32_t i) {
  return measure->scale != NULL ? measure->scale[i] : 1.0;
}

double ali3_distance(const ali3_instance *in, const ali3_measure *measure, const double *q, const double *qd,
                     double rate) {
  const ali3_system *S = in->system;
  double largest = 0.0;
  for (int32_t i = 0; i < S->size.nq; i++) {
    const double size = fabs(q[i]), speed = in->mass.missing[i] == 0.0 ? fabs(qd[i]) / rate : 0.0;
    const double part = unit_length(measure, i) * fmax(size, speed);
    if (!(part <= largest) && largest == largest) largest = part; /* a NaN stays */
  }
  return largest / measure->control->length;
}

double ali3_rate(const ali3_instance *in, const ali3_measure *measure, bool all) {
  const ali3_system *S = in->system;
  double largest = 0.0;
  for (int32_t i = 0; i < S->size.nq; i++)
    if (all || in->mass.missing[i] == 0.0) largest = fmax(largest, unit_length(measure, i) * fabs(in->now.qd[i]));
  return fmax(measure->control->rate, largest / measure->control->length);
}

/* Order by which halves of the step from stored.origin over stored.centre to now err less than the whole one: 1 where
 * an end stop or a row of a table is passed, as the error of a kink depends on where it lies in the step. */
static int32_t order_of_step(const ali3_instance *in, double h) {
  const ali3_stored_states *s = &in->stored;
  if (ali3_meets_event(in, &s->origin, &s->centre, 0.5 * h) || ali3_meets_event(in, &s->centre, &in->now, 0.5 * h))
    return 1;
  return ali3_method_order(in) < MAX_ORDER ? ali3_method_order(in) : MAX_ORDER;
}

ali3_status ali3_step_doubling(ali3_instance *in, const ali3_measure *measure, double t, double h, double *error) {
  const int32_t nq = in->system->size.nq;
  const ali3_report before = in->report;
  ali3_vectors_copy(in, &in->stored.origin, &in->now);
  ali3_status status = ali3_trial_step(in, t, h, ALI3_READ_SENSORS);
  ali3_balance_restore(&in->report, &before);
  ali3_vectors_copy(in, &in->stored.coarse, &in->now);
  ali3_vectors_copy(in, &in->now, &in->stored.origin);
  if (status == ALI3_OK) status = ali3_trial_step(in, t, 0.5 * h, ALI3_READ_SENSORS);
  if (status == ALI3_OK) {
    in->report.steps++;
    ali3_vectors_copy(in, &in->stored.centre, &in->now);
    status = ali3_trial_step(in, t + 0.5 * h, 0.5 * h, ALI3_READ_SENSORS);
  }
  if (status == ALI3_OK) {
    const double error_factor = 1.0 / (ldexp(1.0, order_of_step(in, h)) - 1.0);
    for (int32_t i = 0; i < nq; i++) {
      in->step.w[i] = error_factor * (in->now.q[i] - in->stored.coarse.q[i]);
      in->step.x[i] = error_factor * (in->now.qd[i] - in->stored.coarse.qd[i]);
    }
    *error = ali3_distance(in, measure, in->step.w, in->step.x, ali3_rate(in, measure, false));
    in->report.steps++;
    if (*error < 1e300) return ALI3_OK;
    status = ALI3_NOT_FINITE;
  }
  ali3_balance_restore(&in->report, &before);
  in->report.steps = before.steps;
  ali3_vectors_copy(in, &in->now, &in->stored.origin);
  return status;
}
