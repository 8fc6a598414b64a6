/* Dense output: the state at any time within a controlled step. Positions, velocities and accelerations at its start,
 * centre and end give a polynomial of degree eight (Hermite interpolation); accelerations, multipliers and outputs of
 * elements follow from the equations of index one. If these accelerations show an error above the tolerance, or with
 * element states, filtered driving functions or sensed work, a step of the method is made to that time and
 * discarded. */
#include <math.h>
#include <string.h>

#include "../instance.h"
#include "../method.h"
#include "../rows/driving_functions.h"
#include "../sensors/sensors.h"
#include "../start/index_one.h"
#include "../state/inputs.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "../system/state_coordinates.h"
#include "energy_balance.h"
#include "error_control.h"

enum { NODES = 3, TERMS = 3 * NODES };
/* Hermite basis of a step, x = -1 to 1: contribution of q, dq/dx, d2q/dx2 at x = -1, 0, 1 to the coefficient of x^k. */
static const double basis[TERMS][TERMS] = {
    {0.0, 0.0, 0.0, -35.0 / 16, 3.0, 21.0 / 8, -4.0, -15.0 / 16, 1.5},
    {0.0, 0.0, 0.0, -11.0 / 16, 13.0 / 16, 9.0 / 8, -11.0 / 8, -7.0 / 16, 9.0 / 16},
    {0.0, 0.0, 0.0, -1.0 / 16, 1.0 / 16, 1.0 / 8, -1.0 / 8, -1.0 / 16, 1.0 / 16},
    {1.0, 0.0, 0.0, 0.0, -6.0, 0.0, 8.0, 0.0, -3.0},
    {0.0, 1.0, 0.0, -3.0, 0.0, 3.0, 0.0, -1.0, 0.0},
    {0.0, 0.0, 0.5, 0.0, -1.5, 0.0, 1.5, 0.0, -0.5},
    {0.0, 0.0, 0.0, 35.0 / 16, 3.0, -21.0 / 8, -4.0, 15.0 / 16, 1.5},
    {0.0, 0.0, 0.0, -11.0 / 16, -13.0 / 16, 9.0 / 8, 11.0 / 8, -7.0 / 16, -9.0 / 16},
    {0.0, 0.0, 0.0, 1.0 / 16, 1.0 / 16, -1.0 / 8, -1.0 / 8, 1.0 / 16, 1.0 / 16},
};
/* Error bounds: positions POSITION_FACTOR h^2, velocities VELOCITY_FACTOR h, times the defect of the accelerations. */
static const double POSITION_FACTOR = 0.01, VELOCITY_FACTOR = 0.05;
static const double END_FRACTION = 1e-6; /* of the step; closer to its end the end state is used */
static const double MIN_FRACTION = 1e-3; /* of the step; in a shorter one round-off would dominate the forces */

/* Factor of the derivative of x^k: k (k - 1) ... with `order` factors, order 0 to 2. */
static double falling_factorial(int k, int order) {
  if (order == 0) return 1.0;
  return order == 1 ? k : (double)k * (k - 1);
}

/* Weights of the nine vectors in the polynomial (order 0) or its first or second derivative with respect to x. */
static void evaluate_basis(double x, int order, double weight[TERMS]) {
  for (int j = 0; j < TERMS; j++) {
    double sum = 0.0;
    for (int k = TERMS - 1; k >= order; k--) sum = sum * x + falling_factorial(k, order) * basis[j][k];
    weight[j] = sum;
  }
}

void ali3_interpolate(const ali3_instance *in, double h, double x, ali3_vectors *result) {
  const ali3_vectors *node[NODES] = {&in->stored.origin, &in->stored.centre, &in->now};
  const double scale[3] = {1.0, 0.5 * h, 0.25 * h * h}; /* of a derivative with respect to x */
  double *out[3] = {result->q, result->qd, result->qdd}, weight[TERMS];
  for (int order = 0; order < 3; order++) {
    evaluate_basis(x, order, weight);
    for (int32_t i = 0; i < in->system->size.nq; i++) {
      double sum = 0.0;
      for (int n = 0; n < NODES; n++)
        sum += weight[3 * n] * node[n]->q[i] + scale[1] * weight[3 * n + 1] * node[n]->qd[i] +
               scale[2] * weight[3 * n + 2] * node[n]->qdd[i];
      out[order][i] = sum / scale[order];
    }
  }
}

