/* One energy-momentum step of index 3. With D = q1 - q0, v1 = 2 D/h - v0 and all quantities in the middle of the step,
 *   M (D - h v0) + c (A' lam - Q) = 0,  Phi(q1) = 0,  c = h^2/2,
 * where A is the discrete derivative of the rows (A D = Phi(q1) - Phi(q0)) and Q has discrete gradients: constraint
 * forces do no work, springs are conservative, only dampers and inputs change the energy. The method carries its own
 * velocity; the reported one fulfils the constraints with the same kinetic energy. With flexible bodies M v is taken at
 * both ends (discrete_inertia.c). */
#include <math.h>
#include <string.h>

#include "../algebra/finite.h"
#include "../algebra/fronts.h"
#include "../algebra/number_pairs.h"
#include "../elements/forces.h"
#include "../flexible/discrete_inertia.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../method.h"
#include "../rows/constraints.h"
#include "../rows/discrete_rows.h"
#include "../rows/driving_functions.h"
#include "../rows/velocity_rows.h"
#include "../rows/violation.h"
#include "../state/inputs.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "check_method.h"
#include "energy_balance.h"
#include "energy_momentum.h"
#include "history.h"
#include "newton.h"
#include "predict.h"
#include "steps.h"

enum { REFINEMENTS = 2, REFINEMENTS_COMPOSED = 4, COMPOSED_PAST = 3, MAX_DIVERGING = 2, ATTEMPTS = 4 };
static const double SLOW_RATIO = 0.1;      /* ratio of two errors above which the tangent is computed again */
static const double REFACTORISE_ERROR = 10.0; /* tolerances: also if two more iterations are predicted to end above */
static const double REFINE_R = 1e-1; /* s^-1: the work of a residual r in a step is 2 r v / h */
static const double REFINE_PHI = 1e-1, REFINE_COMPOSED = 50.0; /* of the tolerance; s^-1 */
static const double EPS_FACTOR = 1e-3; /* of eps_rel */
/* Limits of the correction relative to accelerations: fraction of the error of the method, round-off. */
static const double ERROR_FRACTION = 1e-2, ROUND_OFF = 1e-12;
static const double SIGN_CHANGE = 1e5, MAX_RAISE = 100.0; /* of penalties */
/* Factors of the penalty; the last attempt is not stopped when it diverges. */
static const double ATTEMPT[ATTEMPTS] = {1.0, 1e2, 1e-2, 1.0};

/* c alpha, dimensionless as rows are mass-normalised. Tried from 1e-13 to 1e-4: with much larger ones rows that are
 * nearly redundant at singular positions do not converge, with much smaller ones round-off of rows that turn far in a
 * step causes forces. */
static double penalty(const ali3_instance *in, double h) { return 0.5 * h * h * ali3_penalty(in, h) / EPS_FACTOR; }

/* The penalty of this step. The lever a of a row that vanishes at a singular position has opposite signs at the ends of
 * the step, and the iteration contracts by 1 / (1 + c alpha a_mean a_end): it diverges if that product is between -2
 * and 0. Levers grow with the turn of the rows in a step, so the penalty is raised where rows turn little. */
static double raised_penalty(const ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  const double weight = penalty(in, h);
  double turn = 0.0;
  if (in->settings.alpha > 0.0) return weight;
  for (int32_t k = 0; k < S->size.nc; k++) {
    double square = 0.0;
    for (int32_t i = S->row_ptr[k]; i < S->row_ptr[k + 1]; i++) {
      const double change = in->tangent.J[i] - in->discrete.J0[i];
      square += change * change * in->mass.floor_inverse[S->row_col[i]];
    }
    if (square > turn) turn = square;
  }
  const double largest = MAX_RAISE * 0.5 / (in->settings.eps_rel * EPS_FACTOR);
  return fmax(weight, fmin(largest, SIGN_CHANGE / turn));
}

