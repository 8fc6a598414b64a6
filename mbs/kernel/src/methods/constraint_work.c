/* Energy that a step adds or removes without a force.
 *
 * By the trapezoidal rule the kinetic energy changes by D'(f0 + f1)/2, where f are all forces including -Phi_q' lam.
 * With Phi = 0 at both ends, to third order, and lam1 of Newton's iteration
 *
 *   (Phi_q0 + Phi_q1) D = -2 h R, R the mean of Phi_t over the step
 *   work of rows:   h R' lam0 - (Phi_q1 D)'(lam1 - lam0)/2
 *   work of drives: w'(lam0 + lam) + h (lam - lam0)'(Phi_t1 - Phi_t0)/12, w = h R/2
 *
 * The work of drives is not an error: it is the integral of lam' Phi_t for linear lam and quadratic Phi_t. There lam is
 * that after (25), as in sensors: it differs from lam1 by a term of order h where the rate of a driving function has a
 * kink, and (24) changes the energy by another; each alone is an error of first order, their sum is not.
 *
 * A driving function that follows an input starts to move within a step, with a large change of acceleration; lam0
 * then lacks the jump, which Newton's iteration compensates. In that case, and without projection, the work of drives
 * is that of their rows, the force of the step times its displacement, plus the work of (24). */
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "energy_watch.h"

/* Writes w + h (Phi_t1 - Phi_t0)/12 to in->step.drive: times lam0 - lam it is the difference between h R' lam0 and the
 * work of drives. */
static void drive_weights(ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  ali3_vectors mean = in->next;
  mean.sd = in->driving.mean;
  for (int32_t g = 0; g < S->size.ng; g++) mean.sd[g] = (in->next.s[g] - in->now.s[g]) / h;
  ali3_constraint_rate(in, in->next.q, &mean, in->step.mu);
  ali3_constraint_rate(in, in->now.q, &in->now, in->step.drive);
  for (int32_t i = 0; i < S->n_driven; i++) {
    const int32_t k = S->driven_row[i];
    in->step.drive[k] = h * (0.5 * in->step.mu[k] + (in->step.Phit[k] - in->step.drive[k]) / 12.0);
  }
}

/* Whether the work of drives is the work of their rows: filtered driving functions move, or there is no projection. */
static lane_mask work_by_rows(const ali3_instance *in) {
  lane_mask uses_rows = {0};
  for (int32_t g = 0; g < in->system->size.ng; g++) uses_rows |= in->driving.follows[g] != 0.0;
  if (!in->settings.project) uses_rows |= ali3_not(uses_rows);
  return uses_rows;
}

/* Energy error before the projections: in->tangent.J and in->step.Phit are those at the end of the step, in->next.lam
 * is that of Newton's iteration. projection_work adds the terms of lam after (25), also to *driving_work, the work of
 * drives. Writes Phi_q v to in->step.mu for (24). */
real ali3_constraint_work(ali3_instance *in, double h, real *driving_work) {
  const ali3_system *S = in->system;
  real work = {0}, rate_work = {0}, drive_work = {0}, newton_term = {0};
  lane_mask use_rows = {0};
  if (S->n_driven > 0) {
    drive_weights(in, h);
    use_rows = work_by_rows(in);
    for (int32_t i = 0; i < S->n_driven; i++) {
      const int32_t k = S->driven_row[i];
      rate_work += (h * in->step.mu[k] - in->step.drive[k]) * in->now.lam[k];
      drive_work += in->step.drive[k] * in->now.lam[k];
      in->step.drive[k] = ali3_where(use_rows, ali3_same(0.0), in->step.drive[k]);
    }
  }
  ali3_rows_times(S, in->tangent.J, in->step.D, in->step.gamma);
  ali3_rows_times(S, in->tangent.J, in->next.qd, in->step.mu);
  for (int32_t k = 0; k < S->size.nc; k++) work -= 0.5 * in->step.gamma[k] * (in->next.lam[k] - in->now.lam[k]);
  for (int32_t i = 0; i < S->n_driven; i++) {
    const int32_t k = S->driven_row[i];
    newton_term -= 0.5 * in->step.gamma[k] * (in->next.lam[k] - in->now.lam[k]);
  }
  *driving_work = rate_work + ali3_where(use_rows, drive_work + newton_term, ali3_same(0.0));
  return work + ali3_where(use_rows, -newton_term, drive_work);
}

/* Energy error of the projections: the kinetic energy that (24) adds to the velocity rate D + hat, which is work of
 * drives where filtered driving functions move, minus the work of drives by the multipliers after (25). *kinetic:
 * kinetic energy of the mean of the velocities before and after (24), *end: that after (24) without the square of its
 * change, *open: power of the forces that (25) leaves unbalanced. */
ALI3_INLINED real projection_work(ali3_instance *in, real *kinetic, real *end, real *open, real *driving_work) {
  const ali3_vectors *v = &in->next;
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  real *w = in->step.w, *x = in->step.x, *change = in->step.r, *unbalanced = in->step.d0;
  const real *D = in->step.D, *hat = in->step.hat, *qd = v->qd, *Q = in->step.Q;
  const double rate = in->rule.rate;
  ALI3_EACH(0, nq, ALI3_AT(w) = 0.5 * (rate * ALI3_AT(D) + ALI3_AT(hat) + ALI3_AT(qd));
            ALI3_AT(change) = 2.0 * (ALI3_AT(qd) - ALI3_AT(w)))
  ali3_mass_times(in, w, x);
  ali3_mass_times(in, v->qdd, unbalanced);
  const real added = ali3_product_backward(change, x, nq), twice = ali3_product_backward(w, x, nq);
  ALI3_EACH(0, nq, ALI3_AT(unbalanced) -= ALI3_AT(Q))
  real power = ali3_product_backward(qd, unbalanced, nq), drive = {0};
  for (int32_t i = 0; i < S->n_driven; i++) {
    const int32_t k = S->driven_row[i];
    power -= v->lam[k] * in->step.Phit[k];
    drive += v->lam[k] * in->step.drive[k];
  }
  *kinetic = 0.5 * twice;
  *end = 0.5 * (twice + added);
  *open = power;
  if (S->n_driven == 0) return added;
  const lane_mask use_rows = work_by_rows(in);
  *driving_work += ali3_where(use_rows, added, drive);
  return ali3_where(use_rows, ali3_same(0.0), added - drive);
}

ALI3_BY_PROCESSOR(in->system, real, projection_work,
                  (ali3_instance * in, real *kinetic, real *end, real *open, real *driving_work),
                  (in, kinetic, end, open, driving_work))

/* Reference for energy errors: the kinetic energy, the energy that the forces in in->step.Q can add in a step, and that
 * of the residual's tolerance. */
real ali3_energy_size(const ali3_instance *in, double h, real kinetic) {
  const double unbalanced = 2.0 * in->system->fine * in->settings.tolerance_r / h;
  const double rest = unbalanced * unbalanced, square = h * h;
  const real *Q = in->step.Q, *inverse = in->mass.floor_inverse, *m = in->mass.floor;
  real even = {0}, odd = {0}; /* two sums, as additions are pipelined */
  int32_t i = 0;
  for (; i + 1 < in->system->size.nq; i += 2) {
    even += square * Q[i] * Q[i] * inverse[i] + rest * m[i];
    odd += square * Q[i + 1] * Q[i + 1] * inverse[i + 1] + rest * m[i + 1];
  }
  if (i < in->system->size.nq) even += square * Q[i] * Q[i] * inverse[i] + rest * m[i];
  return kinetic + 0.5 * (even + odd);
}
