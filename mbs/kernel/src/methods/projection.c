/* Projections (24), (25) of velocities and accelerations with the factorised tangent. */
#include "projection.h"

#include <math.h>

#include "../algebra/fronts.h"
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../instance.h"
#include "../rows/constraints.h"

/* Whether Phi_q v, which is in in->step.mu, and b together are below the tolerance times the largest of v, or below
 * `known`; their sum, of the size *violation, stays in in->step.mu. */
ALI3_INLINED truth rates_below(ali3_instance *in, const real *b, const real *v, double tolerance, double known,
                               real *violation) {
  const ali3_system *S = in->system;
  ali3_add(in->step.mu, b, S->size.nc);
  *violation = ali3_largest_product(in->step.mu, S->row_measure, S->size.nc);
  const double part = tolerance * fmin(S->fine, 1.0); /* in a small drawing the largest are rates of angles */
  return (*violation <= known) | (*violation <= part * ali3_largest(v, S->size.nq));
}

ALI3_INLINED truth rates_closed(ali3_instance *in, const real *b, const real *v, double tolerance, double known,
                                real *violation) {
  ali3_rows_times(in->system, in->tangent.J, v, in->step.mu);
  return rates_below(in, b, v, tolerance, known, violation);
}

ALI3_BY_PROCESSOR(in->system, truth, rates_closed,
                  (ali3_instance * in, const real *b, const real *v, double tolerance, double known, real *violation),
                  (in, b, v, tolerance, known, violation))

/* v -= T^-1 factor Phi_q' (Phi_q v + b) until the violation is round-off: (24), (25) in correction form. The Phi_q'
 * that spreads the correction is that of the tangent: the penalty would amplify what a later one has outside its
 * range. The violation is judged at the converged position, where positions tell rates of rows to `known`. Returns it.
 * With accelerations in v, lam (or NULL) takes the multipliers along: T x = Phi_q' mu is
 * (T - factor Phi_q' Phi_q) x = Phi_q' (mu - factor Phi_q x). `begun`: in->step.mu has Phi_q v. */
ALI3_INLINED real project(ali3_instance *in, double factor, const real *b, real *v, real *lam, double tolerance,
                          double known, int32_t sweeps, bool begun) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  real violation = {0}, *mu = in->step.mu, *x = in->step.x, *along = in->step.lam;
  if (!begun) ali3_rows_times(S, in->tangent.J, v, mu);
  truth open = ALI3_AT_WORK_OF(in, ali3_not(rates_below(in, b, v, tolerance, known, &violation)));
  for (int32_t sweep = 0; sweep < sweeps && ali3_any(open); sweep++) {
    ALI3_AT_WORK(in, open);
    ALI3_EACH(0, nc, ALI3_AT(mu) *= factor)
    ali3_rows_transposed(S, in->tangent.J_made, mu, x);
    ali3_solve(in, in->tangent.F, x);
    ALI3_EACH(0, nq, ALI3_AT(v) = ALI3_OF_LANES(open, ALI3_AT(v) - ALI3_AT(x), ALI3_AT(v)))
    if (lam != NULL) {
      ali3_rows_times(S, in->tangent.J_made, x, along);
      ALI3_EACH(0, nc,
                ALI3_AT(lam) =
                    ALI3_OF_LANES(open, ALI3_AT(lam) + (ALI3_AT(mu) - factor * ALI3_AT(along)), ALI3_AT(lam)))
    }
    open &= ali3_not(rates_closed(in, b, v, tolerance, known, &violation));
  }
  return violation;
}

ALI3_BY_PROCESSOR(in->system, real, project,
                  (ali3_instance * in, double factor, const real *b, real *v, real *lam, double tolerance, double known,
                   int32_t sweeps, bool begun),
                  (in, factor, b, v, lam, tolerance, known, sweeps, begun))