/* Rows and residual r = M (D - h v) + inertia - h^2/2 (Q - A' lam) of the iterate D, with the forces of the middle. */
static void evaluate(ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  const double c = 0.5 * h * h, inverse = 1.0 / h;
  ali3_vectors *to = &in->next;
  const double *from = in->now.q, *own = in->now.own, *D = in->step.D, *Q = in->step.Q;
  double *q = to->q, *middle = in->discrete.middle, *rate = in->discrete.rate, *w = in->step.w, *r = in->step.r,
         *x = in->step.x;
  ALI3_EACH(0, nq, ALI3_AT(q) = ALI3_AT(from) + ALI3_AT(D); ALI3_AT(middle) = ALI3_AT(from) + 0.5 * ALI3_AT(D);
            ALI3_AT(rate) = inverse * ALI3_AT(D); ALI3_AT(w) = ALI3_AT(D) - h * ALI3_AT(own))
  if (S->n_flexible > 0) {
    for (int32_t i = 0; i < nq; i++) in->step.x[i] = 2.0 * in->discrete.rate[i] - in->now.own[i];
    ali3_flexible_momentum(in, to->q, in->step.x, in->step.d0);
  }
  ali3_constraints(in, to->q, to->s, in->step.Phi, in->tangent.J);
  ali3_discrete_rows(in, in->step.D, to->q, &in->now, to);
  if (S->n_velocity_row > 0) ali3_velocity_middle(in, in->discrete.A, in->step.D, in->step.Phi, in->tangent.J);
  const ali3_force_call call = {.q = in->discrete.middle,
                                .qd = in->discrete.rate,
                                .y_old = in->now.y,
                                .h = 0.5 * h,
                                .wC = 0.5 * h,
                                .wK = 0.25 * h * h,
                                .tangent = true,
                                .discrete = true,
                                .iterate = true,
                                .Q = in->step.Q,
                                .y_new = to->y,
                                .out = to->out,
                                .potential = to->potential};
  in->inputs.forces = in->inputs.middle;
  ali3_forces(in, &call);
  in->inputs.forces = in->inputs.set;
  ali3_constant_mass_times(in, w, r);
  if (S->n_flexible > 0) {
    for (int32_t i = 0; i < nq; i++) in->step.w[i] *= inverse;
    ali3_discrete_inertia(in, h, in->step.hat, in->step.d0, in->discrete.rate, in->step.w, in->step.r);
  }
  ali3_rows_transposed(S, in->discrete.A, to->lam, x);
  ALI3_EACH(0, nq, ALI3_AT(r) += c * (ALI3_AT(x) - ALI3_AT(Q)))
}

/* Whether in->discrete.J0 is Phi_q at v, bit for bit; `remember`: marks it so. */
static bool has_same_rows(ali3_instance *in, const ali3_vectors *v, bool remember) {
  const ali3_sizes *z = &in->system->size;
  const double *part[3] = {v->q, v->s, v->on};
  const int32_t n[3] = {z->nq, z->ng, z->n_switch};
  double *at = in->discrete.at_J0;
  in->discrete.has_J0 |= remember;
  for (int k = 0; k < 3 && in->discrete.has_J0; at += n[k], k++) {
    const size_t size = (size_t)n[k] * sizeof(double);
    if (remember)
      ali3_copy(at, part[k], n[k]);
    else if (n[k] > 0 && memcmp(at, part[k], size) != 0)
      return false;
  }
  return in->discrete.has_J0;
}

/* The exact tangent M + h^2/4 (K + sum lam_k H_k) + h/2 C + weight A' Phi_q(q1), slightly unsymmetric. */
static ali3_status factorise(ali3_instance *in, double h, double weight) {
  double *J = in->tangent.J, *A = in->discrete.A;
  ali3_mass_to_fronts(in, in->tangent.F);
  if (in->settings.geometric) ali3_geometric(in, in->next.q, in->next.s, in->next.lam, 0.25 * h * h, in->tangent.F);
  ali3_forces_tangent(in, in->tangent.F);
  ali3_mirror(in, in->tangent.F);
  ali3_rows_product(in, A, J, weight, in->tangent.F);
  in->tangent.J = in->tangent.J_made;
  in->tangent.J_made = J;
  in->discrete.A = in->discrete.A_made;
  in->discrete.A_made = A;
  return ali3_factorise_lu(in, 1, in->tangent.F);
}

