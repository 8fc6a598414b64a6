/* Static equilibrium by a pseudo-transient Newton iteration with mass / c + stiffness, where c increases while the
 * residual decreases. The mass keeps free directions (position on a plane) constant. Negative pivots of mass / MAX_C +
 * stiffness at the end show an equilibrium that is left faster than at the rate 1 / sqrt(MAX_C). A coordinate without row,
 * stiffness and weight, such as the spin of a driven wheel, cannot balance at rest and is held. in->step.w is 0 for
 * coordinates that may be held, in->step.d0 for those that are; both are 1 elsewhere.
 *
 * At rest undeflected friction transmits no force. If there is no equilibrium without it, the displacement from the
 * drawing is treated as one step of duration LONG, whose end has the deflections: dampers have no force, sticking
 * contacts are springs, sliding ones transmit their limit. */
#include <math.h>
#include <string.h>

#include "../algebra/finite.h"
#include "../algebra/fronts.h"
#include "../elements/forces.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "../rows/violation.h"
#include "../state/vectors.h"
#include "initialise.h"
#include "settled_start.h"

static const double PENALTY = 1e9, MAX_PENALTY = 1e12; /* c alpha, as of a step with eps_rel = 2.5e-10 */
/* These in m and s^2 times the fineness of the System: a drawing and its equilibrium are similar at every size. */
static const double MAX_STEP = 0.1; /* m or rad per iteration; lengths double while such steps reduce the residual */
static const double FIRST_C = 1e-3, MIN_C = 1e-10, MAX_C = 100.0; /* s^2 */
static const double CLOSED = 1e-10; /* m */
static const double OPEN = 1e-2; /* m: violation above which c does not increase */
/* Whole iterations after which c is reduced if rows close slowly because c K is large relative to PENALTY. */
enum { SLOW = 20 };
static const double LONG = 1e6; /* s */
static const double BALANCE = 1e-6;    /* of the largest force */
static const double ROUND_OFF = 1e-12; /* of the largest force, or of the diagonal of T */
/* rad: a heading change between these is drift of a scene without horizontal support, which is moved back */
static const double TURNED = 1e-12, HELD = 1e-6;

/* Residual of the forces at rest, g = Phi_q' lam - Q, in in->step.r. Stores the largest |g_i| in the report; returns
 * it, or 0 within round-off. `h`: size of the step from the drawing, or 0; *largest_force: so far, N. */
static double evaluate_residual(ali3_instance *in, double c, double h, double *largest_force) {
  const ali3_system *S = in->system;
  ali3_vectors *v = &in->next;
  double largest = 0.0, scale = 0.0;
  ali3_constraints(in, v->q, v->s, in->step.Phi, in->tangent.J);
  for (int32_t i = 0; h > 0.0 && i < S->size.nq; i++) v->qd[i] = 2.0 * (v->q[i] - in->now.q[i]) / h;
  const ali3_force_call call = {.q = v->q,
                                .qd = v->qd,
                                .y_old = in->now.y,
                                .h = h,
                                .wC = h > 0.0 ? 2.0 * c / h : 0.0,
                                .wK = c,
                                .tangent = true,
                                .Q = in->step.Q,
                                .y_new = in->element.y,
                                .out = in->element.out,
                                .potential = in->element.potential};
  ali3_forces(in, &call);
  ali3_rows_transposed(S, in->tangent.J, v->lam, in->step.r);
  for (int32_t i = 0; i < S->size.nq; i++) {
    scale = fmax(scale, fabs(in->step.Q[i]));
    in->step.r[i] = in->step.d0[i] * (in->step.r[i] - in->step.Q[i]);
    if (!(fabs(in->step.r[i]) <= largest) && largest == largest) { /* keeps a NaN */
      largest = fabs(in->step.r[i]);
      in->report.worst_coordinate = i;
    }
  }
  in->report.residual = largest;
  in->report.violation = ali3_violation(S, in->step.Phi, &in->report.worst_row);
  *largest_force = fmax(*largest_force, scale);
  return largest <= ROUND_OFF * scale ? 0.0 : largest;
}

