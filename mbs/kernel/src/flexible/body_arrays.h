/* View of one flexible body in the arrays of a System and of an instance, and loops over its modes. */
#ifndef ALI3_BODY_ARRAYS_H
#define ALI3_BODY_ARRAYS_H
#include <string.h>

#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../algebra/real.h"
#include "../instance.h"

enum {
  ALI3_FLEX_AXES = 0,
  ALI3_FLEX_FIRST = 9,
  ALI3_FLEX_SECOND = 12,
  ALI3_FLEX_COUPLING = 21,
  ALI3_FLEX_OF_MODE = 9
}; /* offsets in the work array of a body: A, S, J, then D with ALI3_FLEX_OF_MODE numbers a mode */

typedef struct {
  int32_t n;                          /* modes, whose amplitudes are eta */
  const int32_t *frame, *mode,
      *loc;  /* 12, n: coordinates of r, a, b, c and of eta; 12 + n: their places in the front */
  const real *P, *c;                  /* 3 x n, 9 x n by rows: as flex_P and flex_c */
  const double *E, *H;                /* 6, 3 matrices n x n by columns: symmetric and skew ones of flex_T */
  const double *K, *C, *gravity;      /* n x n by columns: stiffness, damping of eta; 3, m/s^2, earth axes */
  real *A, *S;                        /* 9: axes a, b, c one after the other; 3, kg m: P eta */
  real *J, *D;                        /* 9, kg m^2: J - J0; 9 x n by rows D_ik, see flexible_body.c */
} ali3_flexible;

/* The view of flexible body b. */
static inline ali3_flexible ali3_flexible_of(const ali3_instance *in, int32_t b) {
  const ali3_system *s = in->system;
  const int64_t first = s->flex_mode_ptr[b], n = s->flex_mode_ptr[b + 1] - first, square = s->flex_square[b];
#ifdef ALI3_WIDTH
  const real *P = in->flexible.P, *c = in->flexible.c;
#else
  const double *P = s->flex_P, *c = s->flex_c;
#endif
  real *work = in->flexible.prepared + ALI3_FLEX_COUPLING * (int64_t)b + ALI3_FLEX_OF_MODE * first;
  const ali3_flexible f = {.n = (int32_t)n,
                           .frame = s->flex_frame + 12 * (int64_t)b,
                           .mode = s->flex_mode + first,
                           .loc = s->flex_loc + 12 * (int64_t)b + first,
                           .P = P + 3 * first,
                           .c = c + 9 * first,
                           .E = s->flex_T + 9 * square,
                           .H = s->flex_T + 9 * square + 6 * n * n,
                           .K = s->flex_K + square,
                           .C = s->flex_C + square,
                           .gravity = s->flex_gravity + 3 * (int64_t)b,
                           .A = work + ALI3_FLEX_AXES,
                           .S = work + ALI3_FLEX_FIRST,
                           .J = work + ALI3_FLEX_SECOND,
                           .D = work + ALI3_FLEX_COUPLING};
  return f;
}

#ifndef ALI3_WIDTH
enum { ALI3_FEW = 2, ALI3_MANY = 8 }; /* vectors of four rows in a tile: small and large tiles */

/* Writes rows i to i + 4 n_vectors - 1 of start + M x, summed in registers in the order of `ali3_add_product`. */
ALI3_INLINED void ali3_tile(int64_t n, const double *M, const double *x, const ali3_double4 *start, int n_vectors,
                            int64_t i, double *out) {
  ali3_double4 sum[ALI3_MANY];
  ALI3_UNROLLED
  for (int t = 0; t < n_vectors; t++) sum[t] = start[t];
  const double *a = M + i, *b = a + n, *c = b + n, *d = c + n;
  int64_t l = 0;
  ALI3_SHORT
  for (; l + 3 < n; l += 4) {
    ALI3_UNROLLED
    for (int t = 0; t < n_vectors; t++)
      sum[t] += (((const ali3_double4 *)a)[t] * x[l] + ((const ali3_double4 *)b)[t] * x[l + 1]) +
                (((const ali3_double4 *)c)[t] * x[l + 2] + ((const ali3_double4 *)d)[t] * x[l + 3]);
    a += 4 * n, b += 4 * n, c += 4 * n, d += 4 * n;
  }
  ALI3_SHORT
  for (; l < n; l++, a += n) {
    ALI3_UNROLLED
    for (int t = 0; t < n_vectors; t++) sum[t] += ((const ali3_double4 *)a)[t] * x[l];
  }
  ALI3_UNROLLED
  for (int t = 0; t < n_vectors; t++) ((ali3_double4 *)(out + i))[t] = sum[t];
}

