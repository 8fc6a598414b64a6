/* Radau IIA with three stages (Hairer, Wanner, "Solving Ordinary Differential Equations II", second edition, IV.5 and
 * VII.4 to 8) on the equations of index three: each stage has accelerations a_i and multipliers lam_i,
 *   M a_i + Phi_q' lam_i = Q,  Phi = 0  at  v_i = v + h A_ij a_j,  q_i = q + c_i h v + h^2 (A^2)_ij a_j,
 * the last one is the end of the step, where velocities and accelerations are projected onto the rows. Newton's tangent
 * is the exact one of all stages together: rows that are redundant are so in a different combination at each stage, and
 * one Phi_q for all stages would turn the multipliers of that combination into forces. */
#include <math.h>
#include <string.h>

#include "../algebra/finite.h"
#include "../algebra/fronts.h"
#include "../elements/forces.h"
#include "../elements/signals.h"
#include "../flexible/bodies.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../method.h"
#include "../rows/constraints.h"
#include "../rows/guides.h"
#include "../rows/violation.h"
#include "../state/inputs.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "check_method.h"
#include "energy_balance.h"
#include "history.h"
#include "newton.h"
#include "predict.h"
#include "projection.h"
#include "steps.h"

enum { STAGES = ALI3_RADAU, LAST = STAGES - 1, SWEEPS = 3, REFINEMENTS = 3 };
static const double VELOCITY_TOLERANCE = 1e-12, ACCELERATION_TOLERANCE = 1e-12;
static const double SLOW_RATIO = 0.3;         /* ratio of two errors above which the tangent is computed again */
static const double REFINED = 1e-2;       /* of the tolerances: below it refinement ends */
/* Largest remaining error and round-off, relative to accelerations. */
static const double ERROR_FRACTION = 1e-5, ROUND_OFF = 1e-12;
static const double STALL_LIMIT = 1e-9; /* below it a stalled iteration is round-off */
static const double EPS_FACTOR = 1e-3; /* of eps_rel: penalty for rows nearly redundant at singular positions */
static const double MAX_RATIO = 2.0; /* steps: range of extrapolation of the last collocation polynomial */

static const double node[STAGES] = {0.15505102572168219, 0.64494897427831781, 1.0}; /* (4 -+ sqrt 6)/10 */
/* A and A^2 of the method, to 17 digits. */
static const double A[STAGES][STAGES] = {{0.19681547722366043, -0.06553542585019839, 0.02377097434822015},
                                         {0.39442431473908728, 0.29207341166522846, -0.04154875212599793},
                                         {0.37640306270046728, 0.51248582618842161, 0.11111111111111111}};
static const double A2[STAGES][STAGES] = {{0.02183503419072274, -0.01985725409861227, 0.01004263019656241},
                                          {0.17719058743194561, 0.03816496580927726, -0.00737596352989574},
                                          {0.31804138174397717, 0.18195861825602283, 0.00000000000000000}};

/* Accelerations of stage i, nq. */
static double *stage_acceleration(const ali3_instance *in, int i) {
  return in->step.stage + (int64_t)i * in->system->size.nq;
}
/* Residuals of stage i, nq. */
static double *stage_residual(const ali3_instance *in, int i) { return stage_acceleration(in, STAGES + i); }
/* Rows or multipliers of stage i in an array of all stages, nc. */
static double *stage_rows(const ali3_instance *in, double *v, int i) { return v + (int64_t)i * in->system->size.nc; }
/* Powers of sensed elements at stage i, n_work, W. */
static double *stage_power(const ali3_instance *in, int i) {
  return in->watch.stages + (int64_t)i * in->system->n_work;
}
/* Entries of stage i in an array of all stages, in the row pattern. */
static double *stage_entries(const ali3_instance *in, double *v, int i) { return v + i * in->system->size.nnz_rows; }

/* Sets position, velocity, guides and inputs of stage i. */
static void set_stage(ali3_instance *in, double t, double h, int i) {
  const ali3_vectors *from = &in->now;
  ali3_vectors *to = &in->next;
  const double *restrict a0 = stage_acceleration(in, 0), *restrict a1 = stage_acceleration(in, 1),
                         *restrict a2 = stage_acceleration(in, 2);
  for (int32_t k = 0; k < in->system->size.nq; k++) {
    to->qd[k] = from->qd[k] + h * (A[i][0] * a0[k] + A[i][1] * a1[k] + A[i][2] * a2[k]);
    to->q[k] = from->q[k] + h * (node[i] * from->qd[k] + h * (A2[i][0] * a0[k] + A2[i][1] * a1[k] + A2[i][2] * a2[k]));
  }
  in->inputs.forces = in->inputs.stage + (int64_t)i * in->system->size.nu;
  ali3_guides_time(in, to, t - (1.0 - node[i]) * h);
}

