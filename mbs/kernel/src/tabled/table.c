/* Functions of one or two parameters as uniform cubic B-splines: twice continuously differentiable. Beyond the ends of
 * its table a function goes on along its tangent. */
#include "../algebra/lane_copies.h"
#include "../algebra/processor.h"
#include "tabled.h"

enum { WINDOW = 4 }; /* control points that a place depends on */
#ifdef ALI3_WIDTH
enum { LANES = ALI3_WIDTH };
#else
enum { LANES = 1 };
#endif

typedef struct {
  int32_t cell[LANES];
  real w[3][WINDOW]; /* weights of the value and of its two derivatives */
} window;

/* The cell of each lane, at most `last`, also as a number. */
static inline real cell_of(real place, int32_t last, int32_t cell[LANES]) {
#ifdef ALI3_WIDTH
  for (int l = 0; l < LANES; l++) {
    cell[l] = (int32_t)place[l] < last ? (int32_t)place[l] : last;
    place[l] = cell[l];
  }
  return place;
#else
  cell[0] = (int32_t)place < last ? (int32_t)place : last;
  return cell[0];
#endif
}

/* n control points of each lane from a place on, side by side; in the room where there are several lanes. */
static inline const real *points(const double *const point[LANES], int64_t at, int32_t n, real *room) {
#ifdef ALI3_WIDTH
  const double *from[LANES];
  for (int l = 0; l < LANES; l++) from[l] = point[l] + at;
  interleave((double *)room, from, n);
  return room;
#else
  (void)n, (void)room;
  return point[0] + at;
#endif
}

ALI3_INLINED window at(const double *axis, int32_t count, real x) {
  window n;
  const double per = 1.0 / axis[1], end = count - WINDOW + 1;
  const real place = (x - axis[0]) / axis[1], from = ali3_where(place > 0.0, place, ali3_same(0.0)),
             held = ali3_where(from < end, from, ali3_same(end)); /* NaN: the first cell, and NaN as weights */
  const real s = held - cell_of(held, count - WINDOW, n.cell), r = 1.0 - s, beyond = place - held;
  const real value[WINDOW] = {r * r * r / 6.0, (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0,
                              (4.0 - 6.0 * r * r + 3.0 * r * r * r) / 6.0, s * s * s / 6.0};
  const real first[WINDOW] = {-0.5 * r * r, s * (1.5 * s - 2.0), r * (2.0 - 1.5 * r), 0.5 * s * s};
  const real second[WINDOW] = {r, 3.0 * s - 2.0, 3.0 * r - 2.0, s};
  for (int i = 0; i < WINDOW; i++) {
    n.w[0][i] = value[i] + beyond * first[i];
    n.w[1][i] = per * first[i];
    n.w[2][i] = ali3_where(beyond == 0.0, per * per * second[i], 0.0 * beyond);
  }
  return n;
}

/* Sum of four control points, which are n numbers apart. */
ALI3_INLINED real weighed(const real w[WINDOW], const real *x, int32_t n) {
  return (w[0] * x[0] + w[1] * x[n]) + (w[2] * x[2 * n] + w[3] * x[3 * n]);
}

ALI3_INLINED void along_one(int32_t n, const window *x, const double *const point[LANES],
                            real value[restrict ALI3_TABLED_VALUES][ALI3_TABLED_BODY]) {
  real room[WINDOW * ALI3_TABLED_BODY];
  const real *v = points(point, 0, WINDOW * n, room);
  for (int32_t i = 0; i < n; i++) {
    value[0][i] = weighed(x->w[0], v + i, n);
    value[ALI3_BY_A][i] = weighed(x->w[1], v + i, n);
    value[ALI3_BY_AA][i] = weighed(x->w[2], v + i, n);
  }
}

/* `row`: from one control point along the first parameter to the next. */
ALI3_INLINED void along_two(int32_t n, int64_t row, const window *x, const window *y, const double *const point[LANES],
                            real value[restrict ALI3_TABLED_VALUES][ALI3_TABLED_BODY]) {
  real v[WINDOW * ALI3_TABLED_BODY], d[WINDOW * ALI3_TABLED_BODY], b[WINDOW * ALI3_TABLED_BODY];
  for (int k = 0; k < WINDOW; k++) {
    real room[WINDOW * ALI3_TABLED_BODY];
    const real *p = points(point, k * row, WINDOW * n, room);
    for (int32_t i = 0; i < n; i++) {
      v[k * n + i] = weighed(y->w[0], p + i, n);
      d[k * n + i] = weighed(y->w[1], p + i, n);
      b[k * n + i] = weighed(y->w[2], p + i, n);
    }
  }
  for (int32_t i = 0; i < n; i++) {
    value[0][i] = weighed(x->w[0], v + i, n);
    value[ALI3_BY_A][i] = weighed(x->w[1], v + i, n);
    value[ALI3_BY_B][i] = weighed(x->w[0], d + i, n);
    value[ALI3_BY_AA][i] = weighed(x->w[2], v + i, n);
    value[ALI3_BY_AB][i] = weighed(x->w[1], d + i, n);
    value[ALI3_BY_BB][i] = weighed(x->w[0], b + i, n);
  }
}

/* The loops of a body have a length that the compiler knows. */
ALI3_INLINED void tabled_table(const ali3_system *S, const ali3_tabled *c, real a, real b,
                               real value[ALI3_TABLED_VALUES][ALI3_TABLED_BODY]) {
  (void)S;
  const window x = at(c->axis, c->count[0], a);
  const bool body = c->n == ALI3_TABLED_BODY;
  const int64_t row = (int64_t)c->count[1] * c->n;
  const double *point[LANES];
  for (int l = 0; l < LANES; l++) point[l] = c->coef + x.cell[l] * row;
  if (c->count[1] == 1) {
    if (body)
      along_one(ALI3_TABLED_BODY, &x, point, value);
    else
      along_one(1, &x, point, value);
    return;
  }
  const window y = at(c->axis + 2, c->count[1], b);
  for (int l = 0; l < LANES; l++) point[l] += (int64_t)y.cell[l] * c->n;
  if (body)
    along_two(ALI3_TABLED_BODY, row, &x, &y, point, value);
  else
    along_two(1, row, &x, &y, point, value);
}

ALI3_BY_PROCESSOR(S, void, tabled_table,
                  (const ali3_system *S, const ali3_tabled *c, real a, real b,
                   real value[ALI3_TABLED_VALUES][ALI3_TABLED_BODY]),
                  (S, c, a, b, value))
