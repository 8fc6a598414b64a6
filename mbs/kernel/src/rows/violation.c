/* How far rows are open, in metres. */
#include <math.h>

#include "../system.h"
#include "violation.h"

double ali3_violation(const ali3_system *S, const double *Phi, int32_t *worst) {
  double largest = 0.0;
  for (int32_t k = 0; k < S->size.nc; k++) {
    const double v = fabs(Phi[k]) * S->row_measure[k];
    if (!(v <= largest) && largest == largest) { /* a NaN stays */
      largest = v;
      *worst = k;
    }
  }
  return largest;
}

/* By how much the worst row is open beyond its round-off, m; of finite rows. */
double ali3_opening(const ali3_system *S, const double *Phi) {
  double largest = 0.0;
  for (int32_t k = 0; k < S->size.nc; k++) {
    const double v = fabs(Phi[k]) * S->row_measure[k] - S->row_round[k];
    if (v > largest) largest = v;
  }
  return largest;
}

bool ali3_closed(const ali3_system *S, const double *Phi, double tolerance) {
  for (int32_t k = 0; k < S->size.nc; k++)
    if (!(fabs(Phi[k]) * S->row_measure[k] <= tolerance + S->row_round[k])) return false;
  return true;
}
