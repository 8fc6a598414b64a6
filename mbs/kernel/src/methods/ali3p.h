/* Equations of an ALi3-P step in the increment D = q_(n+1) - q_n, compiled for one instance and for lanes, which
 * control the iteration in their own ways (augmented_lagrangian.c, ../lanes/lane_step.h); numbers are those of the
 * paper, see docs/theory.md. */
#ifndef ALI3_ALI3P_H
#define ALI3_ALI3P_H
#include <math.h>

#include "../algebra/finite.h"
#include "../algebra/fronts.h"
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "../rows/turning.h"
#include "../rows/velocity_rows.h"
#include "defect_correction.h"
#include "energy_watch.h"
#include "newton.h"
#include "projection.h"

enum { MAX_SWEEPS = 3 };
/* Relative violations at which projections end: of velocities round-off; accelerations are only used in the next
 * prediction. */
static const double VELOCITY_TOLERANCE = 1e-12, ACCELERATION_TOLERANCE = 1e-9;
/* A tangent is reused if the violation is at most REUSE_VIOLATION h^2, with h at most 10 ms, and the last iteration
 * reduced the residual to REUSE_RESIDUAL or less. The remaining violation is an error of the multipliers where the
 * lever of a row vanishes. */
static const double CLOSES = 0.5; /* ratio of violations above which rows have converged as far as they can */
static const double REUSE_VIOLATION = 2e-5, REUSE_RESIDUAL = 0.3;

/* If the residual decreases, rates of signals change by less than REACH residuals times 2/h afterwards (`reach` of
 * ali3_element_args); used in Systems with flexible bodies, whose iterations are expensive. With an eighth of it some
 * steps did not converge; after MAX_SETTLING iterations sliders use their secants again. */
static const double REACH = 4.0;
enum { MAX_SETTLING = 12 };
/* Whether sliders use REACH after this number of iterations. */
static inline bool ali3_settles(const ali3_system *S, int32_t iterations) {
  return ali3_defect_corrected(S) && iterations <= MAX_SETTLING;
}

/* Round-off of positions, m, that projections may leave in rates: its effect on accelerations and multipliers is small
 * against that of gravity. */
static inline double ali3_allowed_round_off(const ali3_system *S, double c) {
  return fmin(S->largest_round, ACCELERATION_TOLERANCE * S->fall * c);
}

/* Rule of a step h, s: trapezoidal (17), (18). */
ALI3_INLINED void trapezoidal(ali3_instance *in, double h) {
  const ali3_rule rule = {.c = 0.25 * h * h, .rate = 2.0 / h, .wC = 0.5 * h};
  in->rule = rule;
  const real *qd = in->now.qd, *qdd = in->now.qdd;
  real *d0 = in->step.d0, *hat = in->step.hat;
  ALI3_EACH(0, in->system->size.nq, ALI3_AT(d0) = h * ALI3_AT(qd) + rule.c * ALI3_AT(qdd); ALI3_AT(hat) = -ALI3_AT(qd))
}

/* Positions, rates and rows of the iterate D. */
ALI3_INLINED void place_iterate(ali3_instance *in) {
  const double rate = in->rule.rate;
  const real *from = in->now.q, *D = in->step.D, *d0 = in->step.d0, *hat = in->step.hat;
  real *q = in->next.q, *qd = in->next.qd, *w = in->step.w;
  ALI3_EACH(0, in->system->size.nq, ALI3_AT(q) = ALI3_AT(from) + ALI3_AT(D);
            ALI3_AT(qd) = rate * ALI3_AT(D) + ALI3_AT(hat); ALI3_AT(w) = ALI3_AT(D) - ALI3_AT(d0))
  ali3_constraints(in, in->next.q, in->next.s, in->step.Phi, in->tangent.J);
  if (in->system->n_velocity_row > 0) ali3_velocity_values(in, in->tangent.J, in->next.qd, rate, in->step.Phi);
}

/* Residual r = M (D - d0) - c Q of the iterate that place_iterate has placed, without multipliers, with its forces. */
ALI3_INLINED void find_residual(ali3_instance *in) {
  const double c = in->rule.c;
  const real *Q = in->step.Q;
  real *r = in->step.r;
  ali3_mass_times(in, in->step.w, r);
  ALI3_EACH(0, in->system->size.nq, ALI3_AT(r) -= c * ALI3_AT(Q))
}

/* Residual of (20), r + c Phi_q' lam, to in->step.x. */
ALI3_INLINED void add_row_forces(ali3_instance *in) {
  const double c = in->rule.c;
  const real *r = in->step.r;
  real *x = in->step.x;
  ali3_rows_transposed(in->system, in->tangent.J, in->next.lam, x);
  ALI3_EACH(0, in->system->size.nq, ALI3_AT(x) = ALI3_AT(r) + c * ALI3_AT(x))
}

