/* Energy that a step adds or removes without a force.
 *
 * By the trapezoidal rule the kinetic energy changes by D'(f0 + f1)/2, f all forces, -Phi_q' lam among them. With
 * Phi = 0 at both ends, to third order, and lam1 of Newton's loop
 *
 *   (Phi_q0 + Phi_q1) D = -2 h R, R the mean of Phi_t over the step
 *   work of rows:   h R' lam0 - (Phi_q1 D)'(lam1 - lam0)/2
 *   work of drives: w'(lam0 + lam) + h (lam - lam0)'(Phi_t1 - Phi_t0)/12, w = h R/2
 *
 * The work of drives is no error: the integral of lam' Phi_t, where lam is straight and Phi_t a parabola. There lam is
 * that after (25), which sensors show: it differs from lam1 by a term of order h where the rate of a guide bends, and the
 * energy that (24) gives by another; each alone adds up to an error of first order, and together they cancel.
 *
 * Guides that follow an input begin to move within a step, and their acceleration changes much in it. Where one moves,
 * lam0 is that before a jump of its acceleration, for which Newton's loop makes up: there the work of drives is that of
 * their rows, the force of the step times its own travel, with what (24) adds; so too where nothing is projected. */
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "energy_watch.h"

/* in->step.drive: w + h (Phi_t1 - Phi_t0)/12. Its product with lam0 - lam is what the rows' h R' lam0 and the work of
 * drives leave. */
static void drives(ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  ali3_vectors mean = in->next;
  mean.sd = in->guide.mean;
  for (int32_t g = 0; g < S->size.ng; g++) mean.sd[g] = (in->next.s[g] - in->now.s[g]) / h;
  ali3_constraint_rate(in, in->next.q, &mean, in->step.mu);
  ali3_constraint_rate(in, in->now.q, &in->now, in->step.drive);
  for (int32_t i = 0; i < S->n_driven; i++) {
    const int32_t k = S->driven_row[i];
    in->step.drive[k] = h * (0.5 * in->step.mu[k] + (in->step.Phit[k] - in->step.drive[k]) / 12.0);
  }
}

/* Whether the work of drives is that of their rows: filtered guides move, or nothing is projected. */
static truth by_rows(const ali3_instance *in) {
  truth any = {0};
  for (int32_t g = 0; g < in->system->size.ng; g++) any |= in->guide.follows[g] != 0.0;
  if (!in->settings.project) any |= ali3_not(any);
  return any;
}

/* Before the projections: in->tangent.J and in->step.Phit are of the end of the step, in->next.lam those of Newton's
 * loop. The part of the multipliers after (25) is still to be added, to *guides, the work of drives, too. Leaves Phi_q
 * v of the rates in in->step.mu, with which (24) begins. */
ALI3_INLINED real constraint_work(ali3_instance *in, double h, real *guides) {
  const ali3_system *S = in->system;
  real work = {0}, first = {0}, second = {0}, newton = {0};
  truth own = {0};
  if (S->n_driven > 0) {
    drives(in, h);
    own = by_rows(in);
    for (int32_t i = 0; i < S->n_driven; i++) {
      const int32_t k = S->driven_row[i];
      first += (h * in->step.mu[k] - in->step.drive[k]) * in->now.lam[k];
      second += in->step.drive[k] * in->now.lam[k];
      in->step.drive[k] = ali3_where(own, ali3_same(0.0), in->step.drive[k]);
    }
  }
  ali3_rows_times(S, in->tangent.J, in->step.D, in->step.gamma);
  ali3_rows_times(S, in->tangent.J, in->next.qd, in->step.mu);
  for (int32_t k = 0; k < S->size.nc; k++) work -= 0.5 * in->step.gamma[k] * (in->next.lam[k] - in->now.lam[k]);
  for (int32_t i = 0; i < S->n_driven; i++) {
    const int32_t k = S->driven_row[i];
    newton -= 0.5 * in->step.gamma[k] * (in->next.lam[k] - in->now.lam[k]);
  }
  *guides = first + ali3_where(own, second + newton, ali3_same(0.0));
  return work + ali3_where(own, -newton, second);
}

ALI3_BY_PROCESSOR(in->system, real, constraint_work, (ali3_instance * in, double h, real *guides), (in, h, guides))

/* After the projections: the kinetic energy that (24) gave to the velocity rate D + hat, which is work of drives where
 * filtered guides move, less what the multipliers after (25) give to the work of drives. *kinetic is the kinetic energy
 * of the mean of the velocities before and after (24), *end that after it but for the square of what (24) changed, *open
 * the power of the forces that (25) leaves without balance now. */
ALI3_INLINED real projection_work(ali3_instance *in, real *kinetic, real *end, real *open, real *guides) {
  const ali3_vectors *v = &in->next;
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  real *w = in->step.w, *x = in->step.x, *change = in->step.r, *left = in->step.d0;
  const real *D = in->step.D, *hat = in->step.hat, *qd = v->qd, *Q = in->step.Q;
  const double rate = in->rule.rate;
  ALI3_EACH(0, nq, ALI3_AT(w) = 0.5 * (rate * ALI3_AT(D) + ALI3_AT(hat) + ALI3_AT(qd));
            ALI3_AT(change) = 2.0 * (ALI3_AT(qd) - ALI3_AT(w)))
  ali3_mass_times(in, w, x);
  ali3_mass_times(in, v->qdd, left);
  const real given = ali3_product_from_far(change, x, nq), twice = ali3_product_from_far(w, x, nq);
  ALI3_EACH(0, nq, ALI3_AT(left) -= ALI3_AT(Q))
  real power = ali3_product_from_far(qd, left, nq), drive = {0};
  for (int32_t i = 0; i < S->n_driven; i++) {
    const int32_t k = S->driven_row[i];
    power -= v->lam[k] * in->step.Phit[k];
    drive += v->lam[k] * in->step.drive[k];
  }
  *kinetic = 0.5 * twice;
  *end = 0.5 * (twice + given);
  *open = power;
  if (S->n_driven == 0) return given;
  const truth own = by_rows(in);
  *guides += ali3_where(own, given, drive);
  return ali3_where(own, ali3_same(0.0), given - drive);
}

ALI3_BY_PROCESSOR(in->system, real, projection_work,
                  (ali3_instance * in, real *kinetic, real *end, real *open, real *guides),
                  (in, kinetic, end, open, guides))

/* Reference for errors of the energy: the kinetic energy, the energy that the forces in in->step.Q can give in a step,
 * and that which the tolerance of the residual leaves open. */
ALI3_INLINED real energy_size(const ali3_instance *in, double h, real kinetic) {
  const double left = 2.0 * in->system->fine * in->settings.tolerance_r / h;
  const double rest = left * left, square = h * h;
  const real *Q = in->step.Q, *inverse = in->mass.floor_inverse, *m = in->mass.floor;
  real even = {0}, odd = {0}; /* so that additions need not wait for each other */
  int32_t i = 0;
  for (; i + 1 < in->system->size.nq; i += 2) {
    even += square * Q[i] * Q[i] * inverse[i] + rest * m[i];
    odd += square * Q[i + 1] * Q[i + 1] * inverse[i + 1] + rest * m[i + 1];
  }
  if (i < in->system->size.nq) even += square * Q[i] * Q[i] * inverse[i] + rest * m[i];
  return kinetic + 0.5 * (even + odd);
}

ALI3_BY_PROCESSOR(in->system, real, energy_size, (const ali3_instance *in, double h, real kinetic), (in, h, kinetic))
