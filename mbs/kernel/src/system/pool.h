/* Pieces of one block of memory. The function that hands them out is walked twice: with a NULL block it only counts, so
 * that what is asked for and what is placed cannot differ. */
#ifndef ALI3_POOL_H
#define ALI3_POOL_H
#include <stddef.h>

typedef struct {
  char *block;
  size_t used; /* bytes */
} ali3_pool;

/* Numbers lie side by side, so that several pieces can be copied as one. */
static inline double *ali3_pool_numbers(ali3_pool *pool, size_t count) {
  double *piece = pool->block != NULL ? (double *)(pool->block + pool->used) : NULL;
  pool->used += count * sizeof(double);
  return piece;
}

/* Items of any kind, from a multiple of 16 bytes to one. */
static inline void *ali3_pool_items(ali3_pool *pool, size_t count, size_t item) {
  pool->used = (pool->used + 15u) / 16u * 16u;
  void *piece = pool->block != NULL ? pool->block + pool->used : NULL;
  pool->used += (count * item + 15u) / 16u * 16u;
  return piece;
}
#endif
