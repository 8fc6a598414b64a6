/* Whether numbers are finite. */
#ifndef ALI3_FINITE_H
#define ALI3_FINITE_H
#include <stdbool.h>
#include <stdint.h>

bool ali3_finite(const double *v, int64_t n);
#endif
