/* Value, derivatives and means of a curve of cubic pieces, and checks of its table. Between two points the cubic has
 * their values and slopes (Hermite). */
#include "cubic_table.h"

#include <math.h>
#include <stddef.h>

ali3_cubic_table ali3_cubic_table_at(const double *real, int32_t n, int integral) {
  return (ali3_cubic_table){n, real, real + n, real + 2 * (size_t)n, integral ? real + 3 * (size_t)n : NULL};
}

static const double ROUND_OFF = 1e-9; /* relative difference of an integral in a file and of its curve */

/* A piece y + d (m + d (c + d e)) with d = x - start. */
typedef struct {
  double start, y, m, c, e;
  double integral; /* of y from x = 0 to the start */
} piece;

/* Number of the piece that contains x: 0 before the first point, n after the last. */
static int32_t find_piece(const ali3_cubic_table *t, double x) {
  int32_t low = 0, high = t->n;
  while (low < high) { /* x[low - 1] <= x < x[high] */
    const int32_t middle = low + (high - low) / 2;
    if (t->x[middle] <= x) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/* Coefficients of a piece; 0 and n are straight lines outside the table. */
static piece make_piece(const ali3_cubic_table *t, int32_t number) {
  const int32_t i = number > 0 ? number - 1 : 0;
  piece p = {.start = t->x[i], .y = t->y[i], .m = t->slope[i], .integral = t->integral != NULL ? t->integral[i] : 0.0};
  if (number == 0 || number == t->n) return p;
  const double width = t->x[i + 1] - p.start, secant = (t->y[i + 1] - p.y) / width, end = t->slope[i + 1];
  p.c = (3.0 * secant - 2.0 * p.m - end) / width;
  p.e = (p.m + end - 2.0 * secant) / width / width;
  return p;
}

/* Value of a piece at x. */
static double evaluate_piece(const piece *p, double x) {
  const double d = x - p->start;
  return p->y + d * (p->m + d * (p->c + d * p->e));
}

/* Slope of a piece, d beyond its start. */
static double find_slope(const piece *p, double d) { return p->m + d * (2.0 * p->c + d * 3.0 * p->e); }

/* Integral of y from x = 0 to a place in a piece, d beyond its start. */
static double integrate_piece(const piece *p, double d) {
  return p->integral + d * (p->y + d * (0.5 * p->m + d * (p->c / 3.0 + d * 0.25 * p->e)));
}

double ali3_cubic_value(const ali3_cubic_table *t, double x, double *slope, double *integral) {
  const piece p = make_piece(t, find_piece(t, x));
  const double d = x - p.start;
  *slope = find_slope(&p, d);
  if (integral != NULL) *integral += integrate_piece(&p, d);
  return evaluate_piece(&p, x);
}

double ali3_cubic_derivatives(const ali3_cubic_table *t, double x, double *slope, double *curvature) {
  const piece p = make_piece(t, find_piece(t, x));
  const double d = x - p.start;
  *slope = find_slope(&p, d);
  *curvature = 2.0 * p.c + d * 6.0 * p.e;
  return evaluate_piece(&p, x);
}

/* Simpson's rule is exact on every piece. */
double ali3_cubic_mean(const ali3_cubic_table *t, double x0, double x1) {
  const double low = fmin(x0, x1), high = fmax(x0, x1), width = high - low;
  const int32_t first = find_piece(t, low);
  piece p = make_piece(t, first);
  if (!(width > 0.0)) return evaluate_piece(&p, low);
  double mean = 0.0, from = low;
  for (int32_t k = first; from < high; p = make_piece(t, ++k)) {
    const double to = k < t->n && t->x[k] < high ? t->x[k] : high;
    mean += (to - from) / width *
            ((evaluate_piece(&p, from) + 4.0 * evaluate_piece(&p, 0.5 * (from + to)) + evaluate_piece(&p, to)) / 6.0);
    if (k >= t->n) break;
    from = to;
  }
  return mean;
}

static const double NEAR = 1e-6; /* of the way: a nearer point is at its start or end */

double ali3_cubic_departure(const double y[2], const double rise[2], double u, double value) {
  const double v = 1.0 - u;
  return fabs(value - v * v * (y[0] * (1.0 + 2.0 * u) + rise[0] * u) - u * u * (y[1] * (1.0 + 2.0 * v) - rise[1] * v));
}

/* Fraction of the way from x0 to x1 of the point that departs most from the cubic through both, if by too much;
 * otherwise 1. `part`: what it is of the whole way. */
static double find_departing_point(const ali3_cubic_table *t, double x0, double x1, double part, double share,
                                   double least) {
  const double low = fmin(x0, x1), high = fmax(x0, x1), way = x1 - x0;
  const int32_t first = find_piece(t, low);
  int32_t last = first;
  while (last < t->n && t->x[last] < high) last++;
  if (last == first) return 1.0;
  const piece p0 = make_piece(t, way > 0.0 ? first : last), p1 = make_piece(t, way > 0.0 ? last : first);
  const double y[2] = {evaluate_piece(&p0, x0), evaluate_piece(&p1, x1)},
               rise[2] = {way * find_slope(&p0, x0 - p0.start), way * find_slope(&p1, x1 - p1.start)},
               largest = fmax(least, fmax(fabs(y[0]), fabs(y[1])));
  double most = 0.0, fraction = 1.0;
  for (int32_t k = first; k < last; k++) {
    const double u = (t->x[k] - x0) / way, departure = ali3_cubic_departure(y, rise, u, t->y[k]);
    if (!(part * u > NEAR && 1.0 - u > NEAR && departure > most && departure > share * fmax(largest, fabs(t->y[k]))))
      continue;
    most = departure;
    fraction = u;
  }
  return fraction;
}

double ali3_cubic_resolved(const ali3_cubic_table *t, double x0, double x1, double share, double least) {
  double resolved = 1.0;
  for (double part = 0.0; part < 1.0; resolved *= part)
    part = find_departing_point(t, x0, x0 + resolved * (x1 - x0), resolved, share, least);
  return resolved;
}

int ali3_cubic_rises(const ali3_cubic_table *t) {
  for (int32_t i = 1; i < t->n; i++)
    if (!(t->x[i] > t->x[i - 1])) return 0;
  return 1;
}

int ali3_cubic_integrals_fit(const ali3_cubic_table *t) {
  for (int32_t i = 0; i + 1 < t->n; i++) {
    const piece p = make_piece(t, i + 1);
    const double d = t->x[i + 1] - p.start;
    const double end = integrate_piece(&p, d);
    if (!(fabs(t->integral[i + 1] - end) <= ROUND_OFF * (fabs(end) + fabs(p.integral) + fabs(d * p.y)))) return 0;
  }
  double slope, integral_at_zero = 0.0, largest = 0.0;
  ali3_cubic_value(t, 0.0, &slope, &integral_at_zero);
  for (int32_t i = 0; i < t->n; i++) largest = fmax(largest, fabs(t->integral[i]));
  return fabs(integral_at_zero) <= ROUND_OFF * largest;
}
