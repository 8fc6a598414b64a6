/* Newton corrections with the forces that elements will have, by defect correction (Stetter 1978). The tangent is
 * symmetric, so gyroscopic moments of wheels and much of the tyres are not in it, and each iteration leaves a part of the
 * residual. With d(x) = -c (f(D + x) - f(D)) - T_e x, what T_e, the tangent of the elements, does not tell of their
 * forces, the correction is that of T x = b - d(x), by x <- x - T^-1 (change of d). It costs forces of elements and a
 * solve; an iteration costs all rows, the inertia of flexible bodies and their stiffness too. */
#include "defect_correction.h"

#include <string.h>

#include "../algebra/fronts.h"
#include "../algebra/number_pairs.h"
#include "../elements/defect.h"

enum { CORRECTIONS = 2 }; /* of a correction, at most */
/* m: after a first correction that is larger anywhere the rows are not closed, and one more iteration is due anyway */
static const double TOO_LARGE = 3e-5;
static const double SMALL = 10.0; /* tolerances: what is left of a smaller correction is none */
static const double FALLS = 0.5; /* of the last change of d, at most, or the forces are too far from straight */

/* The last change of d that is worth a solve, negative, goes to `change`; returns its size, m. */
static real defect(ali3_instance *in, double h, truth lanes, real *last, real *change) {
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
    largest = ali3_where(ali3_not(size <= largest), size, largest); /* a NaN ends it */
  }
  return largest;
}

/* in->step.x is the correction by the tangent; forces and signals are those of the present iterate. */
void ali3_defect_correction(ali3_instance *in, double h, int32_t iteration, truth lanes) {
  const int32_t nq = in->system->size.nq;
  const double tolerance = in->system->fine * in->settings.tolerance_r;
  real *last = in->step.stage, *change = last + nq, before = ali3_same(HUGE_VAL);
  const real largest = ali3_largest(in->step.x, nq);
  truth open = lanes & ali3_not(largest < SMALL * tolerance);
  if (iteration == 0) open &= ali3_not(largest > TOO_LARGE);
  if (!ali3_any(open)) return;
  memcpy(in->element.ud_at, in->element.ud, (size_t)in->system->size.nsig * sizeof *in->element.ud);
  memset(last, 0, (size_t)nq * sizeof *last);
  for (int k = 0; k < CORRECTIONS; k++) {
    const real size = defect(in, h, open, last, change);
    open &= (size > tolerance) & (size <= FALLS * before);
    if (!ali3_any(open)) return;
    before = size;
    ALI3_AT_WORK(in, open);
    ali3_solve(in, in->tangent.F, change);
    for (int32_t i = 0; i < nq; i++) in->step.x[i] = ali3_where(open, in->step.x[i] + change[i], in->step.x[i]);
  }
}
