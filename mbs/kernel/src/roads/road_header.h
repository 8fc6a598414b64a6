/* The header of a road file, whose bytes road_file.h describes. */
#ifndef ALI3_ROAD_HEADER_H
#define ALI3_ROAD_HEADER_H
#include <stddef.h>
#include <stdint.h>

#include "road_file.h"

enum { ALI3_FILE_PLANE, ALI3_FILE_KERB, ALI3_FILE_GRID }; /* kinds, numbers as in elements/road.h */
enum { ALI3_ROAD_TRAILER = 16 }; /* bytes of a tile of version 1 after its values */

typedef struct { /* bytes 16 to 127 of a file, as they stand there */
  int64_t size; /* bytes of the file */
  int32_t kind; /* ALI3_FILE_* */
  uint32_t contents; /* checksum of the checksums of all tiles; of a shared file that of their table */
  int64_t nx, ny; /* points in x and y; 0: no grid */
  int32_t tile, maps; /* points along a side of a tile; 1: heights, 2: heights and frictions */
  double real[ALI3_ROAD_REALS], zero; /* m, earth axes: see road_file.h; 0 */
} ali3_road_header;

/* NULL, or what is wrong with the first ALI3_ROAD_HEADER bytes of a file of that size, bytes, in words that follow the
 * name of the file. Writes its header, version and checksum. */
const char *ali3_road_header_problem(const unsigned char *bytes, int64_t size, ali3_road_header *h, uint32_t *version,
                                     uint32_t *crc);
/* The same of the numbers of a grid alone. */
const char *ali3_road_grid_problem(const ali3_road_header *h);
/* Number of tiles along a number of points. */
int64_t ali3_road_tiles_along(int64_t points);
size_t ali3_road_tile_bytes(const ali3_road_header *h); /* size of a tile in memory, bytes */
#endif
