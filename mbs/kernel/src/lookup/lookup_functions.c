/* Functions of one or two parameters as uniform cubic B-splines, twice continuously differentiable. Beyond its table a
 * function continues along its tangent. */
#include "../algebra/lane_copies.h"
#include "../algebra/processor.h"
#include "lookup.h"

enum { WINDOW = 4 }; /* number of control points with influence at a position */
#ifdef ALI3_WIDTH
enum { LANES = ALI3_WIDTH };
#else
enum { LANES = 1 };
#endif

/* Control points that a function depends on at one parameter. */
typedef struct {
  int32_t cell[LANES]; /* index of the first one */
  real w[3][WINDOW]; /* weights of the value and of its two derivatives */
} window;

/* Cell index of each lane, at most `last`; returned also as a number. */
static inline real find_cell(real place, int32_t last, int32_t cell[LANES]) {
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

/* n control points of each lane from offset `at` on, interleaved in the buffer if there are several lanes. */
static inline const real *gather_points(const double *const point[LANES], int64_t offset, int32_t n, real *buffer) {
#ifdef ALI3_WIDTH
  const double *from[LANES];
  for (int l = 0; l < LANES; l++) from[l] = point[l] + offset;
  interleave((double *)buffer, from, n);
  return buffer;
#else
  (void)n, (void)buffer;
  return point[0] + offset;
#endif
}

/* Cells and weights at parameter x of a table with `count` control points; axis: first point, spacing. */
ALI3_INLINED window find_window(const double *axis, int32_t count, real x) {
  window n;
  const double inverse_spacing = 1.0 / axis[1], end = count - WINDOW + 1;
  const real place = (x - axis[0]) / axis[1], from = ali3_where(place > 0.0, place, ali3_same(0.0)),
             clamped = ali3_where(from < end, from, ali3_same(end)); /* NaN: the first cell, and NaN as weights */
  const real s = clamped - find_cell(clamped, count - WINDOW, n.cell), r = 1.0 - s, beyond = place - clamped;
  const real value[WINDOW] = {r * r * r / 6.0, (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0,
                              (4.0 - 6.0 * r * r + 3.0 * r * r * r) / 6.0, s * s * s / 6.0};
  const real first[WINDOW] = {-0.5 * r * r, s * (1.5 * s - 2.0), r * (2.0 - 1.5 * r), 0.5 * s * s};
  const real second[WINDOW] = {r, 3.0 * s - 2.0, 3.0 * r - 2.0, s};
  for (int i = 0; i < WINDOW; i++) {
    n.w[0][i] = value[i] + beyond * first[i];
    n.w[1][i] = inverse_spacing * first[i];
    n.w[2][i] = ali3_where(beyond == 0.0, inverse_spacing * inverse_spacing * second[i], 0.0 * beyond);
  }
  return n;
}

/* Weighted sum of four control points at a stride of n numbers. */
ALI3_INLINED real weighted_sum(const real w[WINDOW], const real *x, int32_t n) {
  return (w[0] * x[0] + w[1] * x[n]) + (w[2] * x[2 * n] + w[3] * x[3 * n]);
}

/* Value and derivatives by one parameter of n functions. */
ALI3_INLINED void evaluate_one_parameter(int32_t n, const window *x, const double *const point[LANES],
                                         real value[restrict ALI3_LOOKUP_VALUES][ALI3_LOOKUP_BODY]) {
  real buffer[WINDOW * ALI3_LOOKUP_BODY];
  const real *v = gather_points(point, 0, WINDOW * n, buffer);
  for (int32_t i = 0; i < n; i++) {
    value[0][i] = weighted_sum(x->w[0], v + i, n);
    value[ALI3_BY_A][i] = weighted_sum(x->w[1], v + i, n);
    value[ALI3_BY_AA][i] = weighted_sum(x->w[2], v + i, n);
  }
}

/* The same by two parameters. `row`: stride between control points along the first one. */
ALI3_INLINED void evaluate_two_parameters(int32_t n, int64_t row, const window *x, const window *y,
                                          const double *const point[LANES],
                                          real value[restrict ALI3_LOOKUP_VALUES][ALI3_LOOKUP_BODY]) {
  real v[WINDOW * ALI3_LOOKUP_BODY], d[WINDOW * ALI3_LOOKUP_BODY], b[WINDOW * ALI3_LOOKUP_BODY];
  for (int k = 0; k < WINDOW; k++) {
    real buffer[WINDOW * ALI3_LOOKUP_BODY];
    const real *p = gather_points(point, k * row, WINDOW * n, buffer);
    for (int32_t i = 0; i < n; i++) {
      v[k * n + i] = weighted_sum(y->w[0], p + i, n);
      d[k * n + i] = weighted_sum(y->w[1], p + i, n);
      b[k * n + i] = weighted_sum(y->w[2], p + i, n);
    }
  }
  for (int32_t i = 0; i < n; i++) {
    value[0][i] = weighted_sum(x->w[0], v + i, n);
    value[ALI3_BY_A][i] = weighted_sum(x->w[1], v + i, n);
    value[ALI3_BY_B][i] = weighted_sum(x->w[0], d + i, n);
    value[ALI3_BY_AA][i] = weighted_sum(x->w[2], v + i, n);
    value[ALI3_BY_AB][i] = weighted_sum(x->w[1], d + i, n);
    value[ALI3_BY_BB][i] = weighted_sum(x->w[0], b + i, n);
  }
}

/* The loops of a body have a length known to the compiler. */
ALI3_INLINED void lookup_table(const ali3_system *S, const ali3_lookup *c, real a, real b,
                               real value[ALI3_LOOKUP_VALUES][ALI3_LOOKUP_BODY]) {
  (void)S;
  const window x = find_window(c->axis, c->count[0], a);
  const bool body = c->n == ALI3_LOOKUP_BODY;
  const int64_t row = (int64_t)c->count[1] * c->n;
  const double *point[LANES];
  for (int l = 0; l < LANES; l++) point[l] = c->coef + x.cell[l] * row;
  if (c->count[1] == 1) {
    if (body)
      evaluate_one_parameter(ALI3_LOOKUP_BODY, &x, point, value);
    else
      evaluate_one_parameter(1, &x, point, value);
    return;
  }
  const window y = find_window(c->axis + 2, c->count[1], b);
  for (int l = 0; l < LANES; l++) point[l] += (int64_t)y.cell[l] * c->n;
  if (body)
    evaluate_two_parameters(ALI3_LOOKUP_BODY, row, &x, &y, point, value);
  else
    evaluate_two_parameters(1, row, &x, &y, point, value);
}

ALI3_BY_PROCESSOR(S, void, lookup_table,
                  (const ali3_system *S, const ali3_lookup *c, real a, real b,
                   real value[ALI3_LOOKUP_VALUES][ALI3_LOOKUP_BODY]),
                  (S, c, a, b, value))