/* One Newton correction of D and of the multipliers. */
static ali3_status correct(ali3_instance *in, double weight, double alpha, int32_t iteration) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  const double *Phi = in->step.Phi, *r = in->step.r, *opening = in->step.gamma;
  double *mu = in->step.mu, *x = in->step.x, *change = in->step.lam;
  ALI3_EACH(0, nc, ALI3_AT(mu) = weight * ALI3_AT(Phi))
  ali3_rows_transposed(S, in->discrete.A_made, mu, x);
  ALI3_EACH(0, nq, ALI3_AT(x) = -(ALI3_AT(r) + ALI3_AT(x)))
  ali3_solve_lu(in, 1, in->tangent.F, x);
  if (!ali3_finite(x, nq)) return ALI3_NOT_FINITE;
  ali3_rows_times(S, in->tangent.J_made, x, in->step.gamma);
  ALI3_EACH(0, nc, ALI3_AT(change) = alpha * (ALI3_AT(Phi) + ALI3_AT(opening)))
  ali3_accelerate(in, iteration > 0);
  ali3_add(in->next.lam, change, nc);
  ali3_add(in->step.D, x, nq);
  return ALI3_OK;
}

/* Larger one of the residual *r and the violation *v, each relative to its tolerance. */
static double relative_error(const ali3_instance *in, double *r, double *v) {
  *r = in->report.residual / (in->system->fine * in->settings.tolerance_r);
  *v = ali3_opening(in->system, in->step.Phi) / (in->system->fine * in->settings.tolerance_phi);
  return fmax(*r, *v);
}

/* Restores the iterate before the last correction. */
static ali3_status undo_correction(ali3_instance *in, double h) {
  for (int32_t i = 0; i < in->system->size.nq; i++) in->step.D[i] -= in->mixing.step_q[i];
  for (int32_t k = 0; k < in->system->size.nc; k++) in->next.lam[k] -= in->mixing.step_lam[k];
  evaluate(in, h);
  return ali3_measure_residual(in, in->step.r) ? ALI3_OK : ALI3_NOT_FINITE;
}

/* Predicts the increment and multipliers and evaluates them; false: not finite. */
static bool predict(ali3_instance *in, double h) {
  const int32_t n_past = in->settings.method == ALI3_METHOD_ENERGY_MOMENTUM ? ALI3_PAST : COMPOSED_PAST;
  ali3_history_predict(in, 0.5 * h, ali3_history_order(in, n_past), in->step.d0, in->next.lam);
  for (int32_t i = 0; i < in->system->size.nq; i++) in->step.D[i] = h * in->now.own[i] + 0.5 * h * h * in->step.d0[i];
  evaluate(in, h);
  return ali3_measure_residual(in, in->step.r);
}

/* Size of the last correction relative to the contribution of accelerations to the step, in the metric of the
 * masses. */
static double relative_correction(const ali3_instance *in) {
  double change = 0.0, size = 0.0;
  for (int32_t i = 0; i < in->system->size.nq; i++) {
    const double m = in->mass.floor[i];
    change += m * in->mixing.step_q[i] * in->mixing.step_q[i];
    size += m * in->step.w[i] * in->step.w[i];
  }
  return size > 0.0 ? sqrt(change / size) : 0.0;
}

/* Limit of relative_correction for a sub-step of order four: a fraction of the error of the method, the fourth power of
 * the change of accelerations between sub-steps. A tolerance in metres would spoil the order at small steps. */
static double correction_limit(const ali3_instance *in, double h) {
  const ali3_vectors *v = &in->now;
  const int32_t nq = in->system->size.nq;
  const double *time = v->history + ALI3_HISTORY_TIME;
  double change = 0.0, size = 0.0;
  if (!(v->history[ALI3_HISTORY_COUNT] >= 2.0) || time[0] == time[1]) return ROUND_OFF;
  for (int32_t i = 0; i < nq; i++) {
    const double a = v->past_a[i], difference = a - v->past_a[nq + i], m = in->mass.floor[i];
    change += m * difference * difference;
    size += m * a * a;
  }
  if (!(size > 0.0)) return ROUND_OFF;
  const double turn = h / (time[0] - time[1]), square = change / size * turn * turn;
  return fmax(ROUND_OFF, ERROR_FRACTION * square * square);
}

/* Newton's iteration. It continues below the tolerances while that is cheap, as energy errors follow from residuals. A
 * tangent is reused until the ratio of the errors shows that a new one is cheaper. Unless `patient`, an iteration that
 * diverges with new tangents is stopped. */
