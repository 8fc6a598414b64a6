/* Accuracy measures of a run, without influence on its steps: energy balance, change of velocities, and its error by
 * the simplest prediction. */
#include <math.h>

#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../flexible/bodies.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "abrupt_force.h"
#include "energy_balance.h"

/* Potential energy of v, J; flexible bodies are prepared at its position. `weight`: the energy of gravity, J, NULL: not
 * computed yet. */
static double potential(const ali3_instance *in, const ali3_vectors *v, const double *weight) {
  const ali3_system *S = in->system;
  double gravity = in->mass.gravity_const, elastic = 0.0;
  if (weight == NULL) {
    ali3_bodies_energy(in, v->q, &gravity, &elastic);
    for (int32_t i = 0; i < S->size.nq; i++) gravity -= in->mass.gravity[i] * v->q[i];
  } else {
    gravity = *weight;
  }
  for (int32_t e = 0; e < S->size.ne; e++) elastic += v->potential[e];
  return gravity + elastic;
}

/* Records the energies of a state, J. */
static void kinetic_energy(ali3_report *r, double kinetic, double energy) {
  if (kinetic > r->kinetic_peak) r->kinetic_peak = kinetic;
  r->energy = energy;
}

double ali3_kinetic_energy(ali3_instance *in) {
  ali3_bodies_prepare(in, in->now.q);
  return 0.5 * ali3_mass_product(in, in->now.qd, in->now.qd, in->step.w);
}

double ali3_energy(ali3_instance *in) {
  const double kinetic = ali3_kinetic_energy(in);
  if (kinetic > in->report.kinetic_peak) in->report.kinetic_peak = kinetic;
  return kinetic + potential(in, &in->now, NULL);
}

void ali3_balance_start(ali3_instance *in, bool balanced) {
  in->report.open_power = in->report.energy_floor = 0.0;
  if (!balanced) return;
  const double kinetic = ali3_kinetic_energy(in);
  double rest = 0.0;
  for (int32_t i = 0; i < in->system->size.nq; i++) rest += 0.5 * ALI3_REST_SPEED * ALI3_REST_SPEED * in->mass.floor[i];
  for (int32_t i = 0; i < in->system->size.nq; i++)
    in->report.energy_floor += in->system->fine * in->settings.tolerance_r * fabs(in->mass.gravity[i]);
  in->report.kinetic_peak = fmax(in->report.kinetic_peak, rest);
  kinetic_energy(&in->report, kinetic, kinetic + potential(in, &in->now, NULL));
}

void ali3_balance_energy(ali3_instance *in, double error, double kinetic, const double *weight) {
  ali3_report *r = &in->report;
  const double energy = kinetic + potential(in, &in->next, weight);
  r->energy_error += error;
  r->work += fabs(energy - r->energy - error);
  kinetic_energy(r, kinetic, energy);
}

void ali3_balance_motion(ali3_instance *in, double speed, double change, double miss) {
  ali3_report *report = &in->report;
  report->speed_peak = fmax(report->speed_peak, sqrt(speed));
  report->velocity_path += sqrt(change);
  report->predictor_path += sqrt(miss);
  report->velocity_squares += change;
  report->predictor_squares += miss;
  if (in->system->n_contact > 0) ali3_abrupt_force(in);
}

/* Sums over coordinates, weighted by m: of v1^2, of d^2 with d = v1 - v0, and of (d - h a)^2. */
ALI3_INLINED void balance_squares(const ali3_instance *in, double h, const double *v0, const double *a,
                                  const double *v1, double out[3]) {
  const double *m = in->mass.floor;
  const int32_t nq = in->system->size.nq;
  ali3_double4 speed = {0}, change = {0}, miss = {0};
  int32_t i = 0;
  ALI3_SHORT
  for (; i + 3 < nq; i += 4) {
    const ali3_double4 w = *(const ali3_double4 *)(m + i), v = *(const ali3_double4 *)(v1 + i);
    const ali3_double4 d = v - *(const ali3_double4 *)(v0 + i), e = d - h * *(const ali3_double4 *)(a + i);
    speed += w * v * v;
    change += w * d * d;
    miss += w * e * e;
  }
  out[0] = (speed[0] + speed[1]) + (speed[2] + speed[3]);
  out[1] = (change[0] + change[1]) + (change[2] + change[3]);
  out[2] = (miss[0] + miss[1]) + (miss[2] + miss[3]);
  ALI3_SHORT
  for (; i < nq; i++) {
    const double d = v1[i] - v0[i], e = d - h * a[i];
    out[0] += m[i] * v1[i] * v1[i];
    out[1] += m[i] * d * d;
    out[2] += m[i] * e * e;
  }
}

ALI3_BY_PROCESSOR(in->system, void, balance_squares,
                  (const ali3_instance *in, double h, const double *v0, const double *a, const double *v1,
                   double out[3]),
                  (in, h, v0, a, v1, out))

void ali3_balance_change(ali3_instance *in, double h, const double *v0, const double *a, const double *v1) {
  double square[3];
  ali3_balance_squares(in, h, v0, a, v1, square);
  ali3_balance_motion(in, square[0], square[1], square[2]);
}

void ali3_balance_step(ali3_instance *in, double h) {
  ali3_balance_change(in, h, in->next.qd, in->next.qdd, in->now.qd);
}

/* Adds a step that may be longer than impacts, with the accelerations of the end with the larger error, as those at the
 * start fit a step that begins deep in a contact, or grazes one. */
void ali3_balance_long_step(ali3_instance *in, double h) {
  double square[3], back[3];
  balance_squares(in, h, in->next.qd, in->next.qdd, in->now.qd, square);
  balance_squares(in, h, in->next.qd, in->now.qdd, in->now.qd, back);
  ali3_balance_motion(in, square[0], square[1], fmax(square[2], back[2]));
}

void ali3_balance_restore(ali3_report *report, const ali3_report *before) {
  report->energy_error = before->energy_error;
  report->open_power = before->open_power;
  report->energy = before->energy;
  report->work = before->work;
  report->kinetic_peak = before->kinetic_peak;
  report->speed_peak = before->speed_peak;
  report->velocity_path = before->velocity_path;
  report->predictor_path = before->predictor_path;
  report->velocity_squares = before->velocity_squares;
  report->predictor_squares = before->predictor_squares;
  report->largest_force = before->largest_force;
  report->abrupt_steps = before->abrupt_steps;
  report->divisions = before->divisions;
  report->change_rate = before->change_rate;
  report->largest_load = before->largest_load;
}