/* Computes in->next from the polynomial and the equations of index one; false: the equations failed, or the error
 * exceeds the tolerance. */
static bool evaluate_polynomial(ali3_instance *in, const ali3_measure *measure, double t, double h, double time) {
  const int32_t nq = in->system->size.nq;
  const double x = 2.0 * (time - t) / h - 1.0;
  ali3_vectors *state = &in->next;
  ali3_vectors_copy(in, state, x < 0.0 ? &in->stored.centre : &in->now);
  ali3_interpolate(in, h, x, state);
  /* scratch: D interpolated accelerations, w and r errors of positions and velocities */
  memcpy(in->step.D, state->qdd, (size_t)nq * sizeof(double));
  ali3_driving_time(in, state, time);
  in->clock.now = time;
  ali3_status status = ali3_inputs_begin(in, time, 0.0);
  if (status == ALI3_OK) status = ali3_index_one(in, state);
  in->report.iterations--; /* undoes the count of ali3_index_one, as output is not an iteration */
  if (status != ALI3_OK) return false;
  for (int32_t i = 0; i < nq; i++) {
    const double defect = state->qdd[i] - in->step.D[i];
    in->step.w[i] = POSITION_FACTOR * h * h * defect;
    in->step.r[i] = VELOCITY_FACTOR * h * defect;
  }
  return ali3_distance(in, measure, in->step.w, in->step.r, ali3_rate(in, measure, false)) <=
         measure->control->tolerance;
}

/* Only with element states, filtered driving functions or sensed work: computes in->next close to the start from the
 * polynomial, with the forces and states of the start. */
static void evaluate_near_start(ali3_instance *in, double t, double h, double time) {
  ali3_vectors_copy(in, &in->next, &in->stored.origin);
  ali3_interpolate(in, h, 2.0 * (time - t) / h - 1.0, &in->next);
  ali3_driving_time(in, &in->next, time);
  ali3_work_extrapolated(in, time - t);
}

/* Computes in->next by a step of the method from the start or the centre; in->now is saved in in->stored.coarse
 * meanwhile. */
static ali3_status step_to_time(ali3_instance *in, double t, double h, double time) {
  const ali3_report before = in->report;
  const double centre = t + 0.5 * h;
  const bool second = time > centre + MIN_FRACTION * h;
  const double start = second ? centre : t;
  ali3_vectors_copy(in, &in->stored.coarse, &in->now);
  ali3_vectors_copy(in, &in->now, second ? &in->stored.centre : &in->stored.origin);
  const ali3_status status = ali3_trial_step(in, start, time - start, ALI3_READ_ALL);
  if (status == ALI3_OK) ali3_vectors_copy(in, &in->next, &in->now);
  ali3_vectors_copy(in, &in->now, &in->stored.coarse);
  ali3_balance_restore(&in->report, &before);
  return status;
}

/* Sensors and coordinates of in->now; NULL: not wanted. */
static void write_outputs(ali3_instance *in, double *out, double *positions) {
  if (out != NULL) ali3_sensors_evaluate(in, out);
  if (positions != NULL) memcpy(positions, in->now.q, (size_t)in->system->size.nq * sizeof(double));
}

ali3_status ali3_dense_output(ali3_instance *in, const ali3_measure *measure, double t, double h, double time,
                              double *out, double *positions) {
  const bool relative = ali3_method_of(in)->relative;
  const bool at_end = time >= t + h - END_FRACTION * h;
  const bool has_work = in->system->n_work + in->system->n_driving_work > 0; /* work is known at the ends of steps */
  const bool smooth = ali3_states_are_coordinates(in->system) && (at_end || !has_work);
  if (at_end && !relative) {
    write_outputs(in, out, positions);
    return ALI3_OK;
  }
  if (!smooth && time < t + MIN_FRACTION * h) {
    evaluate_near_start(in, t, h, time);
  } else if (!smooth || !evaluate_polynomial(in, measure, t, h, at_end ? t + h : time)) {
    const ali3_status status = step_to_time(in, t, h, time);
    measure->control->side_steps++; /* a step made only for output */
    if (status != ALI3_OK) return status;
  }
  const ali3_vectors end = in->now;
  in->now = in->next; /* which sensors read */
  write_outputs(in, out, positions);
  in->next = in->now;
  in->now = end;
  memcpy(in->inputs.set, end.used, (size_t)in->system->size.nu * sizeof(double));
  return ALI3_OK;
}