static ali3_status newton(ali3_instance *in, double h, double weight, bool patient, int32_t *iterations) {
  const ali3_settings *settings = &in->settings;
  const bool is_composed = settings->method != ALI3_METHOD_ENERGY_MOMENTUM;
  const double alpha = 2.0 * weight / (h * h), refine = fmin(1.0, REFINE_COMPOSED * fabs(h));
  const double least_r = is_composed ? refine : REFINE_R * fabs(h), least_v = is_composed ? refine : REFINE_PHI;
  const int32_t largest = is_composed ? REFINEMENTS_COMPOSED : REFINEMENTS;
  double r, v, last = relative_error(in, &r, &v), limit = is_composed ? correction_limit(in, h) : 0.0;
  int32_t refinements = 0, diverging = 0;
  bool new_tangent = true;
  for (int32_t k = 0; k < settings->max_iterations; k++) {
    ali3_status status = new_tangent ? factorise(in, h, weight) : ALI3_OK;
    if (status == ALI3_OK) status = correct(in, weight, alpha, k);
    if (status != ALI3_OK) return ali3_newton_failure(in, status);
    ++*iterations;
    evaluate(in, h);
    if (!ali3_measure_residual(in, in->step.r)) return ALI3_NOT_FINITE;
    const double size = relative_error(in, &r, &v), ratio = last > 0.0 ? size / last : 0.0;
    if (r <= least_r && v <= least_v && (!is_composed || relative_correction(in) * fmin(1.0, ratio) <= limit))
      return ALI3_OK;
    if (last <= 1.0 && size > last) return undo_correction(in, h);
    if (!patient && new_tangent && size > last && ++diverging == MAX_DIVERGING) return ALI3_NOT_CONVERGED;
    const bool slow = k > 0 && ratio > SLOW_RATIO;
    if (size <= 1.0 && (refinements++ == largest || slow)) return ALI3_OK;
    new_tangent = slow || (size > 1.0 && size * ratio * ratio > REFACTORISE_ERROR);
    last = size;
  }
  return last <= 1.0 ? ALI3_OK : ALI3_NOT_CONVERGED;
}

/* Solves the step with the raised penalty, after failures with others; *weight: the one that converged. */
static ali3_status solve(ali3_instance *in, double h, double *weight, int32_t *iterations) {
  if (!predict(in, h)) return ALI3_NOT_FINITE;
  const double initial_penalty = raised_penalty(in, h);
  ali3_status status = ALI3_NOT_CONVERGED;
  for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
    *weight = ATTEMPT[attempt] * initial_penalty;
    if (attempt > 0 && !predict(in, h)) return ALI3_NOT_FINITE;
    status = newton(in, h, *weight, attempt == ATTEMPTS - 1, iterations);
    if (status != ALI3_NOT_CONVERGED && status != ALI3_SINGULAR) break;
  }
  return status;
}

/* Removes the part of lam that causes no force (redundant rows), whose round-off would grow by extrapolation. */
static void remove_redundant(ali3_instance *in, double weight, double *lam) {
  const ali3_system *S = in->system;
  ali3_rows_transposed(S, in->discrete.A_made, lam, in->step.x);
  ali3_solve_lu(in, 1, in->tangent.F, in->step.x);
  ali3_rows_times(S, in->tangent.J_made, in->step.x, lam);
  for (int32_t k = 0; k < S->size.nc; k++) lam[k] *= weight;
}

/* Work of driven rows: D' A' lam is the force of the step times its displacement. */
static double work_of_drives(ali3_instance *in) {
  const ali3_system *S = in->system;
  double work = 0.0;
  ali3_rows_times(S, in->discrete.A, in->step.D, in->step.mu);
  for (int32_t i = 0; i < S->n_driven; i++) work -= in->next.lam[S->driven_row[i]] * in->step.mu[S->driven_row[i]];
  return work;
}

/* Whether the method carries the projected velocity. Energy bounds the deviation of the carried velocity from the rows,
 * except in coordinates without mass, which flexible bodies have: there it alternates in sign and grows with their
 * rotation. Not in compositions, whose steps must be symmetric. */
static bool carries_projected(const ali3_instance *in) {
  return in->system->n_flexible > 0 && in->settings.method == ALI3_METHOD_ENERGY_MOMENTUM;
}

