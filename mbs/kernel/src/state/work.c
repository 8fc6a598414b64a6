/* Work of force elements on the mechanism, of the elements named by work sensors, by the quadrature of the method
 * itself, so that the total work equals the change of energy except for the error of the method.
 *
 * Trapezoidal rule: D'(f0 + f1)/2 with the forces of the converged Newton iteration. Energy-momentum: D'f of the
 * middle, where f is a discrete gradient. Runge-Kutta and collocation: sum of h b_i P_i over the stages.
 *
 * The work of driving functions is stored after the work of the elements: with ALi3-P and generalised-alpha from the
 * energy balance (../methods/constraint_work.c), with energy-momentum and Radau from the forces of driven rows along
 * their driving functions, with Runge-Kutta from the powers of the stages, and in relative coordinates as the mean of
 * the powers at both ends. */
#include <string.h>

#include "../algebra/number_pairs.h"
#include "../elements/forces.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "work.h"

static void copy(double *to, const double *from, int32_t n) {
  if (n > 0) memcpy(to, from, (size_t)n * sizeof(double));
}

void ali3_work_store(const ali3_instance *in, ali3_vectors *v) {
  copy(v->watched, in->watch.now, in->system->n_work + in->system->n_work_force);
}

double ali3_driving_power(ali3_instance *in, const ali3_vectors *v) {
  double power = 0.0;
  ali3_constraint_rate(in, v->q, v, in->step.mu);
  for (int32_t k = 0; k < in->system->size.nc; k++) power += v->lam[k] * in->step.mu[k];
  return power;
}

void ali3_driving_work(const ali3_instance *in, ali3_vectors *v, double work) {
  if (in->system->n_driving_work > 0) v->work[in->system->n_work] += work;
}

void ali3_work_start(const ali3_instance *in, ali3_vectors *v) {
  const ali3_system *S = in->system;
  if (S->n_driving_work > 0) v->work[S->n_work] = 0.0;
  for (int32_t k = 0; k < S->n_work; k++) {
    v->work[k] = 0.0;
    v->stored[k] = v->potential[S->work_element[k]];
  }
  if (S->n_input_work > 0) memset(v->by_inputs, 0, (size_t)S->n_input_work * sizeof(double));
}

/* Evaluates the forces and potentials at a state. */
static void evaluate_forces(ali3_instance *in, const ali3_vectors *v, double *potential) {
  const ali3_force_call call = {.q = v->q,
                                .qd = v->qd,
                                .y_old = v->y,
                                .Q = in->step.Q,
                                .y_new = in->element.y,
                                .out = in->element.out,
                                .potential = potential};
  ali3_forces(in, &call);
}

void ali3_work_reopen(ali3_instance *in) {
  ali3_vectors *v = &in->now;
  if (in->system->n_work == 0) return;
  in->inputs.forces = v->used;
  evaluate_forces(in, v, in->element.potential);
  in->inputs.forces = in->inputs.set;
  ali3_work_store(in, v);
}

void ali3_work_step(ali3_instance *in, double weight) {
  if (in->system->n_work == 0) return;
  ali3_signal_displacements(in, in->next.step_displacement);
  ali3_work_along(in, weight);
}

/* Leaves the powers of the start unchanged: a method that reads them stores its own or calls ali3_work_reopen. */
void ali3_work_along(ali3_instance *in, double weight) {
  const ali3_system *S = in->system;
  const double *before = in->now.watched + S->n_work, *displacement = in->next.step_displacement;
  double *mean = in->next.step_force, *after = in->next.watched + S->n_work;
  for (int32_t k = 0; k < S->n_work; k++) {
    const double *force = in->element.force + S->el_sig_ptr[S->work_element[k]];
    const int32_t n = S->work_ptr[k + 1] - S->work_ptr[k];
    ALI3_EACH(0, n, ALI3_AT(after) = ALI3_AT(force);
              ALI3_AT(mean) = weight * ALI3_AT(force) + (1.0 - weight) * ALI3_AT(before))
    in->next.work[k] = in->now.work[k] + ali3_product_backward(mean, displacement, n);
    before += n, displacement += n, mean += n, after += n;
  }
}

void ali3_work_stage(const ali3_instance *in, double weight, const double *power, double *sum) {
  for (int32_t k = 0; k < in->system->n_work; k++) sum[k] += weight * power[k];
}

void ali3_work_recall(ali3_instance *in) { copy(in->watch.now, in->now.watched, in->system->n_work); }

void ali3_work_first(ali3_instance *in, double weight) {
  for (int32_t k = 0; k < in->system->n_work; k++) in->watch.sum[k] = weight * in->watch.now[k];
}

void ali3_work_extrapolated(ali3_instance *in, double dt) {
  ali3_vectors *v = &in->next;
  if (in->system->n_driving_work > 0) ali3_driving_work(in, v, dt * ali3_driving_power(in, v));
  if (in->system->n_work == 0) return;
  evaluate_forces(in, v, v->potential);
  ali3_work_stage(in, dt, in->watch.now, v->work);
}

void ali3_work_of_inputs(ali3_instance *in, const double *before, const double *after_jump) {
  const ali3_system *S = in->system;
  for (int32_t k = 0; k < S->n_input_work; k++) {
    in->now.by_inputs[k] += after_jump[S->work_element[k]] - before[S->work_element[k]];
    in->next.by_inputs[k] = in->now.by_inputs[k];
  }
}

double ali3_work_sum(const ali3_instance *in, int32_t kind, int32_t n, const int32_t *element) {
  double sum = 0.0;
  for (int32_t i = 0; i < n; i++) {
    const int32_t e = element[i], k = in->system->work_of[e];
    const double by_inputs = k < in->system->n_input_work ? in->now.by_inputs[k] : 0.0;
    if (kind < 2) sum += in->now.work[k];
    if (kind == 1) sum += in->now.potential[e] - in->now.stored[k] - by_inputs;
    if (kind == 2) sum += by_inputs;
  }
  return sum;
}
