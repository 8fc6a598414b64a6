/* Arrays in one block of memory. The placing function is called twice, first with a NULL block to count, so that the
 * allocated and the placed memory are equal. */
#ifndef ALI3_POOL_H
#define ALI3_POOL_H
#include <stddef.h>

typedef struct {
  char *block; /* NULL: arrays are counted only */
  size_t used; /* bytes placed or counted so far */
} ali3_pool;

/* The address sanitizer sees one block; builds for it (tests/sanitize.py) have poisoned gaps between arrays. */
#if defined(ALI3_GAPS)
#include <sanitizer/asan_interface.h>
enum { ALI3_GAP = 64 }; /* bytes */
/* Leaves a gap after an array. */
static inline void ali3_pool_gap(ali3_pool *pool) {
  if (pool->block != NULL) ASAN_POISON_MEMORY_REGION(pool->block + pool->used, ALI3_GAP);
  pool->used += ALI3_GAP;
}
#else
/* Leaves a gap after an array. */
static inline void ali3_pool_gap(ali3_pool *pool) { (void)pool; }
#endif

/* Contiguous numbers, so that several arrays can be copied as one. */
static inline double *ali3_pool_numbers(ali3_pool *pool, size_t count) {
  double *piece = pool->block != NULL ? (double *)(pool->block + pool->used) : NULL;
  pool->used += count * sizeof(double);
  return piece;
}

/* Numbers that are not copied with others. */
static inline double *ali3_pool_array(ali3_pool *pool, size_t count) {
  double *piece = ali3_pool_numbers(pool, count);
  ali3_pool_gap(pool);
  return piece;
}

/* Numbers followed by one unused number, as three are read and written as four (`ali3_three`). */
static inline double *ali3_pool_padded(ali3_pool *pool, size_t count) { return ali3_pool_array(pool, count + 1); }

/* Items of any type, aligned to 16 bytes. */
static inline void *ali3_pool_items(ali3_pool *pool, size_t count, size_t item) {
  pool->used = (pool->used + 15u) / 16u * 16u;
  void *piece = pool->block != NULL ? pool->block + pool->used : NULL;
  pool->used += (count * item + 15u) / 16u * 16u;
  ali3_pool_gap(pool);
  return piece;
}
#endif
