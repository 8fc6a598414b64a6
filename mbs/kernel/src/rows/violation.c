/* Violation of the rows, in metres. */
#include <float.h>
#include <math.h>

#include "../system.h"
#include "violation.h"

double ali3_find_worst(const double *x, const double *factor, int32_t n, int32_t *worst) {
  double largest = 0.0;
  for (int32_t i = 0; i < n; i++) {
    const double size = fabs(x[i]) * factor[i];
    if (!(size <= largest) && largest == largest) { /* a NaN stays */
      largest = size;
      *worst = i;
    }
  }
  return largest;
}

double ali3_violation(const ali3_system *S, const double *Phi, int32_t *worst) {
  return ali3_find_worst(Phi, S->row_measure, S->size.nc, worst);
}

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

double ali3_row_sum(const ali3_system *S, int32_t k, const double *q) {
  double sum = fabs(S->row_const[k]);
  for (int32_t i = S->row_ptr[k]; i < S->row_ptr[k + 1]; i++) sum += fabs(S->row_lin[i] * q[S->row_col[i]]);
  for (int32_t t = S->quad_ptr[k]; t < S->quad_ptr[k + 1]; t++)
    sum += fabs(S->quad[t].h * q[S->quad[t].a] * q[S->quad[t].b]);
  return sum;
}

bool ali3_closed_at(const ali3_system *S, const double *Phi, const double *q, double tolerance) {
  for (int32_t k = 0; k < S->size.nc; k++) {
    const double open = fabs(Phi[k]) * S->row_measure[k] - tolerance;
    if (open <= S->row_round[k]) continue;
    if (!(open <= 4.0 * DBL_EPSILON * S->row_measure[k] * ali3_row_sum(S, k, q))) return false;
  }
  return true;
}
