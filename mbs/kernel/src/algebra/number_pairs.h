/* Loops over contiguous numbers in vectors of four. Element-wise loops give the bits of a scalar loop; sums have
 * the order that each function states, the same for one instance and for lanes. */
#ifndef ALI3_NUMBER_PAIRS_H
#define ALI3_NUMBER_PAIRS_H
#include <stdbool.h>
#include <stdint.h>

#include "real.h"

/* Before a loop that is short or already written in vectors. */
#if defined(__clang__)
#define ALI3_SHORT _Pragma("clang loop unroll(disable) vectorize(disable)")
#else
#define ALI3_SHORT
#endif

/* Before a loop of constant length whose values stay in registers. */
#if defined(__clang__)
#define ALI3_UNROLLED _Pragma("clang loop unroll(full)")
#else
#define ALI3_UNROLLED
#endif

/* Before a loop over few numbers, for vectors of four in AVX2 and of two otherwise. */
#if defined(__clang__) && !defined(ALI3_WIDTH)
#define ALI3_BY_FOURS _Pragma("clang loop vectorize_width(4) interleave_count(1)")
#else
#define ALI3_BY_FOURS
#endif

/* Whether n ascending indices are consecutive, as those of modes mostly are. */
static inline bool ali3_consecutive(const int32_t *place, int32_t n) {
  return n > 0 && place[n - 1] - place[0] == n - 1;
}

/* First entry of a column of length n to compute for the entries from `from` on, so that their number is a multiple of
 * four: up to three entries above the diagonal are computed and never read. `from` itself if there are fewer. */
static inline int32_t ali3_padded_start(int32_t from, int32_t n) {
#ifdef ALI3_WIDTH
  (void)n;
  return from;
#else
  const int32_t more = (from - n) & 3;
  return from >= more ? from - more : from;
#endif
}

/* The same for `from` >= 3, without the comparison. */
static inline int64_t ali3_padded_start_unclipped(int64_t from, int64_t n) {
#ifdef ALI3_WIDTH
  (void)n;
  return from;
#else
  return n - ((n - from + 3) & ~(int64_t)3);
#endif
}

#ifndef ALI3_WIDTH
typedef double ali3_double4 __attribute__((vector_size(32), aligned(8), may_alias));
#endif

/* Executes a statement for each i from `from` to n - 1, in which ALI3_AT(x) is entry i of x, or four entries from i on,
 * without the loop variants that compilers add to vectorised loops. */
#define ALI3_AT(x) (*(entry *)((x) + i))
#ifdef ALI3_WIDTH
#define ALI3_EACH(from, n, statement)                                                                                  \
  for (int64_t i = from; i < (n); i++) {                                                                               \
    typedef real entry;                                                                                                \
    statement;                                                                                                         \
  }
#else
#define ALI3_EACH(from, n, statement)                                                                                  \
  {                                                                                                                    \
    int64_t i = from;                                                                                                  \
    ALI3_SHORT                                                                                                         \
    for (const int64_t whole = (n) - 3; i < whole; i += 4) {                                                           \
      typedef ali3_double4 entry;                                                                                      \
      statement;                                                                                                       \
    }                                                                                                                  \
    ALI3_SHORT                                                                                                         \
    for (; i < (n); i++) {                                                                                             \
      typedef double entry;                                                                                            \
      statement;                                                                                                       \
    }                                                                                                                  \
  }
#endif

/* y += a x */
static inline void ali3_add_multiple(real *restrict y, const real *restrict x, real a, int64_t n) {
  ALI3_EACH(0, n, ALI3_AT(y) += a * ALI3_AT(x))
}

/* y += x */
static inline void ali3_add(real *restrict y, const real *restrict x, int64_t n) {
  ALI3_EACH(0, n, ALI3_AT(y) += ALI3_AT(x))
}

static inline void ali3_copy(real *restrict y, const real *restrict x, int64_t n) {
  for (int64_t i = 0; i < n; i++) y[i] = x[i];
}

/* y -= a x + b z */
static inline void ali3_subtract_two_multiples(real *restrict y, const real *restrict x, real a, const real *restrict z,
                                               real b, int64_t n) {
  ALI3_EACH(0, n, ALI3_AT(y) -= ALI3_AT(x) * a + ALI3_AT(z) * b)
}

/* Dot product in two alternating sums, so that additions are pipelined. In separate loops: a vector load of y[0], which
 * back substitution has just written alone, would wait for the cache. */
static inline real ali3_product_in_two(const real *restrict x, const real *restrict y, int64_t n) {
  real even = {0}, odd = {0};
  ALI3_SHORT
  for (int64_t i = 0; i < n; i += 2) even += x[i] * y[i];
  ALI3_SHORT
  for (int64_t i = 1; i < n; i += 2) odd += x[i] * y[i];
  return even + odd;
}

#ifndef ALI3_WIDTH
/* Dot product in four sums, from the end to the start: the first entries, which back substitution has found last, enter
 * the last additions. */
static inline double ali3_product_backward(const double *restrict x, const double *restrict y, int64_t n) {
  ali3_double4 sum = {0};
  int64_t i = n;
  ALI3_SHORT
  for (; i >= 4; i -= 4) sum += *(const ali3_double4 *)(x + i - 4) * *(const ali3_double4 *)(y + i - 4);
  double all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  ALI3_SHORT
  while (i-- > 0) all += x[i] * y[i];
  return all;
}

#define ali3_shared_product_backward ali3_product_backward /* x: the same numbers in all lanes */

