/* Explicit Runge-Kutta method of order eight with twelve stages (coefficients of Dormand and Prince, in Hairer,
 * Norsett, Wanner, "Solving Ordinary Differential Equations I", second edition) on the equations of index one: each
 * stage solves for accelerations and multipliers, positions and velocities are projected onto the rows at the end of a
 * step. For smooth motion without stiff forces, away from singular positions; the last stage of a step is the first of
 * the next. */
#include <math.h>
#include <string.h>

#include "../algebra/fronts.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../method.h"
#include "../rows/constraints.h"
#include "../rows/driving_functions.h"
#include "../rows/violation.h"
#include "../start/index_one.h"
#include "../state/inputs.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "check_method.h"
#include "energy_balance.h"
#include "energy_watch.h"
#include "newton.h"
#include "predict.h"
#include "projection.h"
#include "steps.h"
#include "tableau.h"

enum { STAGES = ALI3_STAGES, SWEEPS = 3 };
static const double ALPHA = ALI3_INDEX_ONE_PENALTY;
static const double VELOCITY_TOLERANCE = 1e-12;

/* Power of the forces in in->step.Q and of drives at the state that was solved last, W. */
static double force_power(ali3_instance *in, const ali3_vectors *v) {
  double sum = 0.0;
  ali3_constraint_rate(in, v->q, v, in->step.Phit);
  for (int32_t i = 0; i < in->system->size.nq; i++) sum += v->qd[i] * in->step.Q[i];
  for (int32_t k = 0; k < in->system->size.nc; k++) sum += v->lam[k] * in->step.Phit[k];
  return sum;
}

/* Sets positions and velocities of a stage from the accelerations of the `stages` before it. `weights`: weights of the
 * stage; `second`: those of the double integral. */
static void combine(ali3_instance *in, double h, double time, const double *weights, int stages) {
  const int32_t nq = in->system->size.nq;
  double second[STAGES] = {0.0};
  for (int i = 0; i < stages; i++)
    for (int j = 0; j < i; j++) second[j] += weights[i] * ali3_tableau_8.a[i][j];
  for (int32_t i = 0; i < nq; i++) {
    in->next.qd[i] = 0.0;
    in->next.q[i] = 0.0;
  }
  for (int j = 0; j < stages; j++) {
    const double *restrict a = in->step.stage + (int64_t)j * nq, weight = weights[j], second_weight = second[j];
    if (weight == 0.0 && second_weight == 0.0) continue;
    for (int32_t i = 0; i < nq; i++) {
      in->next.qd[i] += weight * a[i];
      in->next.q[i] += second_weight * a[i];
    }
  }
  for (int32_t i = 0; i < nq; i++) {
    in->next.q[i] = in->now.q[i] + h * (time * in->now.qd[i] + h * in->next.q[i]);
    in->next.qd[i] = in->now.qd[i] + h * in->next.qd[i];
  }
}

/* Projects onto Phi = 0 and Phi_q qd + Phi_t = 0 with the tangent of the last stage, which is at the end of the step
 * too. */
static ali3_status project(ali3_instance *in) {
  const ali3_system *S = in->system;
  ali3_vectors *v = &in->next;
  memcpy(in->tangent.J_made, in->tangent.J, (size_t)S->size.nnz_rows * sizeof(double));
  for (int sweep = 0;; sweep++) {
    ali3_constraints(in, v->q, v->s, in->step.Phi, in->tangent.J);
    in->report.violation = ali3_violation(S, in->step.Phi, &in->report.worst_row);
    if (ali3_closed(S, in->step.Phi, S->fine * in->settings.tolerance_phi)) break;
    if (!(in->report.violation < 1e300)) return ALI3_NOT_FINITE;
    if (sweep == in->settings.max_iterations) return ALI3_NOT_CONVERGED;
    for (int32_t k = 0; k < S->size.nc; k++) in->step.mu[k] = ALPHA * in->step.Phi[k];
    ali3_rows_transposed(S, in->tangent.J_made, in->step.mu, in->step.x);
    ali3_solve(in, in->tangent.F, in->step.x);
    for (int32_t i = 0; i < S->size.nq; i++) v->q[i] -= in->step.x[i];
  }
  ali3_constraint_rate(in, v->q, v, in->step.Phit);
  in->report.velocity_violation =
      ali3_project(in, ALPHA, in->step.Phit, v->qd, NULL, VELOCITY_TOLERANCE, 0.0, SWEEPS, false);
  return ALI3_OK;
}

