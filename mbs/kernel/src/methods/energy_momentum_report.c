/* Report of an energy-momentum state: velocities on the constraints with the kinetic energy of the carried ones,
 * accelerations, multipliers, outputs. */
#include <math.h>
#include <string.h>

#include "../algebra/fronts.h"
#include "../elements/forces.h"
#include "../flexible/bodies.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "../start/index_one.h"
#include "../state/vectors.h"
#include "energy_momentum.h"
#include "projection.h"

enum { MAX_SWEEPS = 3 };
static const double VELOCITY_TOLERANCE = 1e-11, ROUND_OFF = 1e-11;
static const double MIN_RATIO = 0.5, MAX_RATIO = 2.0; /* of kinetic energies that may be made equal */

static const double SAME_STEP = 1e-6; /* relative difference of two steps that counts as none */

/* Gives v the kinetic energy of v->own, except where a drive sets the velocity or much was taken away. */
static void scale(ali3_instance *in, const ali3_vectors *v) {
  const int32_t nq = in->system->size.nq;
  ali3_bodies_prepare(in, v->q);
  const double ratio =
      ali3_mass_product(in, v->own, v->own, in->step.x) / ali3_mass_product(in, v->qd, v->qd, in->step.x);
  for (int32_t k = 0; k < in->system->size.nc; k++)
    if (in->step.Phit[k] != 0.0) return;
  if (!(ratio > MIN_RATIO && ratio < MAX_RATIO)) return;
  const double factor = sqrt(ratio);
  for (int32_t i = 0; i < nq; i++) v->qd[i] *= factor;
}

/* Carried velocities of a System with flexible bodies: projects v->own onto the rows with the tangent of the step,
 * which is unsymmetric and spreads the part that A removes. Needs Phi_q in in->tangent.J. */
void ali3_energy_momentum_carry(ali3_instance *in, ali3_vectors *v, double weight) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  double violation;
  ali3_constraint_rate(in, v->q, v, in->step.Phit);
  memcpy(v->qd, v->own, (size_t)nq * sizeof(double));
  for (int sweep = 0; sweep < MAX_SWEEPS; sweep++) {
    if (ali3_rates_closed(in, in->step.Phit, v->qd, VELOCITY_TOLERANCE, 0.0, &violation)) break;
    for (int32_t k = 0; k < S->size.nc; k++) in->step.mu[k] *= weight;
    ali3_rows_transposed(S, in->discrete.A_made, in->step.mu, in->step.x);
    ali3_solve_lu(in, 1, in->tangent.F, in->step.x);
    for (int32_t i = 0; i < nq; i++) v->qd[i] -= in->step.x[i];
  }
  scale(in, v);
  memcpy(v->own, v->qd, (size_t)nq * sizeof(double));
}

/* v->qd is the carried velocity without what it has off the rows, taken away in the metric of the masses: multipliers
 * move velocities along M^-1 Phi_q', and any other direction would leave driven motion with one order less. v->qdd and
 * v->lam are those of the forces there: of the order of positions and velocities, and of nothing but the state,
 * whatever steps led to it. Middles of past steps would give them less accurately: the error of the carried velocity
 * along rows of prescribed motion changes its sign from step to step. Needs Phi_q in in->tangent.J. */
ali3_status ali3_energy_momentum_complete(ali3_instance *in, ali3_vectors *v) {
  const ali3_system *S = in->system;
  const int64_t factorizations = in->report.factorizations, solves = in->report.solves;
  const ali3_force_call call = {.q = v->q,
                                .qd = v->qd,
                                .y_old = v->y,
                                .Q = in->step.Q,
                                .y_new = in->element.y,
                                .out = v->out,
                                .potential = v->potential};
  ali3_status status = ali3_index_one_factorise(in, v->q);
  if (status == ALI3_OK) {
    memcpy(in->tangent.J_made, in->tangent.J, (size_t)S->size.nnz_rows * sizeof(double));
    memcpy(v->qd, v->own, (size_t)S->size.nq * sizeof(double));
    ali3_constraint_rate(in, v->q, v, in->step.Phit);
    in->report.velocity_violation = ali3_project(in, ALI3_INDEX_ONE_PENALTY, in->step.Phit, v->qd, NULL,
                                                 VELOCITY_TOLERANCE, 0.0, MAX_SWEEPS, false);
    scale(in, v);
    ali3_constraint_gamma(in, v->q, v->qd, v, in->step.gamma);
    ali3_forces(in, &call);
    status = ali3_index_one_solve(in, in->step.Q, in->step.gamma, ROUND_OFF, v->qdd, v->lam);
  }
  in->report.factorizations = factorizations; /* factorizations of steps are counted */
  in->report.solves = solves;
  return status;
}

void ali3_energy_momentum_report(ali3_instance *in) {
  ali3_constraints(in, in->now.q, in->now.s, in->step.Phi, in->tangent.J);
  ali3_energy_momentum_complete(in, &in->now);
}

/* Before a step of h: the carried velocity goes to the reported one where steps change. What it has off the rows has
 * the size that belongs to the step it comes from; in a step a hundred times as short it would be a force a hundred
 * times as large, as it would stay what it is. */
void ali3_energy_momentum_restart(ali3_instance *in, double h, bool controlled) {
  const double *history = in->now.history, last = -2.0 * history[ALI3_HISTORY_TIME];
  if (history[ALI3_HISTORY_OWNER] != (double)ALI3_METHOD_ENERGY_MOMENTUM || !(history[ALI3_HISTORY_COUNT] >= 1.0))
    return;
  if (!controlled && fabs(h - last) <= SAME_STEP * fabs(h)) return;
  ali3_back_up(in);
  if (!controlled) ali3_energy_momentum_report(in); /* where nothing was read nothing is reported yet */
  memcpy(in->now.own, in->now.qd, (size_t)in->system->size.nq * sizeof(double));
}
