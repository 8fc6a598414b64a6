/* Projections (24), (25) of velocities and accelerations with the factorised tangent. */
#include <math.h>

#include "../algebra/fronts.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "projection.h"

/* Whether Phi_q v + b, which stays in in->mu, is below the tolerance times the largest of v; its size in *violation. */
bool ali3_rates_closed(ali3_instance *in, const double *b, const double *v, double tolerance, double *violation) {
  const ali3_system *S = in->system;
  double largest = 0.0, scale = 0.0;
  ali3_rows_times(S, in->J, v, in->mu);
  for (int32_t k = 0; k < S->size.nc; k++) {
    in->mu[k] += b[k];
    const double size = fabs(in->mu[k]) * S->row_measure[k];
    if (size > largest) largest = size;
  }
  for (int32_t i = 0; i < S->size.nq; i++)
    if (fabs(v[i]) > scale) scale = fabs(v[i]);
  *violation = largest;
  return largest <= tolerance * scale;
}

/* v -= T^-1 factor Phi_q' (Phi_q v + b) until the violation is round-off: (24), (25) in correction form. The Phi_q'
 * that spreads the correction is that of the tangent: the penalty would amplify what a later one has outside its
 * range. The violation is judged at the converged position. Returns it. With accelerations in v, lam (or NULL) takes
 * the multipliers along: T x = Phi_q' mu is (T - factor Phi_q' Phi_q) x = Phi_q' (mu - factor Phi_q x). */
double ali3_project(ali3_instance *in, double factor, const double *b, double *v, double *lam, double tolerance,
                    int32_t sweeps) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  double violation = 0.0;
  for (int32_t sweep = 0; !ali3_rates_closed(in, b, v, tolerance, &violation) && sweep < sweeps; sweep++) {
    for (int32_t k = 0; k < nc; k++) in->mu[k] *= factor;
    ali3_rows_transposed(S, in->J_tangent, in->mu, in->x);
    ali3_solve(in, in->F, in->x);
    for (int32_t i = 0; i < nq; i++) v[i] -= in->x[i];
    if (lam == NULL) continue;
    ali3_rows_times(S, in->J_tangent, in->x, in->lam);
    for (int32_t k = 0; k < nc; k++) lam[k] += in->mu[k] - factor * in->lam[k];
  }
  return violation;
}
