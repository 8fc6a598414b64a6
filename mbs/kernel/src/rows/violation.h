/* Violation of the rows (Phi, nc), m. A row counts as closed if it is at most the tolerance, m, plus its round-off. */
#ifndef ALI3_VIOLATION_H
#define ALI3_VIOLATION_H
#include "../system.h"

/* The largest of n sizes |x| factor, NaN if there is one; *worst becomes the first index that has it, if it is not
 * 0. */
double ali3_find_worst(const double *x, const double *factor, int32_t n, int32_t *worst);
/* Largest violation, NaN if there is one; *worst: its row, unchanged if it is 0. */
double ali3_violation(const ali3_system *S, const double *Phi, int32_t *worst);
/* Largest violation of a row beyond its round-off; of finite rows. */
double ali3_opening(const ali3_system *S, const double *Phi);
/* Sum of the absolute values of the terms of row k. */
double ali3_row_sum(const ali3_system *S, int32_t k, const double *q);
/* ali3_closed with the round-off at the present coordinates q, which may be far from those of the drawing. */
bool ali3_closed_at(const ali3_system *S, const double *Phi, const double *q, double tolerance);
/* Whether all rows are closed; false for NaN. */
bool ali3_closed(const ali3_system *S, const double *Phi, double tolerance);
#endif
