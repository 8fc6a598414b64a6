/* The header of a road file, whose bytes road_file.h describes. */
#ifndef ALI3_ROAD_HEADER_H
#define ALI3_ROAD_HEADER_H
#include <stddef.h>
#include <stdint.h>

#include "road_file.h"

enum { ALI3_FILE_PLANE, ALI3_FILE_KERB, ALI3_FILE_GRID }; /* kinds, numbers as in elements/road.h */
enum { ALI3_ROAD_TRAILER = 16 }; /* bytes of a tile of version 1 after its values */

typedef struct { /* byte 16 and after */
  int64_t size;
  int32_t kind;
  uint32_t contents;
  int64_t nx, ny;
  int32_t tile, maps;
  double real[ALI3_ROAD_REALS], zero;
} ali3_road_header;

/* NULL, or what is wrong with the first ALI3_ROAD_HEADER bytes of a file of that size. */
const char *ali3_road_header_problem(const unsigned char *bytes, int64_t size, ali3_road_header *h, uint32_t *version,
                                     uint32_t *crc);
const char *ali3_road_grid_problem(const ali3_road_header *h); /* NULL, or what is wrong with the numbers of a grid */
/* Number of tiles along a number of points. */
int64_t ali3_road_tiles_along(int64_t points);
size_t ali3_road_tile_bytes(const ali3_road_header *h); /* size of a tile in memory, bytes */
#endif
