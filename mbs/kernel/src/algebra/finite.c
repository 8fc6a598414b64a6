/* Tests whether all numbers are finite. */
#include "finite.h"

bool ali3_finite(const double *v, int64_t n) { return ali3_finite_inlined(v, n); }