/* One Newton correction (21) and the linearised multiplier update of some lanes; returns those in which it is finite.
 * `reused`: the tangent belongs to an earlier iterate, and in->step.x has the residual of (20). `accelerated`: the
 * correction is combined with the one before it. The penalty uses the Phi_q of the tangent, as it would amplify the
 * part of a later Phi_q outside its range. */
ALI3_INLINED lane_mask correct(ali3_instance *in, double h, double alpha, lane_mask lanes, int32_t iteration,
                               lane_mask reused, lane_mask accelerated) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  const double c = in->rule.c;
  real *lam = in->next.lam, *mu = in->step.mu, *x = in->step.x, *D = in->step.D, *change = in->step.lam;
  const real *r = in->step.r, *Phi = in->step.Phi, *w = in->step.w, *opening = in->step.gamma;
  ALI3_AT_WORK(in, lanes);
  ALI3_EACH(0, nc, ALI3_AT(mu) = ali3_where(reused, 0.0 + alpha * ALI3_AT(Phi), ALI3_AT(lam) + alpha * ALI3_AT(Phi)))
  ali3_rows_transposed(S, in->tangent.J_made, mu, in->step.w);
  ALI3_EACH(0, nq, ALI3_AT(x) = -(ali3_where(reused, ALI3_AT(x), ALI3_AT(r)) + c * ALI3_AT(w)))
  ali3_solve(in, in->tangent.F, x);
  const lane_mask finite = ali3_finite_inlined(x, nq);
  if (!ali3_any(finite)) return finite;
  if (ali3_defect_corrected(S)) ali3_defect_correction(in, h, iteration, lanes & finite);
  if (in->settings.update == ALI3_UPDATE_LINEARISED) {
    ali3_rows_times(S, in->tangent.J_made, x, in->step.gamma);
    ALI3_EACH(0, nc, ALI3_AT(change) = alpha * (ALI3_AT(Phi) + ALI3_AT(opening)))
    ali3_accelerate(in, accelerated);
    ALI3_EACH(0, nc, ALI3_AT(lam) = ALI3_OF_LANES(lanes, ALI3_AT(lam) + ALI3_AT(change), ALI3_AT(lam)))
  }
  ALI3_EACH(0, nq, ALI3_AT(D) = ALI3_OF_LANES(lanes, ALI3_AT(D) + ALI3_AT(x), ALI3_AT(D)))
  return finite;
}

/* Accelerations at the end of the step by its rule. */
ALI3_INLINED void find_accelerations(ali3_instance *in) {
  const double c = in->rule.c;
  const real *D = in->step.D, *d0 = in->step.d0;
  real *qdd = in->next.qdd;
  ALI3_EACH(0, in->system->size.nq, ALI3_AT(qdd) = (ALI3_AT(D) - ALI3_AT(d0)) / c)
}

/* Energy of a step, J, and the power, W, of the forces that its last projection leaves unbalanced. */
typedef struct {
  real error, kinetic, end; /* kinetic, end: as ali3_projection_work writes them */
  real open, driving_work;
} step_energy;

/* Projections (24), (25) of velocities and accelerations of some lanes; in->step.Phit holds the rates of the rows.
 * open_power: of the last step; its work in this one is part of the error. *violation: of velocities before, m/s. */
ALI3_INLINED step_energy project_rates(ali3_instance *in, double h, double alpha, lane_mask lanes, real open_power,
                                       real *violation) {
  const double c = in->rule.c, limit = ali3_allowed_round_off(in->system, c);
  ali3_vectors *to = &in->next;
  step_energy e;
  e.error = ali3_constraint_work(in, h, &e.driving_work);
  turning_rates(in, in->step.mu, in->step.Phit);
  ALI3_AT_WORK(in, lanes);
  *violation = ali3_project(in, c * alpha, in->step.Phit, to->qd, NULL, VELOCITY_TOLERANCE, limit * in->rule.rate,
                            MAX_SWEEPS, true);
  ali3_constraint_gamma(in, to->q, to->qd, to, in->step.gamma);
  ALI3_AT_WORK(in, lanes);
  ali3_project(in, c * alpha, in->step.gamma, to->qdd, to->lam, ACCELERATION_TOLERANCE, limit / c, MAX_SWEEPS, false);
  e.error += ali3_projection_work(in, &e.kinetic, &e.end, &e.open, &e.driving_work) + 0.5 * h * open_power;
  return e;
}
#endif
