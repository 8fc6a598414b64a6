/* A step by the method of the settings, in parts where it does not converge, a force changes abruptly or inputs jump. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "../instance.h"
#include "../method.h"
#include "../rows/guides.h"
#include "../start/initialise.h"
#include "../state/inputs.h"
#include "../state/road_files.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "abrupt_force.h"
#include "contact_event.h"
#include "energy_balance.h"
#include "steps.h"

static ali3_status by_method(ali3_instance *in, double t, double h) {
  const ali3_method *method = ali3_method_of(in);
  const ali3_status inputs = ali3_inputs_begin(in, t, h);
  if (inputs != ALI3_OK) return inputs;
  if (method->before != NULL) method->before(in, h);
  if (method->fills)
    ali3_vectors_copy_unwritten(in, &in->next, &in->now);
  else if (!method->relative)
    ali3_vectors_copy(in, &in->next, &in->now);
  const bool by_powers = in->system->n_guide_work > 0 && !(method->has_guides_work && method->has_guides_work(in));
  const double power = by_powers ? ali3_guides_power(in, &in->now) : 0.0;
  const ali3_status status = method->step(in, t, h);
  if (status == ALI3_OK && by_powers)
    ali3_guides_work(in, &in->now, 0.5 * h * (power + ali3_guides_power(in, &in->now)));
  return status;
}

enum { MOST_ITERATIONS = 1000 }; /* of a step with all its parts */

/* A part of a step to time t, in halves where it does not converge or a force changes abruptly in it, and up to and from
 * where a stop is met or left. With a limit of the step's iterations they go up to iterations_end, and only what changes
 * abruptly is divided. */
static ali3_status advance_part(ali3_instance *in, double t, double h, int32_t depth, int64_t iterations_end) {
  const ali3_method *method = ali3_method_of(in);
  const bool limited = in->settings.step_iterations > 0;
  const int64_t made_before = in->report.iterations;
  if (made_before - in->iterations_before > MOST_ITERATIONS) return ALI3_TOO_DEAR;
  if (in->work_left != NULL && *in->work_left <= 0) return ALI3_TOO_DEAR;
  in->halves_left = depth > 0 && depth < in->settings.max_halvings && !limited;
  in->may_divide = ali3_may_divide(in, depth);
  in->changed = -1.0;
  in->event = 1.0;
  in->iterations_end = iterations_end;
  const int64_t divisions = in->report.divisions;
  const ali3_status status = ali3_divides_ahead(in, h) ? ALI3_UNRESOLVED : by_method(in, t, h);
  if (in->work_left != NULL) *in->work_left -= 1 + in->report.iterations - made_before;
  if (status == ALI3_OK) in->t_now = t;
  if (status == ALI3_OK && method->motion != NULL) method->motion(in, h);
  if (status != ALI3_OK && ali3_roads_status(in) != ALI3_OK) return ALI3_ROAD_LOST;
  const bool divided = in->report.divisions != divisions;
  if (status == ALI3_OK || status == ALI3_BAD_ARGUMENT || status == ALI3_BAD_NORMAL || depth <= 0 ||
      (limited && !divided))
    return status;
  if (!divided) in->report.halvings++;
  ali3_back_up(in);
  const int64_t made = in->report.iterations, half = made + (iterations_end - made) / 2;
  const bool located = in->event < 1.0;
  const double share = located ? in->event : 0.5;
  if (!located) depth--;
  const ali3_status first = advance_part(in, t - (1.0 - share) * h, share * h, depth, half);
  return first == ALI3_OK ? advance_part(in, t, (1.0 - share) * h, depth, iterations_end) : first;
}

static const double AT_END = 1e-6; /* of a step: a jump so near to its end is at it */
static const double ROUND_OFF = 4.0 * DBL_EPSILON; /* of the time of a jump: guides are before or behind it */

/* Velocities, accelerations and multipliers behind a jump of a guide at the present time, as by an impulse of its rows,
 * whose work is that of the guide; nothing of the past predicts the next step. */
static ali3_status guide_jump(ali3_instance *in, double time) {
  const bool counts = in->system->n_guide_work > 0;
  const double before = counts ? ali3_kinetic_energy(in) : 0.0;
  in->t_now = time;
  ali3_guides_time(in, &in->now, time + ROUND_OFF * fabs(time));
  const ali3_status status = ali3_solve_rates(in, false);
  if (status != ALI3_OK) return status;
  if (counts) ali3_guides_work(in, &in->now, ali3_kinetic_energy(in) - before);
  memset(in->now.history, 0, ALI3_HISTORY * sizeof(double));
  return ALI3_OK;
}

/* When a step of h to time t ends or is parted: behind its present time where an input or a guide jumps, else at t;
 * `*guide`: when a guide jumps there, else infinity. */
static double part_end(const ali3_instance *in, double t, double h, double *guide) {
  const double inputs = ali3_inputs_until(in, t), near = AT_END * h;
  const double until = in->system->size.ng > 0 ? ali3_guides_break(in, in->t_now + near, inputs + near) : inputs + near;
  *guide = until < inputs + near ? until : HUGE_VAL;
  return until < t - near ? fmin(until, inputs) : fmin(inputs, t);
}

/* Whether a step of h to time t is made in parts, or ends at a jump. */
bool ali3_parted(const ali3_instance *in, double t, double h) {
  double guide;
  return part_end(in, t, h, &guide) < t || guide < HUGE_VAL;
}

/* A step to time t by the method of the settings, which may halve it so deep, in parts that end where inputs or guides
 * jump. */
ali3_status ali3_advance(ali3_instance *in, double t, double h, int32_t depth) {
  double guide;
  ali3_events_begin(in, depth);
  const double until = part_end(in, t, h, &guide);
  if (until == t && guide == HUGE_VAL)
    return advance_part(in, t, h, depth, in->report.iterations + in->settings.step_iterations);
  ali3_back_up(in);
  if (until < t) in->report.divisions++;
  const double end = fmin(until, guide - ROUND_OFF * fabs(guide)), length = until == t ? h : until - in->t_now;
  const bool unobserved = in->unobserved, sampled = in->sampled;
  if (guide < HUGE_VAL) in->unobserved = in->sampled = false; /* the jump reads the state before it */
  ali3_status status = advance_part(in, end, length, depth, in->report.iterations + in->settings.step_iterations);
  in->unobserved = unobserved;
  in->sampled = sampled;
  if (status == ALI3_OK) status = guide < HUGE_VAL ? guide_jump(in, fmax(until, guide)) : ALI3_OK;
  in->iterations_before = in->report.iterations;
  return status == ALI3_OK && until < t ? ali3_advance(in, t, t - until, depth) : status;
}
