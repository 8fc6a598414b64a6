/* Radau IIA with three stages (Hairer, Wanner, "Solving Ordinary Differential Equations II", second edition, IV.5 and
 * VII.4 to 8) on the equations of index three: each stage has accelerations a_i and multipliers lam_i,
 *   M a_i + Phi_q' lam_i = Q,  Phi = 0  at  v_i = v + h A_ij a_j,  q_i = q + c_i h v + h^2 (A^2)_ij a_j,
 * the last one is the end of the step, where velocities and accelerations are projected onto the rows. */
#include <math.h>
#include <string.h>

#include "../algebra/finite.h"
#include "../algebra/fronts.h"
#include "../flexible/bodies.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../method.h"
#include "../rows/constraints.h"
#include "../rows/driving_functions.h"
#include "../state/inputs.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "check_method.h"
#include "energy_balance.h"
#include "history.h"
#include "newton.h"
#include "predict.h"
#include "projection.h"
#include "radau.h"
#include "steps.h"

enum { SWEEPS = 3 };
static const double VELOCITY_TOLERANCE = 1e-12, ACCELERATION_TOLERANCE = 1e-12;
static const double EPS_FACTOR = 1e-3; /* of eps_rel: penalty for rows nearly redundant at singular positions */
static const double MAX_RATIO = 2.0; /* steps: range of extrapolation of the last collocation polynomial */

/* Predicts the stages by the collocation polynomial of the last step, or by the state; returns whether by the
 * former. */
static bool predict(ali3_instance *in, double h) {
  const double *time = in->now.history + ALI3_HISTORY_TIME;
  const bool extrapolated = -time[LAST] > 0.0 && (1.0 - node[0]) * h <= MAX_RATIO * -time[LAST];
  for (int i = 0; i < STAGES; i++)
    ali3_history_predict(in, node[i] * h, extrapolated ? STAGES : 1, stage_acceleration(in, i),
                         stage_rows(in, in->radau.lam, i));
  return extrapolated;
}

/* Stores the stages for the prediction of the next step, newest first. */
static void store_stages(ali3_instance *in, double h) {
  const size_t nq = (size_t)in->system->size.nq, nc = (size_t)in->system->size.nc;
  ali3_vectors *to = &in->next;
  memset(to->history, 0, ALI3_HISTORY * sizeof(double));
  memset(to->past_a, 0, ALI3_PAST * nq * sizeof(double));
  memset(to->past_lam, 0, ALI3_PAST * nc * sizeof(double));
  memcpy(to->own, in->now.own, nq * sizeof(double));
  to->history[ALI3_HISTORY_OWNER] = ALI3_METHOD_RADAU_5;
  to->history[ALI3_HISTORY_COUNT] = STAGES;
  for (int i = 0; i < STAGES; i++) {
    const int index = LAST - i;
    to->history[ALI3_HISTORY_TIME + index] = (node[i] - 1.0) * h;
    memcpy(to->past_a + (size_t)index * nq, stage_acceleration(in, i), nq * sizeof(double));
    memcpy(to->past_lam + (size_t)index * nc, stage_rows(in, in->radau.lam, i), nc * sizeof(double));
  }
}

/* Projects velocities and accelerations at the end onto the rows, in the metric of the mass: errors of the stages are
 * multipliers, which change velocities along M^-1 Phi_q', and a projection along these directions removes only them. */
static ali3_status project(ali3_instance *in, double h, double alpha) {
  const ali3_system *S = in->system;
  const double weight = h * h * alpha;
  ali3_vectors *v = &in->next;
  const size_t entries = (size_t)S->size.nnz_rows * sizeof(double);
  memcpy(in->tangent.J, stage_entries(in, in->radau.J, LAST), entries);
  memcpy(in->tangent.J_made, in->tangent.J, entries);
  if (in->settings.project) {
    ali3_mass_to_fronts(in, in->tangent.F);
    if (S->n_flexible > 0) ali3_bodies_tangent(in, 1.0, 0.0, 0.0, in->tangent.F);
    ali3_rows_square(in, in->tangent.J, weight, in->tangent.F);
    const ali3_status status = ali3_factorise(in, in->tangent.F);
    if (status != ALI3_OK) return status;
  }
  const int32_t sweeps = in->settings.project ? SWEEPS : 0;
  ali3_constraint_rate(in, v->q, v, in->step.Phit);
  in->report.velocity_violation =
      ali3_project(in, weight, in->step.Phit, v->qd, NULL, VELOCITY_TOLERANCE, 0.0, sweeps, false);
  ali3_constraint_gamma(in, v->q, v->qd, v, in->step.gamma);
  ali3_project(in, weight, in->step.gamma, v->qdd, v->lam, ACCELERATION_TOLERANCE, 0.0, sweeps, false);
  return ALI3_OK;
}

