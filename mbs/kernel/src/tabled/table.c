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
  window n = {0};
  const double place = (x - axis[0]) / axis[1];
  const int32_t last = count - WINDOW; /* the last cell */
  const double held = fmin(fmax(place, 0.0), (double)(last + 1)); /* NaN: the first cell, and NaN as weights */
  n.cell = (int32_t)held;
  if (n.cell > last) n.cell = last;
  const double s = held - n.cell, r = 1.0 - s, beyond = place - held, per = 1.0 / axis[1];
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

/* to += factor from, n numbers. */
static inline void add(int32_t n, double factor, const double *restrict from, double *restrict to) {
  for (int32_t i = 0; i < n; i++) to[i] += factor * from[i];
}

void ali3_tabled_table(const ali3_tabled *c, double a, double b, double value[6][ALI3_TABLED_BODY]) {
  const window x = at(c->axis, c->count[0], a);
  const int32_t n = c->n;
  memset(value, 0, 6 * sizeof *value);
  if (c->count[1] == 1) {
    for (int i = 0; i < WINDOW; i++) {
      const double *point = c->coef + (int64_t)(x.cell + i) * n;
      add(n, x.w[0][i], point, value[0]);
      add(n, x.w[1][i], point, value[1]);
      add(n, x.w[2][i], point, value[3]);
    }
    return;
  }
  const window y = at(c->axis + 2, c->count[1], b);
  for (int i = 0; i < WINDOW; i++) {
    double row[3][ALI3_TABLED_BODY] = {{0.0}};
    const double *point = c->coef + ((int64_t)(x.cell + i) * c->count[1] + y.cell) * n;
    for (int j = 0; j < WINDOW; j++)
      for (int d = 0; d < 3; d++) add(n, y.w[d][j], point + (int64_t)j * n, row[d]);
    add(n, x.w[0][i], row[0], value[0]);
    add(n, x.w[1][i], row[0], value[1]);
    add(n, x.w[0][i], row[1], value[2]);
    add(n, x.w[2][i], row[0], value[3]);
    add(n, x.w[1][i], row[1], value[4]);
    add(n, x.w[0][i], row[2], value[5]);
  }
}
