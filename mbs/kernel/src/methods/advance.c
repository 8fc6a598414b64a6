/* A step by the method of the settings, in parts if it does not converge, a force changes abruptly, inputs jump, or the
 * ends of the step do not resolve a force by table or a driving function. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "../instance.h"
#include "../method.h"
#include "../rows/driving_functions.h"
#include "../start/initialise.h"
#include "../state/inputs.h"
#include "../state/road_files.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "abrupt_force.h"
#include "contact_event.h"
#include "energy_balance.h"
#include "steps.h"

/* A part of a step, between breaks, by the method of the settings. */
static ali3_status make_part(ali3_instance *in, const ali3_request *request) {
  const ali3_method *method = ali3_method_of(in);
  const double h = request->h;
  const ali3_status inputs = ali3_inputs_begin(in, request->t, h);
  if (inputs != ALI3_OK) return inputs;
  if (method->before != NULL) method->before(in, request);
  if (method->fills)
    ali3_vectors_copy_unwritten(in, &in->next, &in->now);
  else if (!method->relative)
    ali3_vectors_copy(in, &in->next, &in->now);
  const bool trapezoidal_work =
      in->system->n_driving_work > 0 && !(method->has_driving_work && method->has_driving_work(in));
  const double power = trapezoidal_work ? ali3_driving_power(in, &in->now) : 0.0;
  const ali3_status status = method->step(in, request);
  if (status == ALI3_OK && trapezoidal_work)
    ali3_driving_work(in, &in->now, 0.5 * h * (power + ali3_driving_power(in, &in->now)));
  return status;
}

/* make_part by a method that locates no events before it accepts a part: at one that its ends show the part is divided,
 * in->now is its start again, and of the measures the counts of the event stay. */
static ali3_status make_part_to_event(ali3_instance *in, const ali3_request *request) {
  ali3_report before = in->report;
  const ali3_status status = make_part(in, request);
  if (status != ALI3_OK || !ali3_contact_event(in, request, &in->next, &in->now)) return status;
  before.divisions = in->report.divisions;
  before.abrupt_steps = in->report.abrupt_steps;
  ali3_vectors_swap(&in->now, &in->next);
  ali3_balance_restore(&in->report, &before);
  return ALI3_UNRESOLVED;
}

enum { MAX_ITERATIONS = 1000 }; /* of a step including its parts */

/* Makes a part of a step: in halves if it does not converge or a force changes abruptly, and divided when a stop is met
 * or left. With a limit of iterations only the latter divide it. */
static ali3_status advance_part(ali3_instance *in, const ali3_request *part) {
  const ali3_method *method = ali3_method_of(in);
  const bool limited = in->settings.step_iterations > 0;
  const int64_t iterations = in->report.iterations, divisions = in->report.divisions;
  if (iterations - in->bound.iterations_before > MAX_ITERATIONS) return ALI3_TOO_MUCH_WORK;
  if (in->bound.work_left != NULL && *in->bound.work_left <= 0) return ALI3_TOO_MUCH_WORK;
  in->parting.changed = -1.0;
  in->parting.event = 1.0;
  const ali3_status status = ali3_divides_ahead(in, part) ? ALI3_UNRESOLVED
                             : method->locates_events     ? make_part(in, part)
                                                          : make_part_to_event(in, part);
  if (in->bound.work_left != NULL) *in->bound.work_left -= 1 + in->report.iterations - iterations;
  if (status == ALI3_OK) in->clock.now = part->t;
  if (status == ALI3_OK && method->motion != NULL) method->motion(in, part->h);
  if (status != ALI3_OK && ali3_roads_status(in) != ALI3_OK) return ALI3_ROAD_LOST;
  const bool divided = in->report.divisions != divisions;
  if (status == ALI3_OK || status == ALI3_BAD_ARGUMENT || status == ALI3_BAD_NORMAL || part->depth <= 0 ||
      (limited && !divided))
    return status;
  if (!divided) in->report.halvings++;
  ali3_back_up(in);
  const int64_t made = in->report.iterations;
  const bool at_event = in->parting.event < 1.0;
  const double fraction = at_event ? in->parting.event : 0.5;
  ali3_request first = *part, second = *part;
  first.t = part->t - (1.0 - fraction) * part->h;
  first.h = fraction * part->h;
  first.iterations_end = made + (part->iterations_end - made) / 2;
  second.h = (1.0 - fraction) * part->h;
  if (!at_event) first.depth = second.depth = part->depth - 1;
  const ali3_status first_status = advance_part(in, &first);
  return first_status == ALI3_OK ? advance_part(in, &second) : first_status;
}