/* Forces at in->next; tangents of elements for weights above 0. */
static void evaluate_forces(ali3_instance *in, double wC, double wK) {
  ali3_vectors *to = &in->next;
  const ali3_force_call call = {.q = to->q,
                                .qd = to->qd,
                                .y_old = in->now.y,
                                .wC = wC,
                                .wK = wK,
                                .tangent = wC + wK > 0.0,
                                .Q = in->step.Q,
                                .y_new = to->y,
                                .out = to->out,
                                .potential = to->potential};
  ali3_forces(in, &call);
}

/* Rows and residuals r_i = M a_i + Phi_q' lam_i - Q of all stages; the report has the worst. False: not finite. */
static bool evaluate(ali3_instance *in, double t, double h) {
  const ali3_system *S = in->system;
  double largest = 0.0, open = 0.0;
  for (int i = 0; i < STAGES; i++) { /* ascending, as a stage may overwrite the number after its own */
    double *Phi = stage_rows(in, in->radau.Phi, i), *J = stage_entries(in, in->radau.J, i), *r = stage_residual(in, i);
    set_stage(in, t, h, i);
    ali3_constraints(in, in->next.q, in->next.s, Phi, J);
    evaluate_forces(in, 0.0, 0.0);
    if (S->n_work > 0) memcpy(stage_power(in, i), in->watch.now, (size_t)S->n_work * sizeof(double));
    ali3_mass_times(in, stage_acceleration(in, i), r);
    ali3_rows_transposed(S, J, stage_rows(in, in->radau.lam, i), in->step.x);
    for (int32_t k = 0; k < S->size.nq; k++) {
      r[k] += in->step.x[k] - in->step.Q[k];
      const double size = 0.5 * h * h * fabs(r[k]) * in->mass.floor_inverse[k];
      if (!(size <= largest) && largest == largest) { /* a NaN stays */
        largest = size;
        in->report.worst_coordinate = k;
      }
    }
    int32_t worst = 0;
    const double violation = ali3_violation(S, Phi, &worst);
    if (!(violation <= open) && open == open) {
      open = violation;
      in->report.worst_row = worst;
    }
  }
  in->report.iterations += STAGES;
  in->report.residual = largest;
  in->report.violation = open;
  return largest < 1e300 && open < 1e300;
}

/* Writes blocks (stage, k) of the tangent of all stages, M + h A_ik C + h^2 (A^2)_ik K, from the fronts of one
 * stage. */
static void add_stage_blocks(ali3_instance *in, double h, int stage) {
  const ali3_system *S = in->system;
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t n = S->front_ptr[f + 1] - S->front_ptr[f];
    const double *M = in->tangent.F + S->front_off[f], *C = in->radau.F_C + S->front_off[f],
                 *K = in->radau.F_K + S->front_off[f];
    double *block = in->radau.F + (int64_t)STAGES * STAGES * S->front_off[f];
    for (int k = 0; k < STAGES; k++) {
      const double wM = k == stage ? 1.0 : 0.0, wC = h * A[stage][k], wK = h * h * A2[stage][k];
      for (int32_t j = 0; j < n; j++)
        for (int32_t i = j; i < n; i++) {
          const int64_t at = (int64_t)j * n + i;
          const double value = wM * M[at] + wC * C[at] + wK * K[at];
          block[(int64_t)(STAGES * j + k) * STAGES * n + STAGES * i + stage] = value;
          block[(int64_t)(STAGES * i + k) * STAGES * n + STAGES * j + stage] = value;
        }
    }
  }
}

/* Factorises the tangent of the present stages; in->tangent.F, in->radau.F_C, in->radau.F_K are left with those of the
 * last stage. */
