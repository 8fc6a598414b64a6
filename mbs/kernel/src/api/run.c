/* The functions of ali3.h that start, step and run an instance, with the clock and the state after a failure. */
#include <math.h>
#include <string.h>

#include "../algebra/finite.h"
#include "../instance.h"
#include "../method.h"
#include "../methods/branch_watch.h"
#include "../methods/energy_balance.h"
#include "../methods/energy_watch.h"
#include "../methods/newton.h"
#include "../methods/steps.h"
#include "../methods/stiffness.h"
#include "../methods/whole_step.h"
#include "../sensors/sensors.h"
#include "../start/initialise.h"
#include "../start/settled_start.h"
#include "../start/start_on_road.h"
#include "../state/inputs.h"
#include "../state/road_files.h"
#include "../state/vectors.h"
#include "../system/loading.h"

static const double MAX_SETTLING_STEPS = 1e7;

/* Ends the computation of a start: a success starts the clock, a failure restores the state and is reported. */
static ali3_status finish_start(ali3_instance *in, ali3_status status, double t0) {
  if (ali3_roads_status(in) != ALI3_OK) status = ALI3_ROAD_LOST;
  in->report.last_status = (int32_t)status;
  if (status != ALI3_OK) {
    ali3_vectors_copy(in, &in->now, &in->stored.start);
    in->report.failures++;
    return status;
  }
  memset(in->now.history, 0, ALI3_HISTORY * sizeof(double));
  in->clock.base = t0;
  in->clock.h = 0.0;
  in->clock.count = 0;
  in->branch.known = false;
  in->start.to_lift = false;
  in->start.initialised = 1;
  ali3_balance_start(in, ali3_has_balance(in));
  ali3_energy_trend(in, ali3_has_balance(in));
  return ALI3_OK;
}

ali3_status ali3_initialise(ali3_instance *in, double t0) {
  const ali3_report empty = {0};
  if (in == NULL || !(t0 - t0 == 0.0)) return ALI3_BAD_ARGUMENT;
  for (int64_t k = 0; k < in->system->n_inertia_parameter; k += ALI3_INERTIA_REALS)
    if (!ali3_inertia_possible(in->parameters.inertia_parameter + k)) return ALI3_BAD_INERTIA;
  in->report = empty;
  in->start.unsettled = 0.0;
  ali3_roads_clear_read_errors(in);
  ali3_vectors_copy(in, &in->stored.start, &in->now);
  ali3_status status = ali3_roads_normals(in);
  if (status == ALI3_OK) status = ali3_start_in_equilibrium(in, t0);
  if (status == ALI3_OK) ali3_start_on_road(in);
  if (status == ALI3_OK) status = ali3_solve_initial(in, t0);
  if (status == ALI3_OK) {
    int32_t refusing;
    ali3_start_excess(in, &refusing, NULL);
    if (refusing >= 0) status = ALI3_START_REFUSED;
  }
  return finish_start(in, status, t0);
}

ali3_status ali3_static_equilibrium(ali3_instance *in, double t0, double tolerance, int32_t max_iterations) {
  const ali3_report empty = {0};
  if (in == NULL || !(t0 - t0 == 0.0) || !(tolerance > 0.0) || max_iterations < 1) return ALI3_BAD_ARGUMENT;
  in->report = empty;
  ali3_roads_clear_read_errors(in);
  ali3_vectors_copy(in, &in->stored.start, &in->now);
  ali3_start_on_road(in);
  return finish_start(in, ali3_solve_static(in, t0, tolerance, max_iterations), t0);
}

/* Makes a step of h, s; inputs change linearly to `end` (nu), NULL: they are constant. */
static ali3_status step(ali3_instance *in, double h, const double *end, ali3_reading reading) {
  ali3_whole_step whole;
  ali3_status status = ali3_step_begin(in, h, end, reading, &whole);
  if (status != ALI3_OK) return status;
  return ali3_step_end(in, &whole, ali3_advance(in, &whole.asked));
}

ali3_status ali3_step(ali3_instance *in, double h) {
  if (in == NULL || !(h > 0.0) || !(h <= 1e6)) return ALI3_BAD_ARGUMENT;
  const ali3_status status = ali3_check_method(in);
  in->bound.call_residual = 0.0;
  return status == ALI3_OK ? ali3_explain_refusal(in, step(in, h, NULL, ALI3_READ_ALL), h) : status;
}

