/* A road in a file: header, then the grid in tiles, of which a fixed number is in memory.
 *
 * Little endian. Header, 128 bytes: magic "ALI3ROAD" (8), version (4), CRC-32 of the bytes after it up to byte 128 (4),
 * size of the file (8), kind as in elements/road.h (4), CRC-32 of the checksums of all tiles in their order, 0 without
 * a grid (4), nx (8), ny (8), points along the side of a tile (4), maps: 1 heights, 2 heights and frictions (4), eight
 * reals (64), zeros (8). Reals of a plane: height, grade in x, grade in y, friction; of a kerb: x of the edge, lower
 * height, step, side, friction; of a grid: x0, y0, dx, dy, friction if there is no map of it, otherwise 1.
 * Tile (I, J), whose first point is 32 I in x and 32 J in y, has number I * (tiles in y) + J; tiles are in the order of
 * their numbers: 32 x 32 heights, y fastest, as many frictions if there is a map of them, the number (8), zeros (4),
 * CRC-32 of all this (4). Points beyond the last row or column are zeros. In version 2 tiles are stored as in
 * shared_tile.h, and the checksum of the tiles is the one of their table. */
#ifndef ALI3_ROAD_FILE_H
#define ALI3_ROAD_FILE_H
#include <stddef.h>
#include <stdint.h>

#include "cell.h"

#define ALI3_ROAD_VERSION 1
#define ALI3_ROAD_SHARED 2
#define ALI3_ROAD_TILE 32
#define ALI3_ROAD_HIGHEST 1e5
#define ALI3_ROAD_FARTHEST 1e8
#define ALI3_ROAD_FRICTION 10.0
#define ALI3_ROAD_POINTS 1e12
enum { ALI3_ROAD_HEADER = 128, ALI3_ROAD_REALS = 8 };
enum { ALI3_TILES_NEAR = 64 }; /* in memory: 16 kB each, 8 kB without frictions */

typedef struct ali3_road_file ali3_road_file;

/* Opens and checks a file; one that ends in .csv or .txt is a table (road_table.h), which is read completely. NULL: it
 * is refused, with a sentence without its full stop in `message`. Small files are read completely and closed; nothing
 * is allocated later. */
ali3_road_file *ali3_road_file_open(const char *path, void *(*allocate)(size_t count, size_t size),
                                    void (*release)(void *block), char *message, size_t message_size);
/* Closes a file and releases its memory; NULL is allowed. */
void ali3_road_file_close(ali3_road_file *file);

/* Type of the road: plane 0, kerb 1, grid 2. */
int32_t ali3_road_file_kind(const ali3_road_file *file);
/* The eight reals of the header. */
const double *ali3_road_file_reals(const ali3_road_file *file);
/* Numbers of points in x and y of a grid. */
void ali3_road_file_size(const ali3_road_file *file, int32_t *nx, int32_t *ny);
uint32_t ali3_road_file_identity(const ali3_road_file *file); /* checksum of its content */

/* Height, m, of point (i, j) of the grid; 0 and a read error if its tile cannot be read. */
double ali3_road_file_height(ali3_road_file *file, int32_t i, int32_t j);
/* Heights of the points beginning with (i, j), rows apart by `stride`; `size`, rows and columns, is reduced to one
 * tile. NULL: read error. */
const double *ali3_road_file_block(ali3_road_file *file, int32_t i, int32_t j, int32_t size[2], int32_t *stride);
/* Friction of point (i, j), likewise; without a map of frictions the one of the header. */
double ali3_road_file_friction(ali3_road_file *file, int32_t i, int32_t j);
/* Storage for the cell with the indices i, j before its first corner, shared with all cells that are multiples of 16
 * apart. */
ali3_cell *ali3_road_file_cell(const ali3_road_file *file, int32_t i, int32_t j);

/* NULL, or why the last tile could not be read, a sentence without its full stop. */
const char *ali3_road_file_read_error(const ali3_road_file *file);
/* Forgets the read error. */
void ali3_road_file_clear_read_error(ali3_road_file *file);
int64_t ali3_road_file_reads(const ali3_road_file *file); /* tiles read so far */
#endif
