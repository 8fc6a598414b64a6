/* What a reader of an energy-momentum state sees: velocities on the constraints with the kinetic energy of the carried
 * ones, accelerations, multipliers, outputs. */
#include <math.h>
#include <string.h>

#include "ali3_internal.h"

enum { MAX_SWEEPS = 3 };
static const double VELOCITY_TOLERANCE = 1e-11, ACCELERATION_TOLERANCE = 1e-6;
static const double LEAST_RATIO = 0.5, MOST_RATIO = 2.0; /* of kinetic energies that may be made equal */

/* As ali3_project, with the unsymmetric tangent; the part of v that is taken away is spread by A. */
static double project(ali3_instance *in, double weight, const double *b, double *v, double tolerance) {
  const ali3_system *S = in->system;
  double violation = 0.0;
  for (int32_t sweep = 0; !ali3_rates_closed(in, b, v, tolerance, &violation) && sweep < MAX_SWEEPS; sweep++) {
    for (int32_t k = 0; k < S->size.nc; k++) in->mu[k] *= weight;
    ali3_rows_transposed(S, in->A_tangent, in->mu, in->x);
    ali3_solve_lu(in, 1, in->F, in->x);
    for (int32_t i = 0; i < S->size.nq; i++) v[i] -= in->x[i];
  }
  return violation;
}

/* qd on the constraints with the kinetic energy of v->own, accelerations and multipliers from the last two middles,
 * outputs of the elements. Needs Phi_q in in->J and a factorised tangent. */
void ali3_energy_momentum_complete(ali3_instance *in, ali3_vectors *v, double weight) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  const double *time = v->memory + ALI3_MEMORY_TIME;
  const bool two = v->memory[ALI3_MEMORY_COUNT] >= 2.0;
  const double second = two ? time[0] / (time[1] - time[0]) : 0.0, first = 1.0 - second;
  ali3_constraint_rate(in, v->q, v, in->Phit);
  memcpy(v->qd, v->own, (size_t)nq * sizeof(double));
  in->report.velocity_violation = project(in, weight, in->Phit, v->qd, VELOCITY_TOLERANCE);
  const ali3_force_call call = {v->q, v->qd, v->y, 0.0, 0.0, 0.0, false, in->Q, in->y_work, v->out, v->potential};
  ali3_forces(in, &call);
  const double ratio = ali3_mass_product(in, v->own, v->own, in->x) / ali3_mass_product(in, v->qd, v->qd, in->x);
  bool driven = false;
  for (int32_t k = 0; k < nc; k++) driven = driven || in->Phit[k] != 0.0;
  if (!driven && ratio > LEAST_RATIO && ratio < MOST_RATIO) {
    const double scale = sqrt(ratio);
    for (int32_t i = 0; i < nq; i++) v->qd[i] *= scale;
  }
  for (int32_t i = 0; i < nq; i++) v->qdd[i] = first * v->past_a[i] + (two ? second * v->past_a[nq + i] : 0.0);
  for (int32_t k = 0; k < nc; k++) v->lam[k] = first * v->past_lam[k] + (two ? second * v->past_lam[nc + k] : 0.0);
  ali3_constraint_gamma(in, v->q, v->qd, v, in->gamma);
  project(in, weight, in->gamma, v->qdd, ACCELERATION_TOLERANCE);
}

void ali3_energy_momentum_report(ali3_instance *in) {
  const ali3_system *S = in->system;
  const double weight = ali3_energy_momentum_penalty(in, in->h_last > 0.0 ? in->h_last : 1.0);
  ali3_constraints(in, in->now.q, in->now.s, in->Phi, in->J);
  memcpy(in->A_tangent, in->J, (size_t)S->size.nnz_rows * sizeof(double));
  memcpy(in->F, S->front_mass, (size_t)S->size.front_size * sizeof(double));
  if (S->n_flexible > 0) {
    ali3_flexible_prepare(in, in->now.q);
    ali3_flexible_tangent(in, 1.0, 0.0, 0.0, in->F);
  }
  ali3_mirror(in, in->F);
  ali3_rows_product(in, in->J, in->J, weight, in->F);
  if (ali3_factorise_lu(in, 1, in->F) == ALI3_OK) ali3_energy_momentum_complete(in, &in->now, weight);
}
