/* Consistent start: nearest position on Phi = 0 in the metric of mass and bending stiffness, nearest velocities in the
 * mass metric, then accelerations and multipliers. All three are proximal augmented Lagrangian iterations, which also
 * converge for a rank-deficient Phi_q. */
#include <math.h>
#include <string.h>

#include "../algebra/finite.h"
#include "../algebra/fronts.h"
#include "../elements/forces.h"
#include "../flexible/bodies.h"
#include "../flexible/flexible_body.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "../rows/driving_functions.h"
#include "../rows/velocity_rows.h"
#include "../rows/violation.h"
#include "../state/road_files.h"
#include "../state/work.h"
#include "index_one.h"
#include "initialise.h"

static const double ALPHA = ALI3_INDEX_ONE_PENALTY;
static const double CLOSED = 1e-12; /* m: violation that counts as closed */
static const double ASSEMBLED = 1e-9; /* m: largest violation accepted when the iteration makes no further progress */
static const double MAX_STEP = 0.5; /* m or rad per iteration */
/* S^2: factor on K in the metric of positions, large enough that bodies move rather than bend. */
static const double BENDING = 1.0;
static const double ROUND_OFF = 1e-13;
enum { POSITION_ITERATIONS = 200 };

/* F = M(q) + floor of massless coordinates + BENDING K + ALPHA Phi_q' Phi_q, factorised. */
static ali3_status factorise_metric(ali3_instance *in, const double *q) {
  const ali3_system *S = in->system;
  ali3_bodies_prepare(in, q);
  ali3_mass_to_fronts(in, in->tangent.F);
  for (int32_t i = 0; i < S->size.nq; i++) in->tangent.F[S->diagonal_pos[i]] += in->mass.missing[i];
  ali3_rows_square(in, in->tangent.J, ALPHA, in->tangent.F);
  ali3_bodies_tangent(in, 1.0, 0.0, 0.0, in->tangent.F);
  ali3_flexible_stiffen(in, BENDING, in->tangent.F);
  return ali3_factorise(in, in->tangent.F);
}

/* Minimises w' (M + BENDING K) w on Phi = 0, w: displacement from the given position, accumulated, as a difference of
 * positions far from the origin loses digits. */
static ali3_status close_position(ali3_instance *in) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  double *q = in->next.q, *lam = in->next.lam, *w = in->step.w;
  memcpy(q, in->now.q, (size_t)nq * sizeof(double));
  memset(w, 0, (size_t)nq * sizeof(double));
  memset(lam, 0, (size_t)nc * sizeof(double));
  for (int iteration = 0;; iteration++) {
    ali3_constraints(in, q, in->now.s, in->step.Phi, in->tangent.J);
    ali3_velocity_release(in, in->tangent.J);
    in->report.violation = ali3_violation(S, in->step.Phi, &in->report.worst_row);
    if (in->report.violation <= CLOSED) break;
    if (!(in->report.violation < 1e300)) return ALI3_NOT_ASSEMBLED;
    if (iteration == POSITION_ITERATIONS)
      return ali3_opening(S, in->step.Phi) <= ASSEMBLED ? ALI3_OK : ALI3_NOT_ASSEMBLED;
    const ali3_status status = factorise_metric(in, q);
    if (status != ALI3_OK) return status;
    ali3_mass_times(in, w, in->step.r);
    ali3_flexible_elastic(in, BENDING, w, in->step.r);
    for (int32_t k = 0; k < nc; k++) in->step.mu[k] = lam[k] + ALPHA * in->step.Phi[k];
    ali3_rows_transposed(S, in->tangent.J, in->step.mu, in->step.x);
    for (int32_t i = 0; i < nq; i++) in->step.x[i] = -(in->step.r[i] + in->mass.missing[i] * w[i] + in->step.x[i]);
    ali3_solve(in, in->tangent.F, in->step.x);
    if (!ali3_finite(in->step.x, nq)) return ALI3_NOT_FINITE;
    double longest = 0.0;
    for (int32_t i = 0; i < nq; i++)
      if (fabs(in->step.x[i]) > longest) longest = fabs(in->step.x[i]);
    const double step_fraction = longest > MAX_STEP ? MAX_STEP / longest : 1.0;
    ali3_rows_times(S, in->tangent.J, in->step.x, in->step.gamma);
    for (int32_t k = 0; k < nc; k++) /* a shortened step gives no estimate of the multipliers */
      lam[k] = step_fraction < 1.0 ? 0.0 : in->step.mu[k] + ALPHA * in->step.gamma[k];
    for (int32_t i = 0; i < nq; i++) {
      w[i] += step_fraction * in->step.x[i];
      q[i] += step_fraction * in->step.x[i];
    }
  }
  memcpy(in->now.q, q, (size_t)nq * sizeof(double));
  return ALI3_OK;
}

