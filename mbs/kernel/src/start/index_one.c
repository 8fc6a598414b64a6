/* Equations of index one at given positions and velocities: M qdd + Phi_q' lam = Q, Phi_q qdd = -gamma, by the
 * augmented Lagrangian, which also converges with redundant rows. */
#include <math.h>
#include <string.h>

#include "../algebra/finite.h"
#include "../algebra/fronts.h"
#include "../elements/forces.h"
#include "../flexible/bodies.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "index_one.h"

/* Solutions of ali3_index_one, of which the second one corrects round-off; most of ali3_index_one_solve. */
enum { SOLVES = 2, ITERATIONS = 60 };
static const double ALPHA = ALI3_INDEX_ONE_PENALTY;

ali3_status ali3_index_one(ali3_instance *in, ali3_vectors *v) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  ali3_constraints(in, v->q, v->s, in->step.Phi, in->tangent.J);
  ali3_constraint_gamma(in, v->q, v->qd, v, in->step.gamma);
  const ali3_force_call call = ali3_forces_at(in, v);
  ali3_forces(in, &call);
  ali3_mass_to_fronts(in, in->tangent.F);
  if (S->n_flexible + S->n_lookup > 0) ali3_bodies_tangent(in, 1.0, 0.0, 0.0, in->tangent.F);
  ali3_rows_square(in, in->tangent.J, ALPHA, in->tangent.F);
  const ali3_status status = ali3_factorise(in, in->tangent.F);
  if (status != ALI3_OK) return status;
  for (int solve = 0; solve < SOLVES; solve++) {
    ali3_rows_times(S, in->tangent.J, v->qdd, in->step.mu);
    for (int32_t k = 0; k < nc; k++) in->step.mu[k] = v->lam[k] + ALPHA * (in->step.mu[k] + in->step.gamma[k]);
    ali3_rows_transposed(S, in->tangent.J, in->step.mu, in->step.x);
    ali3_mass_times(in, v->qdd, in->step.r);
    for (int32_t i = 0; i < nq; i++) in->step.x[i] = in->step.Q[i] - in->step.r[i] - in->step.x[i];
    ali3_solve(in, in->tangent.F, in->step.x);
    for (int32_t i = 0; i < nq; i++) v->qdd[i] += in->step.x[i];
    ali3_rows_times(S, in->tangent.J, in->step.x, v->lam);
    for (int32_t k = 0; k < nc; k++) v->lam[k] = in->step.mu[k] + ALPHA * v->lam[k];
  }
  in->report.iterations++;
  return ali3_finite(v->qdd, nq) ? ALI3_OK : ALI3_NOT_FINITE;
}

ali3_status ali3_index_one_factorise(ali3_instance *in, const double *q) {
  ali3_bodies_prepare(in, q);
  ali3_mass_to_fronts(in, in->tangent.F);
  ali3_rows_square(in, in->tangent.J, ALPHA, in->tangent.F);
  ali3_bodies_tangent(in, 1.0, 0.0, 0.0, in->tangent.F);
  return ali3_factorise(in, in->tangent.F);
}

/* Where b and Phi_q x are zero except for round-off, the violation has no scale, and ITERATIONS end the loop. */
ali3_status ali3_index_one_solve(ali3_instance *in, const double *Q, const double *b, double tolerance, double *x,
                                 double *lam) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  memset(x, 0, (size_t)nq * sizeof(double));
  memset(lam, 0, (size_t)nc * sizeof(double));
  for (int iteration = 0; iteration < ITERATIONS; iteration++) {
    double force = 0.0, force_scale = 0.0, violation = 0.0, violation_scale = 0.0;
    ali3_mass_times(in, x, in->step.r);
    ali3_rows_transposed(S, in->tangent.J, lam, in->step.x);
    ali3_rows_times(S, in->tangent.J, x, in->step.mu);
    for (int32_t i = 0; i < nq; i++) {
      in->step.r[i] -= Q[i];
      force = fmax(force, fabs(in->step.r[i] + in->step.x[i]) * in->mass.floor_inverse[i]);
      force_scale = fmax(force_scale, (fabs(in->step.r[i]) + fabs(in->step.x[i])) * in->mass.floor_inverse[i]);
    }
    for (int32_t k = 0; k < nc; k++) {
      violation_scale = fmax(violation_scale, fabs(in->step.mu[k]) + fabs(b[k]));
      in->step.mu[k] += b[k];
      violation = fmax(violation, fabs(in->step.mu[k]));
      in->step.mu[k] = lam[k] + ALPHA * in->step.mu[k];
    }
    if (force <= tolerance * force_scale && violation <= tolerance * violation_scale) break;
    ali3_rows_transposed(S, in->tangent.J, in->step.mu, in->step.x);
    for (int32_t i = 0; i < nq; i++) in->step.x[i] = -(in->step.r[i] + in->step.x[i]);
    ali3_solve(in, in->tangent.F, in->step.x);
    if (!ali3_finite(in->step.x, nq)) return ALI3_NOT_FINITE;
    for (int32_t i = 0; i < nq; i++) x[i] += in->step.x[i];
    ali3_rows_times(S, in->tangent.J, in->step.x, in->step.Phi);
    for (int32_t k = 0; k < nc; k++) lam[k] = in->step.mu[k] + ALPHA * in->step.Phi[k];
  }
  return ALI3_OK;
}