/* Dot product of x + z with y in the same order. */
static inline double ali3_sum_product_backward(const double *restrict x, const double *restrict z,
                                               const double *restrict y, int64_t n) {
  ali3_double4 sum = {0};
  int64_t i = n;
  ALI3_SHORT
  for (; i >= 4; i -= 4)
    sum +=
        (*(const ali3_double4 *)(x + i - 4) + *(const ali3_double4 *)(z + i - 4)) * *(const ali3_double4 *)(y + i - 4);
  double all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  ALI3_SHORT
  while (i-- > 0) all += (x[i] + z[i]) * y[i];
  return all;
}

#else
/* The same sums for lanes, in the same order as for one instance. */
#define ALI3_BACKWARD(name, declared, term)                                                                            \
  static inline real name declared {                                                                                   \
    real sum[4] = {0};                                                                                                 \
    int64_t i = n;                                                                                                     \
    for (; i >= 4; i -= 4)                                                                                             \
      for (int k = 0; k < 4; k++) sum[k] += term(i - 4 + k);                                                           \
    real all = (sum[0] + sum[1]) + (sum[2] + sum[3]);                                                                  \
    while (i-- > 0) all += term(i);                                                                                    \
    return all;                                                                                                        \
  }
#define ALI3_PRODUCT(i) (x[i] * y[i])
#define ALI3_SUM_PRODUCT(i) ((x[i] + z[i]) * y[i])
ALI3_BACKWARD(ali3_product_backward, (const real *restrict x, const real *restrict y, int64_t n), ALI3_PRODUCT)
ALI3_BACKWARD(ali3_shared_product_backward, (const double *restrict x, const real *restrict y, int64_t n), ALI3_PRODUCT)
ALI3_BACKWARD(ali3_sum_product_backward,
              (const real *restrict x, const double *restrict z, const real *restrict y, int64_t n), ALI3_SUM_PRODUCT)
#endif

/* Largest absolute value of n numbers times factors; NaN are ignored. */
static inline real ali3_largest_product(const real *x, const double *factor, int64_t n) {
  real most = {0};
  for (int64_t i = 0; i < n; i++) {
    const real size = ali3_abs(x[i] * factor[i]);
    most = ali3_where(size > most, size, most);
  }
  return most;
}

/* Largest absolute value of n numbers. */
static inline real ali3_largest(const real *x, int64_t n) {
  real most = {0};
  for (int64_t i = 0; i < n; i++) most = ali3_where(ali3_abs(x[i]) > most, ali3_abs(x[i]), most);
  return most;
}

/* Three numbers in registers: of one instance a vector of four, whose last number is the next one in memory. It is read
 * and not used, so that arrays passed here have one number more (`ali3_pool_padded`). */
#ifdef ALI3_WIDTH
typedef struct {
  real x, y, z;
} ali3_three;

static inline void ali3_three_begin(ali3_three *to, const double *a) {
  *to = (ali3_three){ali3_same(a[0]), ali3_same(a[1]), ali3_same(a[2])};
}

/* to += a x */
static inline void ali3_three_add(ali3_three *to, const real *x, real a) {
  to->x += a * x[0];
  to->y += a * x[1];
  to->z += a * x[2];
}

/* to += a[i] x[i] */
static inline void ali3_three_add_each(ali3_three *to, const double *a, const real *x) {
  to->x += a[0] * x[0];
  to->y += a[1] * x[1];
  to->z += a[2] * x[2];
}

static inline void ali3_three_put(real *to, const ali3_three *a) { to[0] = a->x, to[1] = a->y, to[2] = a->z; }

static inline void ali3_three_plus(ali3_three *to, const ali3_three *a) { to->x += a->x, to->y += a->y, to->z += a->z; }

/* sum + a . x */
static inline real ali3_three_sum(real sum, const ali3_three *a, const real *x) {
  return sum + a->x * x[0] + a->y * x[1] + a->z * x[2];
}
#else
typedef ali3_double4 ali3_three;

static inline void ali3_three_begin(ali3_three *to, const double *a) { *to = (ali3_three){a[0], a[1], a[2], 0.0}; }

static inline void ali3_three_add(ali3_three *to, const double *x, double a) { *to += a * *(const ali3_double4 *)x; }

static inline void ali3_three_add_each(ali3_three *to, const double *a, const double *x) {
  *to += *(const ali3_double4 *)a * *(const ali3_double4 *)x;
}

/* Overwrites a fourth number, which is written afterwards or not used. */
static inline void ali3_three_put(double *to, const ali3_three *a) { *(ali3_double4 *)to = *a; }

static inline void ali3_three_plus(ali3_three *to, const ali3_three *a) { *to += *a; }

static inline double ali3_three_sum(double sum, const ali3_three *a, const double *x) {
  const ali3_double4 product = *a * *(const ali3_double4 *)x;
  return sum + product[0] + product[1] + product[2];
}
#endif

/* sum plus the dot product of the components of a point in Phi_q and in coordinates. */
static inline real ali3_points_sum(real sum, const real *x, const real *y) {
#ifdef ALI3_WIDTH
  return sum + x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
#else
  return ali3_three_sum(sum, (const ali3_three *)x, y);
#endif
}

/* y += a x of three numbers */
static inline void ali3_triple_add(real *restrict y, const real *restrict x, real a) {
  y[0] += a * x[0];
  y[1] += a * x[1];
  y[2] += a * x[2];
}
#endif