/* Nearest velocity to the given one in the mass metric: M dv + Phi_q' mu = 0, Phi_q (v + dv) + Phi_t = 0. */
static ali3_status close_velocity(ali3_instance *in) {
  const ali3_system *S = in->system;
  ali3_vectors *v = &in->now;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  ali3_constraint_rate(in, v->q, v, in->step.Phit);
  ali3_rows_times(S, in->tangent.J, v->qd, in->step.gamma);
  for (int32_t k = 0; k < nc; k++) in->step.gamma[k] += in->step.Phit[k];
  memset(in->step.D, 0, (size_t)nq * sizeof(double));
  const ali3_status status = ali3_index_one_solve(in, in->step.D, in->step.gamma, ROUND_OFF, in->step.w, in->step.lam);
  if (status != ALI3_OK) return status;
  for (int32_t i = 0; i < nq; i++) v->qd[i] += in->step.w[i];
  ali3_rows_times(S, in->tangent.J, v->qd, in->step.gamma);
  for (int32_t k = 0; k < nc; k++) in->step.gamma[k] += in->step.Phit[k];
  int32_t worst = 0;
  in->report.velocity_violation = ali3_violation(S, in->step.gamma, &worst);
  return ALI3_OK;
}

ali3_status ali3_solve_rates(ali3_instance *in, bool start) {
  const ali3_system *S = in->system;
  ali3_vectors *v = &in->now;
  ali3_constraints(in, v->q, v->s, in->step.Phi, in->tangent.J);
  ali3_status status = ali3_index_one_factorise(in, v->q);
  if (status == ALI3_OK) status = close_velocity(in);
  if (status != ALI3_OK) return status;
  ali3_constraint_gamma(in, v->q, v->qd, v, in->step.gamma);
  const ali3_force_call call = {.q = v->q,
                                .qd = v->qd,
                                .y_old = v->y,
                                .Q = in->step.Q,
                                .y_new = in->element.y,
                                .out = v->out,
                                .potential = v->potential};
  memcpy(v->used, in->inputs.set, (size_t)S->size.nu * sizeof(double));
  memcpy(v->y_last, v->y, (size_t)S->size.ny * sizeof(double));
  v->h_last[0] = 0.0;
  ali3_forces(in, &call);
  if (start) {
    ali3_forces_accept(in, &call);
    memcpy(v->y, in->element.y, (size_t)S->size.ny * sizeof(double));
    ali3_forces(in, &call);
  }
  if (!ali3_finite(in->step.Q, S->size.nq)) return ALI3_NOT_FINITE;
  ali3_work_store(in, v);
  if (start) ali3_work_start(in, v);
  if (S->n_flexible > 0) {
    memcpy(v->mean, v->qd, (size_t)S->size.nq * sizeof(double));
    memcpy(v->mean_before, v->qd, (size_t)S->size.nq * sizeof(double));
  }
  status = ali3_index_one_solve(in, in->step.Q, in->step.gamma, ROUND_OFF, v->qdd, v->lam);
  if (status != ALI3_OK) return status;
  return ali3_finite(v->q, (int64_t)in->stored.n) ? ali3_roads_status(in) : ALI3_NOT_FINITE;
}

ali3_status ali3_solve_initial(ali3_instance *in, double t) {
  ali3_driving_start(in, &in->now, t);
  const ali3_status status = close_position(in);
  return status == ALI3_OK ? ali3_solve_rates(in, true) : status;
}