ali3_status ali3_energy_momentum(ali3_instance *in, double t, double h, double middle, bool reported) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  double weight = 0.0;
  ali3_vectors *from = &in->now, *to = &in->next;
  int32_t iterations = 0;
  ali3_history_own(in, ALI3_METHOD_ENERGY_MOMENTUM, from->qd);
  ali3_driving_step(in, from, to, t, h);
  ali3_status status = ali3_inputs_at(in, middle);
  if (status != ALI3_OK) return status;
  memcpy(to->used, in->inputs.set, (size_t)S->size.nu * sizeof(double));
  if (!has_same_rows(in, from, false)) {
    ali3_constraints(in, from->q, from->s, in->step.Phi, in->discrete.J0);
    has_same_rows(in, from, true);
  }
  if (S->n_flexible > 0) ali3_flexible_momentum(in, from->q, from->own, in->step.hat);
  status = solve(in, h, &weight, &iterations);
  in->report.iterations += iterations;
  ali3_iterations_since(in, in->report.iterations - iterations);
  if (status != ALI3_OK) return status;
  const double two_rates = 2.0 / h, square = h * h, *D = in->step.D, *before = from->own;
  double *own = to->own, *d0 = in->step.d0;
  ALI3_EACH(0, nq, ALI3_AT(own) = two_rates * ALI3_AT(D) - ALI3_AT(before);
            ALI3_AT(d0) = 2.0 * (ALI3_AT(D) - h * ALI3_AT(before)) / square)
  ali3_work_step(in, 1.0);
  if (S->n_driving_work > 0) to->work[S->n_work] = from->work[S->n_work] + work_of_drives(in);
  ali3_predict_rates(in, h);
  remove_redundant(in, weight, to->lam);
  ali3_history_append(in, h, in->step.d0);
  if (S->size.ny > 0) {
    ali3_history_velocity(in, h, in->step.w);
    const ali3_force_call call = {.q = to->q,
                                  .qd = in->step.w,
                                  .y_old = from->y,
                                  .h = h,
                                  .wC = 0.5 * h,
                                  .wK = 0.25 * h * h,
                                  .Q = in->step.Q,
                                  .y_new = to->y,
                                  .out = to->out,
                                  .potential = to->potential};
    ali3_forces(in, &call);
    ali3_forces_accept(in, &call);
  }
  to->h_last[0] = 0.0;
  if (S->n_velocity_row > 0) ali3_constraints(in, to->q, to->s, in->step.Phi, in->tangent.J); /* A at the end */
  has_same_rows(in, to, true);
  memcpy(in->discrete.J0, in->tangent.J, (size_t)S->size.nnz_rows * sizeof(double));
  if (carries_projected(in)) ali3_energy_momentum_carry(in, to, weight);
  if (reported) status = ali3_energy_momentum_complete(in, to);
  return status == ALI3_OK ? ali3_accept(in) : status;
}

static void before(ali3_instance *in, const ali3_request *request) {
  ali3_energy_momentum_restart(in, request->h, request->controlled);
}

static ali3_status step(ali3_instance *in, const ali3_request *request) {
  return ali3_energy_momentum(in, request->t, request->h, 0.5, request->reading != ALI3_READ_NOTHING);
}

void ali3_energy_momentum_motion(ali3_instance *in, double h) {
  const ali3_vectors *from = &in->next;
  const bool n_past = from->history[ALI3_HISTORY_COUNT] >= 1.0 &&
                      from->history[ALI3_HISTORY_OWNER] == (double)ALI3_METHOD_ENERGY_MOMENTUM;
  ali3_balance_change(in, h, n_past ? from->own : from->qd, n_past ? from->past_a : from->qdd, in->now.own);
}

/* Lookup-table bodies have no discrete derivatives. */
static ali3_status check_system(const ali3_instance *in) {
  return in->system->n_lookup > 0 ? ALI3_WRONG_METHOD : ALI3_OK;
}

const ali3_method ali3_method_energy_momentum = {.step = step,
                                                 .check_system = check_system,
                                                 .excludes = "no lookup-table bodies",
                                                 .before = before,
                                                 .motion = ali3_energy_momentum_motion,
                                                 .has_driving_work = ali3_always,
                                                 .after_unobserved = ali3_energy_momentum_report,
                                                 .owner = ALI3_METHOD_ENERGY_MOMENTUM,
                                                 .round_off = ALI3_ROUND_OFF_INDEX_3};
