/* Tiles of a road file of version 2: a table has the position of the record of each tile, so that equal tiles are
 * stored once and smooth ones as polynomials.
 *
 * Little endian. After the header one entry of 24 bytes for each tile, in the order of version 1:
 *   8 bytes   position of its record in the file
 *   4         bytes of the record
 *   4         CRC-32 of the record
 *   4         zeros
 *   4         CRC-32 of the number of the tile as 8 bytes and of the 20 bytes before
 * A record:
 *   4 each    rows, columns, levels, zeros
 *   heights   rows x columns reals: 32 x 32 heights, y fastest, or up to 8 x 8 coefficients c[a][b] of the height
 *             sum c[a][b] u^a v^b at u = (i - 15.5) / 16, v = (j - 15.5) / 16; i and j count points in x and y
 *   frictions 0 levels: none; 1: a real for all points; 2 to 255: these reals, then for each point,
 *             y fastest, the index of its level, 1024 bytes; 1024: the reals of all points */
#ifndef ALI3_SHARED_TILE_H
#define ALI3_SHARED_TILE_H
#include <stdint.h>

#include "../files/regular_file.h"

enum { ALI3_TILE_ENTRY = 24, ALI3_MAX_RECORD = 16 + 2 * 32 * 32 * 8 };

typedef struct { /* of a file */
  ali3_file *stream;
  int64_t size, tiles, table; /* bytes of the file, number of tiles, position of the table */
  int32_t maps; /* 1: heights, 2: heights and frictions */
} ali3_tile_table;

/* Writes the values of a tile, heights and then frictions; NULL, or the end of a sentence on an error. `record`: work
 * of ALI3_MAX_RECORD bytes. */
const char *ali3_shared_tile(const ali3_tile_table *table, int64_t number, unsigned char *record, double *values);
#endif