/* T = M + c (K + sum lam_k H_k) + penalty Phi_q' Phi_q, its diagonal larger by the part `more`; an indefinite T gives no
 * descent direction. */
static ali3_status factorise(ali3_instance *in, double c, double penalty, double more) {
  const ali3_system *S = in->system;
  ali3_mass_to_fronts(in, in->tangent.F);
  for (int32_t i = 0; i < S->size.nq; i++) in->tangent.F[S->diagonal_pos[i]] += in->mass.missing[i];
  ali3_rows_square(in, in->tangent.J, penalty, in->tangent.F);
  ali3_geometric(in, in->next.q, in->next.s, in->next.lam, c, in->tangent.F);
  ali3_forces_tangent(in, in->tangent.F);
  for (int32_t i = 0; i < S->size.nq; i++) {
    const int32_t pos = S->diagonal_pos[i];
    in->step.d0[i] = in->tangent.F[pos] == in->mass.front[pos] + in->mass.missing[i] ? in->step.w[i] : 1.0;
    in->step.r[i] *= in->step.d0[i];
    in->tangent.F[pos] += more * in->tangent.F[pos];
  }
  const ali3_status status = ali3_factorise(in, in->tangent.F);
  return status == ALI3_OK && in->report.negative_pivots > 0 ? ALI3_SINGULAR : status;
}

/* Newton step, shortened by the factor *step_fraction to `limit` m and MAX_STEP rad. */
static ali3_status newton_step(ali3_instance *in, double c, double limit, double *step_fraction) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  double *lam = in->next.lam, longest = 0.0;
  for (int32_t k = 0; k < nc; k++) in->step.mu[k] = PENALTY * in->step.Phi[k];
  ali3_rows_transposed(S, in->tangent.J, in->step.mu, in->step.x);
  for (int32_t i = 0; i < nq; i++) in->step.x[i] = -(c * in->step.r[i] + in->step.x[i]);
  ali3_solve(in, in->tangent.F, in->step.x);
  if (!ali3_finite(in->step.x, nq)) return ALI3_NOT_FINITE;
  const double per_radian = limit / MAX_STEP;
  for (int64_t k = 0; k < S->n_angle_row; k++) in->step.x[S->angle_theta_col[k]] *= per_radian;
  for (int32_t i = 0; i < nq; i++)
    if (fabs(in->step.x[i]) > longest) longest = fabs(in->step.x[i]);
  for (int64_t k = 0; k < S->n_angle_row; k++) in->step.x[S->angle_theta_col[k]] /= per_radian;
  *step_fraction = longest > limit ? limit / longest : 1.0;
  ali3_rows_times(S, in->tangent.J, in->step.x, in->step.gamma);
  for (int32_t k = 0; k < nc; k++) lam[k] += *step_fraction * PENALTY / c * (in->step.Phi[k] + in->step.gamma[k]);
  for (int32_t i = 0; i < nq; i++) in->next.q[i] += *step_fraction * in->step.x[i];
  return ALI3_OK;
}

/* Marks coordinates that gravity or rows act on. */
static void mark_holdable(ali3_instance *in) {
  const ali3_system *S = in->system;
  for (int32_t i = 0; i < S->size.nq; i++) {
    in->step.w[i] = in->mass.gravity[i] == 0.0 ? 0.0 : 1.0;
    in->step.d0[i] = 1.0;
  }
  for (int32_t k = 0; k < S->size.nnz_rows; k++) in->step.w[S->row_col[k]] = 1.0;
}