static ali3_status factorise(ali3_instance *in, double t, double h, double alpha) {
  const ali3_system *S = in->system;
  const size_t size = (size_t)S->size.front_size * sizeof(double);
  const bool flexible = S->n_flexible > 0;
  memcpy(in->radau.J_made, in->radau.J, STAGES * (size_t)S->size.nnz_rows * sizeof(double));
  for (int i = 0; i < STAGES; i++) {
    set_stage(in, t, h, i);
    ali3_mass_to_fronts(in, in->tangent.F);
    memset(in->radau.F_C, 0, size);
    memset(in->radau.F_K, 0, size);
    evaluate_forces(in, 1.0, 0.0);
    ali3_elements_tangent(in, in->radau.F_C);
    evaluate_forces(in, 0.0, 1.0);
    ali3_elements_tangent(in, in->radau.F_K);
    if (flexible) {
      ali3_bodies_tangent(in, 1.0, 0.0, 0.0, in->tangent.F);
      ali3_bodies_tangent(in, 0.0, 1.0, 0.0, in->radau.F_C);
      ali3_bodies_tangent(in, 0.0, 0.0, 1.0, in->radau.F_K);
    }
    if (in->settings.geometric)
      ali3_geometric(in, in->next.q, in->next.s, stage_rows(in, in->radau.lam, i), 1.0, in->radau.F_K);
    ali3_rows_square(in, stage_entries(in, in->radau.J, i), alpha, in->radau.F_K);
    add_stage_blocks(in, h, i);
  }
  return ali3_factorise_lu(in, STAGES, in->radau.F);
}

/* in->step.w = sum_k (A^2)_ik x_k of the interleaved corrections x. */
static void sum_corrections(ali3_instance *in, int i) {
  for (int32_t k = 0; k < in->system->size.nq; k++) {
    const double *x = in->radau.x + STAGES * (int64_t)k;
    in->step.w[k] = A2[i][0] * x[0] + A2[i][1] * x[1] + A2[i][2] * x[2];
  }
}

/* Size of accelerations in the metric of the masses; stage i of coordinate k is at v[k * coordinate_stride + i *
 * stage_stride]. */
static double acceleration_size(const ali3_instance *in, const double *v, int64_t coordinate_stride,
                                int64_t stage_stride) {
  double square = 0.0;
  for (int32_t k = 0; k < in->system->size.nq; k++)
    for (int i = 0; i < STAGES; i++) {
      const double x = v[k * coordinate_stride + i * stage_stride];
      square += in->mass.floor[k] * x * x;
    }
  return sqrt(square);
}

/* One Newton correction. *change: size of the correction relative to the accelerations. */
static ali3_status correct(ali3_instance *in, double h, double alpha, double *change) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  for (int i = 0; i < STAGES; i++) {
    const double *Phi = stage_rows(in, in->radau.Phi, i), *r = stage_residual(in, i);
    for (int32_t k = 0; k < nc; k++) in->step.mu[k] = alpha * Phi[k];
    ali3_rows_transposed(S, stage_entries(in, in->radau.J_made, i), in->step.mu, in->step.x);
    for (int32_t k = 0; k < nq; k++) in->radau.x[STAGES * k + i] = -(r[k] + in->step.x[k]);
  }
  ali3_solve_lu(in, STAGES, in->radau.F, in->radau.x);
  if (!ali3_finite(in->radau.x, STAGES * (int64_t)nq)) return ALI3_NOT_FINITE;
  for (int i = 0; i < STAGES; i++) {
    double *lam = stage_rows(in, in->radau.lam, i), *a = stage_acceleration(in, i);
    const double *Phi = stage_rows(in, in->radau.Phi, i);
    sum_corrections(in, i);
    ali3_rows_times(S, stage_entries(in, in->radau.J_made, i), in->step.w, in->step.mu);
    for (int32_t k = 0; k < nc; k++) lam[k] += alpha * (Phi[k] + h * h * in->step.mu[k]);
    for (int32_t k = 0; k < nq; k++) a[k] += in->radau.x[STAGES * k + i];
  }
  const double size = acceleration_size(in, in->step.stage, 1, nq);
  *change = size > 0.0 ? acceleration_size(in, in->radau.x, STAGES, 1) / size : 0.0;
  return ALI3_OK;
}

/* Largest violation of the rows at the stages, m. */
static double largest_opening(const ali3_instance *in) {
  double largest = 0.0;
  for (int i = 0; i < STAGES; i++) largest = fmax(largest, ali3_opening(in->system, stage_rows(in, in->radau.Phi, i)));
  return largest;
}