ali3_status ali3_settle(ali3_instance *in, double duration, double h) {
  if (in == NULL || !(h > 0.0) || !in->system->size.has_pose) return ALI3_BAD_ARGUMENT;
  if (!(duration >= 0.0 && duration <= ALI3_LONGEST_SETTLING)) return ALI3_BAD_ARGUMENT;
  if (!in->start.initialised) return ALI3_NOT_INITIALISED;
  const double t0 = ali3_time(in), steps = ceil(duration / h * (1.0 - 1e-9));
  ali3_held_motion held_motion;
  ali3_status status = ali3_check_method(in);
  if (status != ALI3_OK || !(steps > 0.0)) return status;
  if (!(steps <= MAX_SETTLING_STEPS) || !ali3_measure_held_motion(in, &held_motion)) return ALI3_BAD_ARGUMENT;
  if (ali3_lower_to_road(in)) status = ali3_refresh(in);
  ali3_follow_slope(in, &held_motion);
  h = duration / steps;
  in->clock.base = t0 - steps * h;
  in->clock.h = 0.0;
  in->clock.count = 0;
  for (int64_t k = 0; k < (int64_t)steps && status == ALI3_OK; k++) {
    status = ali3_step(in, h);
    if (status != ALI3_OK) break;
    if (in->bound.work_left != NULL) *in->bound.work_left -= ALI3_SETTLING_WORK;
    ali3_restore_motion(in, &held_motion, ali3_velocity_factor(&held_motion, h, (double)k / steps));
    status = ali3_refresh(in);
  }
  if (status != ALI3_OK) {
    in->start.initialised = 0;
    return status;
  }
  const ali3_report empty = {0};
  in->report = empty;
  in->start.unsettled = ali3_unsettled_speed(in, &held_motion);
  in->start.uneven = 0.0; /* elements above the road have come to rest */
  ali3_vectors_copy(in, &in->stored.start, &in->now);
  status = finish_start(in, ali3_solve_rates(in, true), t0);
  in->start.initialised = status == ALI3_OK;
  return status;
}

double ali3_unsettled(const ali3_instance *in) { return in != NULL ? in->start.unsettled : 0.0; }

/* After a failed step in a run: restores the last state and completes it, as only `reading` of it was computed. */
static ali3_status restore_last(ali3_instance *in, ali3_status status, ali3_reading reading) {
  const ali3_method *method = ali3_method_of(in);
  ali3_vectors_copy(in, &in->stored.start, &in->now);
  in->inputs.forces = in->stored.start.used; /* inputs of the last state, which may differ from the present ones */
  if (reading == ALI3_READ_NOTHING && method->after_unobserved != NULL) method->after_unobserved(in);
  if (reading != ALI3_READ_ALL && method->after_sampled != NULL) method->after_sampled(in);
  in->inputs.forces = in->inputs.set;
  if (!ali3_finite(in->now.q, (int64_t)in->stored.n)) ali3_vectors_copy(in, &in->now, &in->stored.start);
  return status;
}

ali3_status ali3_run(ali3_instance *in, double h, int64_t n_steps, const double *inputs, int64_t every, double *out,
                     double *positions, int64_t *done) {
  if (done != NULL) *done = 0;
  if (in == NULL || n_steps < 0 || every < 1 || !(h > 0.0) || !(h <= 1e6)) return ALI3_BAD_ARGUMENT;
  const int32_t nu = in->system->size.nu;
  const ali3_status method = ali3_check_method(in);
  if (method != ALI3_OK) return method;
  ali3_reading last_reading = ALI3_READ_ALL; /* of the last completed step */
  in->bound.call_residual = 0.0;
  for (int64_t n = 0; n < n_steps; n++) {
    const bool is_recorded = (out != NULL || positions != NULL) && (n + 1) % every == 0;
    /* the work of driving functions and abrupt forces need the end of each step */
    const bool reads_sensors = is_recorded || in->system->n_driving_work > 0 || in->system->n_contact > 0;
    const ali3_reading reading = n + 1 == n_steps ? ALI3_READ_ALL
                                 : reads_sensors  ? ALI3_READ_SENSORS
                                                  : ALI3_READ_NOTHING;
    const ali3_status status = step(in, h, inputs != NULL ? inputs + n * nu : NULL, reading);
    if (status != ALI3_OK) return ali3_explain_refusal(in, restore_last(in, status, last_reading), h);
    last_reading = reading;
    if (done != NULL) *done = n + 1;
    if (is_recorded) ali3_record_row(in, (n + 1) / every - 1, out, positions);
  }
  return ALI3_OK;
}

ali3_status ali3_sensors(ali3_instance *in, double *out) {
  if (in == NULL || out == NULL) return ALI3_BAD_ARGUMENT;
  if (!in->start.initialised) return ALI3_NOT_INITIALISED;
  ali3_sensors_evaluate(in, out);
  return ALI3_OK;
}

ali3_status ali3_some_sensors(ali3_instance *in, int32_t n, const int32_t *number, double *out) {
  if (in == NULL || (n > 0 && (number == NULL || out == NULL))) return ALI3_BAD_ARGUMENT;
  if (!in->start.initialised) return ALI3_NOT_INITIALISED;
  for (int32_t i = 0; i < n; i++)
    if (number[i] < 0 || number[i] >= in->system->size.ns) return ALI3_BAD_ARGUMENT;
  ali3_sensors_some(in, n, number, out);
  return ALI3_OK;
}
