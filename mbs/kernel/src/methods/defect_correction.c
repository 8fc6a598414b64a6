/* Newton corrections that include changes of element forces outside the tangent, by defect correction (Stetter 1978).
 * The tangent is symmetric and lacks the gyroscopic moments of wheels and much of the tyres, which slows convergence.
 * With d(x) = -c (f(D + x) - f(D)) - T_e x, where T_e is the tangent of the elements, the correction solves T x = b -
 * d(x) by x <- x - T^-1 (change of d). Each needs element forces and a solve; a Newton iteration also needs rows and
 * the inertia and stiffness of flexible bodies. */
#include "defect_correction.h"

#include <string.h>

#include "../algebra/fronts.h"
#include "../algebra/number_pairs.h"
#include "../elements/defect.h"

enum { MAX_CORRECTIONS = 2 }; /* of a Newton correction */
/* m: after a larger first correction the rows are open and another iteration follows in any case */
static const double LARGE_CORRECTION = 3e-5;
static const double SMALL_CORRECTION = 10.0; /* in tolerances: a smaller correction has no relevant defect */
static const double CONTRACTION = 0.5; /* largest ratio of successive changes of d; above it forces are too nonlinear */

/* Writes the negative change of d to `change` and d to `last`; returns the size of the change, m. */
static real defect(ali3_instance *in, double h, lane_mask lanes, real *last, real *change) {
  const int32_t nq = in->system->size.nq;
  real *q = in->step.w, *qd = in->step.stage + 2 * nq, largest = {0};
  for (int32_t i = 0; i < nq; i++) {
    q[i] = in->next.q[i] + in->step.x[i];
    qd[i] = in->next.qd[i] + in->rule.rate * in->step.x[i];
  }
  ali3_elements_defect(in, h, lanes, q, qd, change);
  for (int32_t i = 0; i < nq; i++) {
    const real d = change[i], size = ali3_abs(d - last[i]) * in->mass.floor_inverse[i];
    change[i] = last[i] - d;
    last[i] = d;
    largest = ali3_where(ali3_not(size <= largest), size, largest); /* a NaN ends the corrections */
  }
  return largest;
}

/* in->step.x has the Newton correction; forces and signals belong to the present iterate. */
void ali3_defect_correction(ali3_instance *in, double h, int32_t iteration, lane_mask lanes) {
  const int32_t nq = in->system->size.nq;
  const double tolerance = in->system->fine * in->settings.tolerance_r;
  real *last = in->step.stage, *change = last + nq, before = ali3_same(HUGE_VAL);
  const real largest = ali3_largest(in->step.x, nq);
  lane_mask open = lanes & ali3_not(largest < SMALL_CORRECTION * tolerance);
  if (iteration == 0) open &= ali3_not(largest > LARGE_CORRECTION);
  if (!ali3_any(open)) return;
  memcpy(in->element.ud_at, in->element.ud, (size_t)in->system->size.nsig * sizeof *in->element.ud);
  memset(last, 0, (size_t)nq * sizeof *last);
  for (int k = 0; k < MAX_CORRECTIONS; k++) {
    const real size = defect(in, h, open, last, change);
    open &= (size > tolerance) & (size <= CONTRACTION * before);
    if (!ali3_any(open)) return;
    before = size;
    ALI3_AT_WORK(in, open);
    ali3_solve(in, in->tangent.F, change);
    for (int32_t i = 0; i < nq; i++) in->step.x[i] = ali3_where(open, in->step.x[i] + change[i], in->step.x[i]);
  }
}
