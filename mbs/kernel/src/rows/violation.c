/* How far rows are open, in metres. */
#include <math.h>

#include "../algebra/finite.h"
#include "../algebra/processor.h"
#include "../algebra/stretch.h"
#include "../system.h"
#include "violation.h"

/* The largest of n sizes |x| factor, a NaN where there is one; *worst becomes the first that has it, if it is not 0. */
ALI3_INLINED double worst_size(const ali3_system *S, const double *x, const double *factor, int32_t n, int32_t *worst) {
  (void)S;
  if (n >= ALI3_LARGE && ali3_finite_inlined(x, n)) {
    const double largest = ali3_largest_product(x, factor, n);
    int32_t i = 0;
    while (fabs(x[i]) * factor[i] < largest) i++;
    if (largest > 0.0) *worst = i;
    return largest;
  }
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

ALI3_BY_PROCESSOR(S, double, worst_size,
                  (const ali3_system *S, const double *x, const double *factor, int32_t n, int32_t *worst),
                  (S, x, factor, n, worst))

double ali3_violation(const ali3_system *S, const double *Phi, int32_t *worst) {
  return ali3_worst_size(S, Phi, S->row_measure, S->size.nc, worst);
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

ALI3_INLINED bool closed(const ali3_system *S, const double *Phi, double tolerance) {
  int64_t open = 0;
  ALI3_BY_FOURS
  for (int32_t k = 0; k < S->size.nc; k++)
    open |= fabs(Phi[k]) * S->row_measure[k] <= tolerance + S->row_round[k] ? 0 : 1;
  return open == 0;
}

ALI3_BY_PROCESSOR(S, bool, closed, (const ali3_system *S, const double *Phi, double tolerance), (S, Phi, tolerance))
