/* Functions of one or two parameters as uniform cubic B-splines: twice continuously differentiable. Beyond the ends of
 * its table a function goes on along its tangent. */
#include <math.h>
#include <string.h>

#include "tabled.h"

enum { WINDOW = 4 }; /* control points that a place depends on */

typedef struct {
  int32_t cell;
  double w[3][WINDOW]; /* weights of the value and of its two derivatives */
} window;

static window at(const double *axis, int32_t count, double x) {
  window n;
  const double per = 1.0 / axis[1], place = (x - axis[0]) / axis[1];
  const int32_t last = count - WINDOW; /* the last cell */
  const double held = fmin(fmax(place, 0.0), (double)(last + 1)); /* NaN: the first cell, and NaN as weights */
  n.cell = (int32_t)held;
  if (n.cell > last) n.cell = last;
  const double s = held - n.cell, r = 1.0 - s, beyond = place - held;
  const double value[WINDOW] = {r * r * r / 6.0, (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0,
                                (4.0 - 6.0 * r * r + 3.0 * r * r * r) / 6.0, s * s * s / 6.0};
  const double first[WINDOW] = {-0.5 * r * r, s * (1.5 * s - 2.0), r * (2.0 - 1.5 * r), 0.5 * s * s};
  const double second[WINDOW] = {r, 3.0 * s - 2.0, 3.0 * r - 2.0, s};
  for (int i = 0; i < WINDOW; i++) {
    n.w[0][i] = value[i] + beyond * first[i];
    n.w[1][i] = per * first[i];
    n.w[2][i] = beyond == 0.0 ? per * per * second[i] : 0.0 * beyond;
  }
  return n;
}

/* Sum of four numbers, `step` apart, by their weights. */
static inline double blend(const double w[WINDOW], const double *x, int64_t step) {
  return (w[0] * x[0] + w[1] * x[step]) + (w[2] * x[2 * step] + w[3] * x[3 * step]);
}

static inline void along_one(int32_t n, const window *x, const double *restrict point,
                             double value[restrict ALI3_TABLED_VALUES][ALI3_TABLED_BODY]) {
  for (int32_t i = 0; i < n; i++) {
    value[0][i] = blend(x->w[0], point + i, n);
    value[ALI3_BY_A][i] = blend(x->w[1], point + i, n);
    value[ALI3_BY_AA][i] = blend(x->w[2], point + i, n);
  }
}

/* `row`: from one control point along the first parameter to the next. */
static inline void along_two(int32_t n, int64_t row, const window *x, const window *y, const double *restrict point,
                             double value[restrict ALI3_TABLED_VALUES][ALI3_TABLED_BODY]) {
  for (int32_t i = 0; i < n; i++) {
    const double *p0 = point + i, *p1 = p0 + row, *p2 = p1 + row, *p3 = p2 + row;
    const double v[WINDOW] = {blend(y->w[0], p0, n), blend(y->w[0], p1, n), blend(y->w[0], p2, n), blend(y->w[0], p3, n)};
    const double d[WINDOW] = {blend(y->w[1], p0, n), blend(y->w[1], p1, n), blend(y->w[1], p2, n), blend(y->w[1], p3, n)};
    const double b[WINDOW] = {blend(y->w[2], p0, n), blend(y->w[2], p1, n), blend(y->w[2], p2, n), blend(y->w[2], p3, n)};
    value[0][i] = blend(x->w[0], v, 1);
    value[ALI3_BY_A][i] = blend(x->w[1], v, 1);
    value[ALI3_BY_B][i] = blend(x->w[0], d, 1);
    value[ALI3_BY_AA][i] = blend(x->w[2], v, 1);
    value[ALI3_BY_AB][i] = blend(x->w[1], d, 1);
    value[ALI3_BY_BB][i] = blend(x->w[0], b, 1);
  }
}

/* The loops of a body have a length that the compiler knows. */
void ali3_tabled_table(const ali3_tabled *c, double a, double b, double value[ALI3_TABLED_VALUES][ALI3_TABLED_BODY]) {
  const window x = at(c->axis, c->count[0], a);
  const bool body = c->n == ALI3_TABLED_BODY;
  if (c->count[1] == 1) {
    const double *point = c->coef + (int64_t)x.cell * c->n;
    if (body)
      along_one(ALI3_TABLED_BODY, &x, point, value);
    else
      along_one(1, &x, point, value);
    return;
  }
  const window y = at(c->axis + 2, c->count[1], b);
  const int64_t row = (int64_t)c->count[1] * c->n;
  const double *point = c->coef + x.cell * row + (int64_t)y.cell * c->n;
  if (body)
    along_two(ALI3_TABLED_BODY, row, &x, &y, point, value);
  else
    along_two(1, row, &x, &y, point, value);
}