/* Stores the inputs at all stages. */
static ali3_status stage_inputs(ali3_instance *in) {
  const int32_t nu = in->system->size.nu;
  ali3_status status = ALI3_OK;
  for (int i = 0; i < STAGES && status == ALI3_OK; i++) {
    status = ali3_inputs_at(in, node[i]);
    memcpy(in->inputs.stage + (int64_t)i * nu, in->inputs.middle, (size_t)nu * sizeof(double));
  }
  return status;
}

/* Work of driven rows: the force of each stage times its own velocity, which may violate the rows. Leaves the last
 * stage set. */
static double work_of_drives(ali3_instance *in, double t, double h) {
  const ali3_system *S = in->system;
  double work = 0.0;
  for (int i = 0; i < STAGES; i++) {
    const double *lam = stage_rows(in, in->radau.lam, i);
    ali3_radau_set_stage(in, t, h, i);
    ali3_rows_times(S, stage_entries(in, in->radau.J, i), in->next.qd, in->step.mu);
    for (int32_t k = 0; k < S->n_driven; k++)
      work -= h * A[LAST][i] * lam[S->driven_row[k]] * in->step.mu[S->driven_row[k]];
  }
  in->inputs.forces = in->inputs.set;
  return work;
}

/* Makes a step from in->now to in->next; in->now changes only if it succeeds. */
static ali3_status step(ali3_instance *in, const ali3_request *request) {
  const double t = request->t, h = request->h;
  const ali3_system *S = in->system;
  const size_t nq = (size_t)S->size.nq;
  const int64_t before = in->report.iterations;
  const double alpha = ali3_penalty(in, h) / EPS_FACTOR;
  ali3_vectors *from = &in->now, *to = &in->next;
  ali3_history_own(in, ALI3_METHOD_RADAU_5, from->qdd);
  ali3_status status = stage_inputs(in);
  if (status != ALI3_OK) return status;
  status = ali3_radau_newton(in, t, h, alpha, predict(in, h));
  in->inputs.forces = in->inputs.set;
  ali3_iterations_since(in, before);
  if (status != ALI3_OK) return status;
  memcpy(to->used, in->inputs.set, (size_t)S->size.nu * sizeof(double));
  if (S->n_driving_work > 0) ali3_driving_work(in, to, work_of_drives(in, t, h));
  memcpy(to->qdd, stage_acceleration(in, LAST), nq * sizeof(double));
  memcpy(to->lam, stage_rows(in, in->radau.lam, LAST), (size_t)S->size.nc * sizeof(double));
  for (int i = 0; i < STAGES; i++) ali3_work_stage(in, h * A[LAST][i], stage_power(in, i), to->work);
  ali3_work_store(in, to);
  ali3_radau_remove_redundant(in, h, alpha);
  store_stages(in, h);
  status = project(in, h, alpha);
  if (status != ALI3_OK) return status;
  for (int32_t i = 0; i < S->size.nq; i++) in->step.D[i] = to->q[i] - from->q[i];
  ali3_predict_rates(in, h);
  to->h_last[0] = 0.0;
  return ali3_accept(in);
}

/* The tangent of the stages does not include rates of rows. */
static ali3_status check_system(const ali3_instance *in) {
  return in->system->n_velocity_row + in->system->n_lookup > 0 ? ALI3_WRONG_METHOD : ali3_needs_no_states(in);
}

const ali3_method ali3_method_radau_5 = {.step = step,
                                         .motion = ali3_balance_long_step,
                                         .has_driving_work = ali3_always,
                                         .check_system = check_system,
                                         .excludes = ALI3_STATES_IN_WORDS
                                         ", no lookup-table bodies, and no rolling without slip",
                                         .owner = ALI3_METHOD_RADAU_5,
                                         .round_off = ALI3_ROUND_OFF_INDEX_1};