/* Newton's iteration until the tolerances hold and the remaining error, estimated from the last correction and the
 * ratio of the last two errors, is small against the error of the method: a prediction from the last collocation
 * polynomial (`extrapolated`) has an error of h^3, the method of h^5. A tolerance in metres alone would spoil the order
 * at small steps, as it allows accelerations of 2 / h^2 times itself. */
static ali3_status newton(ali3_instance *in, double t, double h, double alpha, bool extrapolated) {
  const ali3_settings *settings = &in->settings;
  const double residual_limit = in->system->fine * settings->tolerance_r,
               opening_limit = in->system->fine * settings->tolerance_phi;
  double last_error, change = 0.0, limit = ROUND_OFF;
  bool new_tangent = true;
  int32_t refinements = 0;
  if (!evaluate(in, t, h)) return ALI3_NOT_FINITE;
  last_error = fmax(in->report.residual / residual_limit, largest_opening(in) / opening_limit);
  for (int32_t iteration = 0; iteration < settings->max_iterations; iteration++) {
    ali3_status status = new_tangent ? factorise(in, t, h, alpha) : ALI3_OK;
    if (status == ALI3_OK) status = correct(in, h, alpha, &change);
    if (status != ALI3_OK) return ali3_newton_failure(in, status);
    if (!evaluate(in, t, h)) return ALI3_NOT_FINITE;
    const double r = in->report.residual / residual_limit, v = largest_opening(in) / opening_limit;
    const double size = fmax(r, v), remaining = size < last_error ? change * size / last_error : change;
    if (iteration == 0 && extrapolated) limit = fmax(ROUND_OFF, ERROR_FRACTION * change * change);
    if (r <= REFINED && v <= REFINED && remaining <= limit) return ALI3_OK;
    const bool slow = iteration > 0 && size > SLOW_RATIO * last_error;
    if (size <= 1.0 && (refinements++ == REFINEMENTS || (slow && (new_tangent || remaining <= STALL_LIMIT))))
      return ALI3_OK;
    new_tangent = slow;
    last_error = size;
  }
  return ALI3_NOT_CONVERGED;
}

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

/* Removes the part of the multipliers that causes no force (redundant rows), whose round-off would grow by
 * extrapolation. */
static void remove_redundant(ali3_instance *in, double h, double alpha) {
  const ali3_system *S = in->system;
  for (int i = 0; i < STAGES; i++) {
    ali3_rows_transposed(S, stage_entries(in, in->radau.J_made, i), stage_rows(in, in->radau.lam, i), in->step.x);
    for (int32_t k = 0; k < S->size.nq; k++) in->radau.x[STAGES * k + i] = in->step.x[k];
  }
  ali3_solve_lu(in, STAGES, in->radau.F, in->radau.x);
  for (int i = 0; i < STAGES; i++) {
    double *lam = stage_rows(in, in->radau.lam, i);
    sum_corrections(in, i);
    ali3_rows_times(S, stage_entries(in, in->radau.J_made, i), in->step.w, lam);
    for (int32_t k = 0; k < S->size.nc; k++) lam[k] *= alpha * h * h;
  }
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
    set_stage(in, t, h, i);
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
  status = newton(in, t, h, alpha, predict(in, h));
  in->inputs.forces = in->inputs.set;
  ali3_iterations_since(in, before);
  if (status != ALI3_OK) return status;
  memcpy(to->used, in->inputs.set, (size_t)S->size.nu * sizeof(double));
  if (S->n_guide_work > 0) ali3_guides_work(in, to, work_of_drives(in, t, h));
  memcpy(to->qdd, stage_acceleration(in, LAST), nq * sizeof(double));
  memcpy(to->lam, stage_rows(in, in->radau.lam, LAST), (size_t)S->size.nc * sizeof(double));
  for (int i = 0; i < STAGES; i++) ali3_work_stage(in, h * A[LAST][i], stage_power(in, i), to->work);
  ali3_work_store(in, to);
  remove_redundant(in, h, alpha);
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
  return in->system->n_velocity_row + in->system->n_tabled > 0 ? ALI3_WRONG_METHOD : ali3_needs_no_states(in);
}

const ali3_method ali3_method_radau_5 = {.step = step,
                                         .motion = ali3_balance_long_step,
                                         .has_guides_work = ali3_always,
                                         .check_system = check_system,
                                         .excludes =
                                             ALI3_STATES_IN_WORDS ", no tabled bodies, and no rolling without slip",
                                         .owner = ALI3_METHOD_RADAU_5,
                                         .round_off = ALI3_ROUND_OFF_COLLOCATION};
