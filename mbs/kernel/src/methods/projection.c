/* Projections (24), (25) of velocities and accelerations with the factorised tangent. */
#include "projection.h"

#include <math.h>

#include "../algebra/fronts.h"
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../instance.h"
#include "../rows/constraints.h"

/* Whether Phi_q v, in in->step.mu, plus b is below the tolerance times the largest of v, or below `round_off`; writes
 * the sum to in->step.mu and its size to *violation. */
ALI3_INLINED lane_mask rates_below(ali3_instance *in, const real *b, const real *v, double tolerance, double round_off,
                                   real *violation) {
  const ali3_system *S = in->system;
  ali3_add(in->step.mu, b, S->size.nc);
  *violation = ali3_largest_product(in->step.mu, S->row_measure, S->size.nc);
  const double limit = tolerance * fmin(S->fine, 1.0); /* in small systems the largest are rates of angles */
  return (*violation <= round_off) | (*violation <= limit * ali3_largest(v, S->size.nq));
}

ALI3_INLINED lane_mask rates_closed(ali3_instance *in, const real *b, const real *v, double tolerance, double round_off,
                                    real *violation) {
  ali3_rows_times(in->system, in->tangent.J, v, in->step.mu);
  return rates_below(in, b, v, tolerance, round_off, violation);
}

ALI3_BY_PROCESSOR(in->system, lane_mask, rates_closed,
                  (ali3_instance * in, const real *b, const real *v, double tolerance, double round_off,
                   real *violation),
                  (in, b, v, tolerance, round_off, violation))

/* v -= T^-1 factor Phi_q' (Phi_q v + b) until the violation is round-off: (24), (25) in correction form. The Phi_q'
 * that distributes the correction is that of the tangent, as the penalty would amplify the part of a later one outside
 * its range. The violation is that at the converged position, where round-off of positions causes `round_off` in it; it
 * is returned. With accelerations in v, lam (or NULL) is updated: T x = Phi_q' mu is (T - factor Phi_q' Phi_q) x =
 * Phi_q' (mu - factor Phi_q x). `has_rates`: in->step.mu has Phi_q v. */
ALI3_INLINED real project(ali3_instance *in, double factor, const real *b, real *v, real *lam, double tolerance,
                          double round_off, int32_t sweeps, bool has_rates) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  real violation = {0}, *mu = in->step.mu, *x = in->step.x, *correction = in->step.lam;
  if (!has_rates) ali3_rows_times(S, in->tangent.J, v, mu);
  lane_mask active = ALI3_AT_WORK_OF(in, ali3_not(rates_below(in, b, v, tolerance, round_off, &violation)));
  for (int32_t sweep = 0; sweep < sweeps && ali3_any(active); sweep++) {
    ALI3_AT_WORK(in, active);
    ALI3_EACH(0, nc, ALI3_AT(mu) *= factor)
    ali3_rows_transposed(S, in->tangent.J_made, mu, x);
    ali3_solve(in, in->tangent.F, x);
    ALI3_EACH(0, nq, ALI3_AT(v) = ALI3_OF_LANES(active, ALI3_AT(v) - ALI3_AT(x), ALI3_AT(v)))
    if (lam != NULL) {
      ali3_rows_times(S, in->tangent.J_made, x, correction);
      ALI3_EACH(0, nc,
                ALI3_AT(lam) =
                    ALI3_OF_LANES(active, ALI3_AT(lam) + (ALI3_AT(mu) - factor * ALI3_AT(correction)), ALI3_AT(lam)))
    }
    active &= ali3_not(rates_closed(in, b, v, tolerance, round_off, &violation));
  }
  return violation;
}

ALI3_BY_PROCESSOR(in->system, real, project,
                  (ali3_instance * in, double factor, const real *b, real *v, real *lam, double tolerance,
                   double round_off, int32_t sweeps, bool has_rates),
                  (in, factor, b, v, lam, tolerance, round_off, sweeps, has_rates))
