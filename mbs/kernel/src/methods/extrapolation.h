/* Polynomials through past steps. */
#ifndef ALI3_EXTRAPOLATION_H
#define ALI3_EXTRAPOLATION_H
#include "../algebra/real.h"
#include "../instance.h"

void ali3_lagrange(const real *time, int32_t n, real t, real *weight);
void ali3_history_miss(const ali3_instance *in, int32_t n, const real *weight);
truth ali3_history_smooth(const ali3_instance *in, int32_t n, double h, bool controlled);
void ali3_extrapolate(const ali3_instance *in, double when, int32_t n, real *a, real *lam);
#endif
