/* A number of one instance, or of several that advance together: sources written in `real` are compiled for one
 * instance and for each width of lanes (../lanes/), where a real is a vector of one number per instance and a
 * lane_mask its mask; laws also for elements of one instance (../elements/element_batches.c). Selections copy bits and
 * no sum combines lanes, so that each lane has the bits of a single instance. */
#ifndef ALI3_REAL_H
#define ALI3_REAL_H
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

/* In the rest of a file, the compiler evaluates a branch of one instance only if it is taken, as hosts may trap
 * division by zero. Lanes evaluate all branches; WebAssembly has no traps. */
#if defined(__clang__) && !defined(ALI3_WIDTH) && (defined(__x86_64__) || defined(__aarch64__))
#define ALI3_BRANCHES_AS_WRITTEN _Pragma("clang fp exceptions(maytrap)")
#else
#define ALI3_BRANCHES_AS_WRITTEN
#endif

/* Before the declaration of a function that is compiled for one instance and for each width; the latter are local. */
#ifdef ALI3_WIDTH
#define ALI3_PER_WIDTH static __attribute__((unused))
#else
#define ALI3_PER_WIDTH
#endif

#ifdef ALI3_WIDTH
typedef double real __attribute__((vector_size(8 * ALI3_WIDTH)));
typedef int64_t lane_mask __attribute__((vector_size(8 * ALI3_WIDTH)));

/* The same number in all lanes. */
static inline real ali3_same(double x) { return (real){0} + x; }
/* a where c holds, otherwise b. */
static inline real ali3_where(lane_mask c, real a, real b) { return (real)((c & (lane_mask)a) | (~c & (lane_mask)b)); }
/* x where c holds, otherwise x + y. */
static inline real ali3_add_unless(lane_mask c, real x, real y) { return ali3_where(c, x, x + y); }
static inline lane_mask ali3_not(lane_mask c) { return ~c; }
static inline real ali3_abs(real x) { return (real)((lane_mask)x & INT64_MAX); }

/* Whether c holds in a lane. */
static inline bool ali3_any(lane_mask c) {
  int64_t any = 0;
  for (int l = 0; l < ALI3_WIDTH; l++) any |= c[l];
  return any != 0;
}

/* Whether the sign bit is set, also of -0 and NaN. */
static inline lane_mask ali3_negative(real x) { return (lane_mask)x < 0; }

static inline real ali3_sqrt(real x) {
#if defined(__has_builtin) && __has_builtin(__builtin_elementwise_sqrt)
  return __builtin_elementwise_sqrt(x);
#else
  for (int l = 0; l < ALI3_WIDTH; l++) x[l] = sqrt(x[l]);
  return x;
#endif
}

static inline real ali3_floor(real x) {
#if defined(__has_builtin) && __has_builtin(__builtin_elementwise_floor)
  return __builtin_elementwise_floor(x);
#else
  for (int l = 0; l < ALI3_WIDTH; l++) x[l] = floor(x[l]);
  return x;
#endif
}

/* Lanes do not report the pieces of laws. */
#define ALI3_PIECE(piece, c, bits) ((void)(piece), (void)(c), (void)(bits))
/* Counters of the report belong to the lanes at work. */
#define ALI3_AT_WORK(in, lanes) (*(in)->at_work = (lanes))
#define ALI3_OF_LANES(lanes, a, b) ali3_where(lanes, a, b)
#define ALI3_AT_WORK_OF(in, lanes) (*(in)->at_work & (lanes))
#define ALI3_COUNT(in, counter) (*(in)->report.counter -= *(in)->at_work)
#define ALI3_COUNT_ANEW(in, counter) (*(in)->report.counter &= ~*(in)->at_work)
#else
typedef double real;
typedef bool lane_mask;

/* The same number in all lanes. */
static inline real ali3_same(double x) { return x; }
#define ali3_where(c, a, b) ((c) ? (a) : (b)) /* the other value is not evaluated: it may divide by zero */
/* x where c holds, otherwise x + y. */
static inline real ali3_add_unless(lane_mask c, real x, real y) { return c ? x : x + y; }
static inline lane_mask ali3_not(lane_mask c) { return !c; }
static inline real ali3_abs(real x) { return fabs(x); }
/* Whether c holds in a lane. */
static inline bool ali3_any(lane_mask c) { return c; }
/* Whether the sign bit is set, also of -0 and NaN. */
static inline lane_mask ali3_negative(real x) { return signbit(x); }
static inline real ali3_sqrt(real x) { return sqrt(x); }
static inline real ali3_floor(real x) { return floor(x); }

/* Adds bits that identify the smooth piece of a law, if c. */
#define ALI3_PIECE(piece, c, bits) (*(piece) |= (c) ? (uint32_t)(bits) : 0u)
#define ALI3_AT_WORK(in, lanes) ((void)(in), (void)(lanes))
#define ALI3_OF_LANES(lanes, a, b) (a) /* one instance does not reach this with `lanes` false */
#define ALI3_AT_WORK_OF(in, lanes) (lanes)
#define ALI3_COUNT(in, counter) ((in)->report.counter++)
#define ALI3_COUNT_ANEW(in, counter) ((in)->report.counter = 0)
#endif
#endif
