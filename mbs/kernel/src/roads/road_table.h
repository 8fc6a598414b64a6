/* A road as text: a table of heights with its coordinates, optionally followed by one of frictions. */
#ifndef ALI3_ROAD_TABLE_H
#define ALI3_ROAD_TABLE_H
#include <stddef.h>
#include <stdint.h>

enum { ALI3_MAX_TABLE = 1 << 26 }; /* bytes of a text */

typedef struct {
  int64_t nx, ny; /* points in x and y */
  double first[2], spacing[2]; /* m, of x and y */
  double *values; /* nx * ny heights, y fastest; followed by as many frictions if maps is 2 */
  int32_t maps; /* 1: heights, 2: heights and frictions */
} ali3_road_table;

/* Reads a text of `size` bytes; 1, or 0 and a sentence without its full stop if it is refused. table->values is a block
 * of `allocate`, which the caller releases; NULL after a refusal. */
int ali3_road_table_read(const char *text, size_t size, ali3_road_table *table,
                         void *(*allocate)(size_t count, size_t size), void (*release)(void *block), char *message,
                         size_t message_size);
#endif
