/* What a reader of an energy-momentum state sees: velocities on the constraints with the kinetic energy of the carried
 * ones, accelerations, multipliers, outputs. */
#include <math.h>
#include <string.h>

#include "ali3_internal.h"

enum { MAX_SWEEPS = 3 };
static const double VELOCITY_TOLERANCE = 1e-11, ROUND_OFF = 1e-11;
static const double LEAST_RATIO = 0.5, MOST_RATIO = 2.0; /* of kinetic energies that may be made equal */

static const double SAME_STEP = 1e-6; /* relative difference of two steps that counts as none */

/* As ali3_project, with the unsymmetric tangent; the part of v that is taken away is spread by A. */
static double project(ali3_instance *in, double weight, const double *b, double *v) {
  const ali3_system *S = in->system;
  double violation = 0.0;
  for (int32_t sweep = 0; !ali3_rates_closed(in, b, v, VELOCITY_TOLERANCE, &violation) && sweep < MAX_SWEEPS; sweep++) {
    for (int32_t k = 0; k < S->size.nc; k++) in->mu[k] *= weight;
    ali3_rows_transposed(S, in->A_tangent, in->mu, in->x);
    ali3_solve_lu(in, 1, in->F, in->x);
    for (int32_t i = 0; i < S->size.nq; i++) v[i] -= in->x[i];
  }
  return violation;
}

/* qd on the constraints with the kinetic energy of v->own. Needs Phi_q in in->J and a factorised tangent. */
void ali3_energy_momentum_velocity(ali3_instance *in, ali3_vectors *v, double weight) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  ali3_constraint_rate(in, v->q, v, in->Phit);
  memcpy(v->qd, v->own, (size_t)nq * sizeof(double));
  in->report.velocity_violation = project(in, weight, in->Phit, v->qd);
  ali3_flexible_prepare(in, v->q);
  const double ratio = ali3_mass_product(in, v->own, v->own, in->x) / ali3_mass_product(in, v->qd, v->qd, in->x);
  for (int32_t k = 0; k < S->size.nc; k++)
    if (in->Phit[k] != 0.0) return; /* a drive sets the velocity */
  if (!(ratio > LEAST_RATIO && ratio < MOST_RATIO)) return;
  const double scale = sqrt(ratio);
  for (int32_t i = 0; i < nq; i++) v->qd[i] *= scale;
}

/* Accelerations and multipliers of the forces at the reported velocities, outputs of the elements: of the order of
 * positions and velocities, and of nothing but the state, whatever steps led to it. Middles of past steps would tell
 * them less well: the carried velocity errs in the direction of driven rows with a sign that changes from step to step,
 * its differences by one order more. Needs Phi_q in in->J; in->F becomes the factorised metric. */
ali3_status ali3_energy_momentum_forces(ali3_instance *in, ali3_vectors *v) {
  const ali3_force_call call = {v->q, v->qd, v->y, 0.0, 0.0, 0.0, false, in->Q, in->y_work, v->out, v->potential};
  ali3_constraint_gamma(in, v->q, v->qd, v, in->gamma);
  ali3_forces(in, &call);
  const int64_t factorizations = in->report.factorizations, solves = in->report.solves;
  ali3_status status = ali3_index_one_factorise(in, v->q);
  if (status == ALI3_OK) status = ali3_index_one_solve(in, in->Q, in->gamma, ROUND_OFF, v->qdd, v->lam);
  in->report.factorizations = factorizations; /* those of steps are counted */
  in->report.solves = solves;
  return status;
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
  if (ali3_factorise_lu(in, 1, in->F) != ALI3_OK) return;
  ali3_energy_momentum_velocity(in, &in->now, weight);
  ali3_energy_momentum_forces(in, &in->now);
}

/* Before a step of h: the carried velocity goes to the reported one where steps change. What it has off the rows has
 * the size that belongs to the step it comes from; in a step a hundred times as short it would be a force a hundred
 * times as large, as it would stay what it is. */
void ali3_energy_momentum_restart(ali3_instance *in, double h) {
  const double *memory = in->now.memory, last = -2.0 * memory[ALI3_MEMORY_TIME];
  if (memory[ALI3_MEMORY_OWNER] != (double)ALI3_METHOD_ENERGY_MOMENTUM || !(memory[ALI3_MEMORY_COUNT] >= 1.0)) return;
  if (!in->controlled && fabs(h - last) <= SAME_STEP * fabs(h)) return;
  ali3_keep(in);
  if (!in->controlled) ali3_energy_momentum_report(in); /* after a quiet step nothing is reported yet */
  memcpy(in->now.own, in->now.qd, (size_t)in->system->size.nq * sizeof(double));
}
