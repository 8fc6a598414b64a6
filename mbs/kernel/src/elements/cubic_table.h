/* A curve through points by cubic pieces with continuous slopes (Hermite), straight beyond its ends. */
#ifndef ALI3_CUBIC_TABLE_H
#define ALI3_CUBIC_TABLE_H
#include <stdint.h>

typedef struct {
  int32_t n; /* points, two at least */
  const double *x, *y, *slope; /* x rises */
  const double *integral; /* of y from x = 0 to each point; NULL: not available */
} ali3_cubic_table;

/* Table with columns of n numbers one after the other at `real`. */
ali3_cubic_table ali3_cubic_table_at(const double *real, int32_t n, int integral);

/* y at x and its slope; adds the integral of y from 0 to x to *integral, unless that is NULL. */
double ali3_cubic_value(const ali3_cubic_table *t, double x, double *slope, double *integral);

/* y at x with its first and second derivative. */
double ali3_cubic_derivatives(const ali3_cubic_table *t, double x, double *slope, double *curvature);

/* Mean of y from x0 to x1: the difference quotient of the integral, free of cancellation. */
double ali3_cubic_mean(const ali3_cubic_table *t, double x0, double x1);

/* Distance of a value, at the fraction u of a way, from the cubic with the values y and the slopes times the way `rise`
 * at both ends. */
double ali3_cubic_departure(const double y[2], const double rise[2], double u, double value);

/* Fraction of the way from x0 to x1, to x1 or a point of the table, on which values and slopes at both ends tell y: no
 * point departs from the cubic through them by more than `share` of the largest of |y| and `least`. */
double ali3_cubic_resolved(const ali3_cubic_table *t, double x0, double x1, double share, double least);

/* Whether x rises. */
int ali3_cubic_rises(const ali3_cubic_table *t);
/* Whether the integrals belong to y. */
int ali3_cubic_integrals_fit(const ali3_cubic_table *t);
#endif
