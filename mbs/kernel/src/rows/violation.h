/* Violation of the rows, in metres. */
#ifndef ALI3_VIOLATION_H
#define ALI3_VIOLATION_H
#include "../system.h"

double ali3_worst_size(const double *x, const double *factor, int32_t n, int32_t *worst);
double ali3_violation(const ali3_system *S, const double *Phi, int32_t *worst);
double ali3_opening(const ali3_system *S, const double *Phi);
double ali3_row_sum(const ali3_system *S, int32_t k, const double *q);
bool ali3_closed_here(const ali3_system *S, const double *Phi, const double *q, double tolerance);
bool ali3_closed(const ali3_system *S, const double *Phi, double tolerance);
#endif