/* Sets accelerations and multipliers of in->next, a copy of in->now, to those after a jump of inputs at the start of
 * the step: then its first stage is not the last one of the step before. */
static ali3_status accelerations_after_jump(ali3_instance *in) {
  if (!ali3_inputs_jump(in)) return ALI3_OK;
  const ali3_status status = ali3_inputs_at(in, 0.0);
  if (status != ALI3_OK) return status;
  const ali3_status solved = ali3_index_one(in, &in->next);
  ali3_work_store(in, &in->next);
  return solved;
}

/* Makes a step from in->now to in->next, a copy of it; in->now changes only if it succeeds. */
static ali3_status step(ali3_instance *in, const ali3_request *request) {
  const double t = request->t, h = request->h;
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  const int64_t before = in->report.iterations;
  ali3_vectors *from = &in->now, *to = &in->next;
  in->inputs.forces = in->inputs.middle;
  ali3_status status = accelerations_after_jump(in);
  memcpy(in->step.stage, to->qdd, (size_t)nq * sizeof(double));
  memcpy(to->used, in->inputs.set, (size_t)S->size.nu * sizeof(double));
  const bool has_energy_check = S->n_flexible + S->n_lookup == 0; /* else in->step.Q has inertia forces too */
  const double kinetic = has_energy_check ? 0.5 * ali3_mass_product(in, from->qd, from->qd, in->step.r) : 0.0;
  double work =
      has_energy_check ? h * ali3_tableau_8.b[0] * ali3_mass_product(in, from->qd, in->step.stage, in->step.r) : 0.0;
  ali3_work_stage(in, h * ali3_tableau_8.b[0], to->watched, to->work);
  const bool driving = S->n_driving_work > 0;
  double driving_work = driving ? h * ali3_tableau_8.b[0] * ali3_driving_power(in, to) : 0.0;
  for (int stage = 1; stage < STAGES && status == ALI3_OK; stage++) {
    combine(in, h, ali3_tableau_8.c[stage], ali3_tableau_8.a[stage], stage);
    ali3_driving_time(in, to, t - (1.0 - ali3_tableau_8.c[stage]) * h);
    status = ali3_inputs_at(in, ali3_tableau_8.c[stage]);
    if (status != ALI3_OK) break;
    status = ali3_index_one(in, to);
    ali3_work_stage(in, h * ali3_tableau_8.b[stage], in->watch.now, to->work);
    if (driving) driving_work += h * ali3_tableau_8.b[stage] * ali3_driving_power(in, to);
    if (has_energy_check) work += h * ali3_tableau_8.b[stage] * force_power(in, to);
    memcpy(in->step.stage + (int64_t)stage * nq, to->qdd, (size_t)nq * sizeof(double));
  }
  in->inputs.forces = in->inputs.set;
  if (status == ALI3_OK) {
    combine(in, h, 1.0, ali3_tableau_8.b, STAGES);
    ali3_driving_time(in, to, t);
    status = project(in);
  }
  if (status == ALI3_OK) status = ali3_index_one(in, to);
  ali3_work_store(in, to);
  if (status == ALI3_OK && has_energy_check) {
    const double kinetic_change = 0.5 * ali3_mass_product(in, to->qd, to->qd, in->step.r) - kinetic;
    status = ali3_energy_watch(in, request, kinetic_change - work, kinetic + fmax(kinetic_change, 0.0),
                               kinetic + kinetic_change, 0.0);
  }
  ali3_iterations_since(in, before);
  if (status != ALI3_OK) return status;
  ali3_driving_work(in, to, driving_work);
  to->history[ALI3_HISTORY_OWNER] = ALI3_METHOD_RUNGE_KUTTA_8;
  for (int32_t i = 0; i < nq; i++) in->step.D[i] = to->q[i] - from->q[i];
  ali3_predict_rates(in, h);
  to->h_last[0] = 0.0;
  return ali3_accept(in);
}

/* The energy balance needs a constant mass matrix. */
static bool has_balance(const ali3_instance *in) { return in->system->n_flexible + in->system->n_lookup == 0; }

const ali3_method ali3_method_runge_kutta_8 = {.step = step,
                                               .motion = ali3_balance_long_step,
                                               .has_balance = has_balance,
                                               .has_driving_work = ali3_always,
                                               .check_system = ali3_needs_no_states,
                                               .excludes = ALI3_STATES_IN_WORDS,
                                               .owner = ALI3_METHOD_RUNGE_KUTTA_8,
                                               .stable_rate = 5.0,
                                               .round_off = ALI3_ROUND_OFF_INDEX_1};