static const double AT_END = 1e-6; /* of a step: a nearer jump is at its end */
/* Distance from a jump, relative to its time, at which driving functions are evaluated before and after it. */
static const double ROUND_OFF = 4.0 * DBL_EPSILON;

/* Computes velocities, accelerations and multipliers after a jump of a driving function at `time`, as by an impulse of
 * its rows, whose work is that of the driving function; clears the history. */
static ali3_status driving_jump(ali3_instance *in, double time) {
  const bool senses_driving_work = in->system->n_driving_work > 0;
  const double before = senses_driving_work ? ali3_kinetic_energy(in) : 0.0;
  in->clock.now = time;
  ali3_driving_time(in, &in->now, time + ROUND_OFF * fabs(time));
  const ali3_status status = ali3_solve_rates(in, false);
  if (status != ALI3_OK) return status;
  if (senses_driving_work) ali3_driving_work(in, &in->now, ali3_kinetic_energy(in) - before);
  memset(in->now.history, 0, ALI3_HISTORY * sizeof(double));
  return ALI3_OK;
}

/* Time of the next jump of an input or a driving function in a step of h to time t, otherwise t. `*driving`: that of a
 * driving function, also at t, otherwise infinity. */
static double next_jump(const ali3_instance *in, double t, double h, double *driving) {
  const double near = AT_END * h, inputs = ali3_inputs_until(in, t);
  const double jump =
      in->system->size.ng > 0 ? ali3_driving_break(in, in->clock.now + near, inputs + near) : inputs + near;
  *driving = jump < inputs + near ? jump : HUGE_VAL;
  return jump < t - near ? fmin(jump, inputs) : fmin(inputs, t);
}

/* Time up to which a part of a step of h resolves forces by table, at most `end`. */
static double next_row(const ali3_instance *in, double h, double end) {
  const double resolved = ali3_tables_resolved_step(in, h), row = in->clock.now + resolved;
  return resolved < h && row < end - AT_END * h ? row : end;
}

/* The same for driving functions. Steps under control end at all their breaks, and parts that a step has in common with
 * its halves would not show in their difference. */
static double next_quarter(const ali3_instance *in, double h, double end, bool controlled) {
  if (controlled || in->system->size.ng == 0) return end;
  return ali3_driving_resolved(in, in->clock.now, end, AT_END * h, ali3_method_order(in) <= 2);
}

bool ali3_is_divided(const ali3_instance *in, double t, double h) {
  double driving;
  const double jump = next_jump(in, t, h, &driving);
  return jump < t || driving < HUGE_VAL || next_quarter(in, h, next_row(in, h, t), false) < t;
}

/* Makes a step, or the rest of one, in parts. Parts that resolve tables or driving functions share the limit of
 * iterations with those after them, others have one each. */
static ali3_status advance_from(ali3_instance *in, const ali3_request *request) {
  const double t = request->t, h = request->h;
  double driving;
  ali3_request part = *request, rest = *request;
  ali3_events_begin(in, request->depth);
  const double jump = next_jump(in, t, h, &driving), row = next_row(in, h, jump),
               quarter = next_quarter(in, h, row, request->controlled);
  const bool resolves = quarter < jump && ali3_divides_to_resolve(in, request, quarter == row);
  const double piece_end = resolves ? quarter : jump;
  if (resolves) driving = HUGE_VAL;
  if (piece_end == t && driving == HUGE_VAL) return advance_part(in, &part);
  ali3_back_up(in);
  if (piece_end < t && !resolves) in->report.divisions++;
  part.t = fmin(piece_end, driving - ROUND_OFF * fabs(driving));
  if (piece_end < t) part.h = piece_end - in->clock.now;
  if (resolves) part.iterations_end -= (request->iterations_end - in->report.iterations) / 2;
  if (driving < HUGE_VAL) part.reading = ALI3_READ_ALL; /* driving_jump needs all of the state before it */
  ali3_status status = advance_part(in, &part);
  if (status == ALI3_OK) status = driving < HUGE_VAL ? driving_jump(in, fmax(piece_end, driving)) : ALI3_OK;
  in->bound.iterations_before = in->report.iterations;
  rest.h = t - piece_end;
  if (!resolves) rest.iterations_end = in->report.iterations + in->settings.step_iterations;
  return status == ALI3_OK && piece_end < t ? advance_from(in, &rest) : status;
}

ali3_status ali3_advance(ali3_instance *in, const ali3_request *request) {
  ali3_request step = *request;
  step.iterations_end = in->report.iterations + in->settings.step_iterations;
  return advance_from(in, &step);
}