/* out = start + M x, M by columns; four columns at once. The last rows may be computed twice, with the same result. */
ALI3_INLINED void ali3_add_product(int32_t n, const double *restrict M, const double *restrict x, const double *start,
                                   double *out) {
  const int32_t few = 4 * ALI3_FEW, many = 4 * ALI3_MANY;
  ali3_double4 last[ALI3_FEW] = {{0}}; /* before `out`, which may be `start`, is written */
  int32_t i = 0;
  for (int t = 0; t < ALI3_FEW && n >= few; t++) last[t] = ((const ali3_double4 *)(start + n - few))[t];
  for (; i + many <= n; i += many) ali3_tile(n, M, x, (const ali3_double4 *)(start + i), ALI3_MANY, i, out);
  for (; i + few <= n; i += few) ali3_tile(n, M, x, (const ali3_double4 *)(start + i), ALI3_FEW, i, out);
  if (i < n && n >= few) ali3_tile(n, M, x, last, ALI3_FEW, n - few, out);
  for (; i < n && n < few; i++) {
    double sum = start[i];
    int32_t l = 0;
    for (; l + 3 < n; l += 4)
      sum += (M[l * n + i] * x[l] + M[(l + 1) * n + i] * x[l + 1]) +
             (M[(l + 2) * n + i] * x[l + 2] + M[(l + 3) * n + i] * x[l + 3]);
    for (; l < n; l++) sum += M[l * n + i] * x[l];
    out[i] = sum;
  }
}
#else
/* out = start + M x, M by columns; four columns at once. */
static inline void ali3_add_product(int32_t n, const double *restrict M, const real *restrict x, const real *start,
                                    real *out) {
  int32_t l = 0;
  if (out != start) memcpy(out, start, (size_t)n * sizeof *out);
  for (; l + 3 < n; l += 4) {
    const double *restrict c0 = M + (int64_t)l * n, *restrict c1 = c0 + n, *restrict c2 = c1 + n, *restrict c3 = c2 + n;
    const real x0 = x[l], x1 = x[l + 1], x2 = x[l + 2], x3 = x[l + 3];
    for (int32_t i = 0; i < n; i++) out[i] += (c0[i] * x0 + c1[i] * x1) + (c2[i] * x2 + c3[i] * x3);
  }
  for (; l < n; l++) {
    const double *restrict column = M + (int64_t)l * n;
    const real factor = x[l];
    for (int32_t i = 0; i < n; i++) out[i] += column[i] * factor;
  }
}
#endif

/* out += M x */
ALI3_INLINED void ali3_accumulate(int32_t n, const double *restrict M, const real *restrict x, real *out) {
  ali3_add_product(n, M, x, out, out);
}

/* Dot products of x with three contiguous rows. */
ALI3_INLINED void ali3_three_products(int32_t n, const real *restrict rows, const real *restrict x, real out[3]) {
  for (int k = 0; k < 3; k++) out[k] = ali3_product_backward(rows + k * n, x, n);
}

/* Adds three contiguous rows times their factors to y, one after the other. */
ALI3_INLINED void ali3_add_three_rows(int32_t n, const real *restrict rows, const real *factor, real *restrict y) {
  const real *restrict second = rows + n, *restrict third = second + n;
  const real a = factor[0], b = factor[1], c = factor[2];
  ALI3_EACH(0, n, ALI3_AT(y) = ((ALI3_AT(y) + ALI3_AT(rows) * a) + ALI3_AT(second) * b) + ALI3_AT(third) * c)
}

/* to[i] = from[index[i]] */
static inline void ali3_gather(int32_t n, const int32_t *index, const real *from, real *to) {
  for (int32_t i = 0; i < n; i++) to[i] = from[index[i]];
}

/* Adds weight x to the coordinates of the modes. */
ALI3_INLINED void ali3_add_to_modes(const ali3_flexible *f, const real *x, double weight, real *to) {
  for (int32_t j = 0; j < f->n; j++) to[f->mode[j]] += weight * x[j];
}
#endif
