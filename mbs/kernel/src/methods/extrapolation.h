/* Extrapolation of past accelerations and multipliers. */
#ifndef ALI3_EXTRAPOLATION_H
#define ALI3_EXTRAPOLATION_H
#include "../algebra/real.h"
#include "../instance.h"

ALI3_PER_WIDTH void ali3_lagrange(const real *time, int32_t n, real t, real *weight);
ALI3_PER_WIDTH void ali3_history_miss(const ali3_instance *in, int32_t n, const real *weight);
ALI3_PER_WIDTH truth ali3_history_smooth(const ali3_instance *in, int32_t n, double h, bool controlled);
ALI3_PER_WIDTH void ali3_extrapolate(const ali3_instance *in, double when, int32_t n, real *a, real *lam);
#endif