/* Iterates from in->now to the equilibrium in in->next with its states in in->element.y. */
static ali3_status iterate(ali3_instance *in, double tolerance, int32_t max_iterations, double h) {
  ali3_status status = ALI3_OK;
  ali3_vectors_copy(in, &in->next, &in->now);
  memset(in->next.qd, 0, (size_t)in->system->size.nq * sizeof(double));
  mark_holdable(in);
  const double size = in->system->fine, closed = size * CLOSED, open = size * OPEN;
  double c = size * FIRST_C, limit = size * MAX_STEP, force = 0.0, residual = evaluate_residual(in, c, h, &force);
  int32_t iteration = 0, whole = 0; /* iterations; of these with the whole step */
  for (; iteration < max_iterations; iteration++) {
    if (!(residual < 1e300) || !(in->report.violation < 1e300)) return ALI3_NOT_FINITE;
    /* small forces, and moments of a small drawing, may be far below the tolerance before they balance */
    const double balanced = fmin(tolerance, BALANCE * fmin(1.0, size) * force);
    if (iteration > 0 && residual <= balanced && in->report.violation <= closed) break;
    while ((status = factorise(in, c, PENALTY, 0.0)) == ALI3_SINGULAR && c > size * MIN_C) {
      c *= 0.25;
      evaluate_residual(in, c, h, &force);
    }
    double step_fraction = 1.0;
    if (status == ALI3_OK) status = newton_step(in, c, limit, &step_fraction);
    if (status != ALI3_OK) return status;
    const double previous = residual, previous_c = c, previous_violation = in->report.violation;
    residual = evaluate_residual(in, c, h, &force);
    whole += step_fraction == 1.0;
    if (step_fraction < 1.0) limit = residual < previous ? 2.0 * limit : fmax(0.5 * limit, size * MAX_STEP);
    const bool rows_close = in->report.violation <= closed || in->report.violation < 0.5 * previous_violation;
    if (step_fraction < 1.0 || residual > 4.0 * previous)
      c = fmax(0.5 * c, size * MIN_C);
    else if (whole > SLOW && !rows_close)
      c = fmax(0.25 * c, size * FIRST_C);
    else if (in->report.violation <= open)
      c = fmin(4.0 * c, size * MAX_C);
    if (c != previous_c) residual = evaluate_residual(in, c, h, &force); /* the tangents of elements include c */
  }
  in->report.last_iterations = iteration;
  const bool balanced = residual <= fmax(tolerance, ROUND_OFF * force);
  return balanced && in->report.violation <= closed ? ALI3_OK : ALI3_NOT_CONVERGED;
}

ali3_status ali3_solve_static(ali3_instance *in, double t, double tolerance, int32_t max_iterations) {
  const ali3_system *S = in->system;
  memset(in->now.qd, 0, (size_t)S->size.nq * sizeof(double));
  ali3_status status = ali3_solve_initial(in, t);
  if (status != ALI3_OK) return status;
  ali3_held_motion start;
  const bool floats = S->size.has_pose && ali3_measure_held_motion(in, &start);
  double h = 0.0;
  status = iterate(in, tolerance, max_iterations, h);
  if (status != ALI3_OK && S->size.ny > 0) status = iterate(in, tolerance, max_iterations, h = LONG);
  if (status != ALI3_OK) return status;
  double force = 0.0;
  const double longest_c = S->fine * MAX_C;
  const bool complete =
      S->size.ny == 0 || h > 0.0; /* undeflected friction may hold what falls by the stiffness alone */
  /* of a stable equilibrium T is positive from some penalty on, which grows with the stiffness of flexible bodies */
  for (double penalty = PENALTY; complete && penalty <= MAX_PENALTY; penalty *= 10.0) {
    evaluate_residual(in, longest_c, h, &force);
    status = factorise(in, longest_c, penalty, ROUND_OFF * PENALTY / penalty);
    if (status != ALI3_SINGULAR) break;
  }
  if (status != ALI3_OK && status != ALI3_SINGULAR) return status;
  const int32_t negative_pivots = complete ? in->report.negative_pivots : 0;
  if (h > 0.0) memcpy(in->now.y, in->element.y, (size_t)S->size.ny * sizeof(double));
  memcpy(in->now.q, in->next.q, (size_t)S->size.nq * sizeof(double));
  memset(in->now.qd, 0, (size_t)S->size.nq * sizeof(double));
  const double heading_change = floats ? fabs(ali3_heading_change(in, &start)) : 0.0;
  if (heading_change > TURNED && heading_change < HELD) ali3_restore_motion(in, &start, 0.0);
  status = ali3_solve_rates(in, true);
  in->report.negative_pivots = negative_pivots;
  return status;
}
