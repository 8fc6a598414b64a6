/* Newton corrections with the forces that elements will have, by defect correction (Stetter 1978). The tangent is
 * symmetric, so gyroscopic moments of wheels and much of the tyres are not in it, and each iteration leaves a part of the
 * residual. With d(x) = -c (f(D + x) - f(D)) - T_e x, what T_e, the tangent of the elements, does not tell of their
 * forces, the correction is that of T x = b - d(x), by x <- x - T^-1 (change of d). It costs forces of elements and a
 * solve; an iteration costs all rows, the inertia of flexible bodies and their stiffness too. */
#include "defect_correction.h"

#include <math.h>
#include <string.h>

#include "../algebra/fronts.h"
#include "../elements/forces.h"

enum { MOST = 2 }; /* corrections of a correction */
/* m: after a first correction that is larger anywhere the rows are not closed, and one more iteration is due anyway */
static const double LARGE = 3e-5;
static const double SMALL = 10.0; /* tolerances: what is left of a smaller correction is none */
static const double FALLS = 0.5; /* of the last change of d, at most, or the forces are too far from straight */

/* The last change of d that is worth a solve, negative, goes to `change`; returns its size, m. */
static double defect(ali3_instance *in, double h, double *last, double *change) {
  const int32_t nq = in->system->size.nq;
  double *q = in->w, *qd = in->stage + 2 * nq, largest = 0.0;
  for (int32_t i = 0; i < nq; i++) {
    q[i] = in->next.q[i] + in->x[i];
    qd[i] = in->next.qd[i] + in->rule.rate * in->x[i];
  }
  const ali3_force_call call = {.q = q,
                                .qd = qd,
                                .y_old = in->now.y,
                                .h = h,
                                .wC = in->rule.wC,
                                .wK = in->rule.c,
                                .y_new = in->y_work,
                                .out = in->out_work,
                                .potential = in->potential_work};
  ali3_elements_defect(in, &call, change);
  for (int32_t i = 0; i < nq; i++) {
    const double d = change[i], size = fabs(d - last[i]) * in->mass_floor_inverse[i];
    change[i] = last[i] - d;
    last[i] = d;
    if (!(size <= largest)) largest = size; /* a NaN ends it */
  }
  return largest;
}

/* in->x is the correction by the tangent; forces and signals are those of the present iterate. */
void ali3_defect_correction(ali3_instance *in, double h) {
  const int32_t nq = in->system->size.nq;
  double *last = in->stage, *change = last + nq, before = HUGE_VAL;
  double largest = 0.0;
  for (int32_t i = 0; i < nq; i++) largest = fmax(largest, fabs(in->x[i]));
  if (largest < SMALL * in->settings.tolerance_r || (in->report.last_iterations == 0 && largest > LARGE)) return;
  memcpy(in->u_at, in->u, (size_t)in->system->size.nsig * sizeof(double));
  memset(last, 0, (size_t)nq * sizeof(double));
  for (int k = 0; k < MOST; k++) {
    const double size = defect(in, h, last, change);
    if (!(size > in->settings.tolerance_r && size <= FALLS * before)) return;
    before = size;
    ali3_solve(in, in->F, change);
    for (int32_t i = 0; i < nq; i++) in->x[i] += change[i];
  }
}
