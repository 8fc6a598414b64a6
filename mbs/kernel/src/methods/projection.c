/* Projections (24), (25) of velocities and accelerations with the factorised tangent. */
#include "projection.h"
#include "../algebra/fronts.h"
#include "../algebra/stretch.h"
#include "../instance.h"
#include "../rows/constraints.h"

/* Whether Phi_q v, which is in in->mu, and b together are below the tolerance times the largest of v; their sum, of the
 * size *violation, stays in in->mu. */
static truth rates_below(ali3_instance *in, const real *b, const real *v, double tolerance, real *violation) {
  const ali3_system *S = in->system;
  ali3_add(in->mu, b, S->size.nc);
  *violation = ali3_largest_product(in->mu, S->row_measure, S->size.nc);
  return *violation <= tolerance * ali3_largest(v, S->size.nq);
}

truth ali3_rates_closed(ali3_instance *in, const real *b, const real *v, double tolerance, real *violation) {
  ali3_rows_times(in->system, in->J, v, in->mu);
  return rates_below(in, b, v, tolerance, violation);
}

/* v -= T^-1 factor Phi_q' (Phi_q v + b) until the violation is round-off: (24), (25) in correction form. The Phi_q'
 * that spreads the correction is that of the tangent: the penalty would amplify what a later one has outside its
 * range. The violation is judged at the converged position. Returns it. With accelerations in v, lam (or NULL) takes
 * the multipliers along: T x = Phi_q' mu is (T - factor Phi_q' Phi_q) x = Phi_q' (mu - factor Phi_q x). `begun`:
 * in->mu has Phi_q v. */
real ali3_project(ali3_instance *in, double factor, const real *b, real *v, real *lam, double tolerance, int32_t sweeps,
                  bool begun) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  real violation = {0};
  if (!begun) ali3_rows_times(S, in->J, v, in->mu);
  truth open = ALI3_AT_WORK_OF(in, ali3_not(rates_below(in, b, v, tolerance, &violation)));
  for (int32_t sweep = 0; sweep < sweeps && ali3_any(open); sweep++) {
    ALI3_AT_WORK(in, open);
    for (int32_t k = 0; k < nc; k++) in->mu[k] *= factor;
    ali3_rows_transposed(S, in->J_tangent, in->mu, in->x);
    ali3_solve(in, in->F, in->x);
    for (int32_t i = 0; i < nq; i++) v[i] = ali3_where(open, v[i] - in->x[i], v[i]);
    if (lam != NULL) {
      ali3_rows_times(S, in->J_tangent, in->x, in->lam);
      for (int32_t k = 0; k < nc; k++) lam[k] = ali3_where(open, lam[k] + (in->mu[k] - factor * in->lam[k]), lam[k]);
    }
    open &= ali3_not(ali3_rates_closed(in, b, v, tolerance, &violation));
  }
  return violation;
}
