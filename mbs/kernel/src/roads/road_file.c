/* Road files: a cache of tiles, in which the least recently used one is replaced, and tables, which are read
 * completely. Heights do not depend on what is in the cache. */
#include "road_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../files/crc32.h"
#include "../files/regular_file.h"
#include "road_header.h"
#include "road_table.h"
#include "shared_tile.h"

enum { TILE_POINTS = ALI3_ROAD_TILE * ALI3_ROAD_TILE, HINTS = 256, MESSAGE_BYTES = 200 };
enum { CELLS = 16 }; /* cached cells along x and along y: enough for the wheels of a car */
static const double TABLE_FRICTION = 0.9; /* of a table without frictions */
static const char NO_MEMORY[] = "there is not enough memory";

struct ali3_road_file {
  void (*release)(void *block);
  ali3_file *stream; /* NULL once all tiles are in memory */
  uint32_t version;
  ali3_road_header head;
  uint32_t identity; /* CRC-32 of the content */
  int64_t tiles_y, n_tiles; /* tiles along y, in all */
  int64_t reads; /* tiles read so far */
  size_t tile_bytes;
  int32_t n_slots, used_slots, last; /* last: slot used last */
  int64_t number[ALI3_TILES_NEAR]; /* tile in each slot, -1: none */
  uint64_t accesses, accessed[ALI3_TILES_NEAR]; /* number of accesses, at the last access of each slot */
  unsigned char hint[HINTS]; /* slot of a tile by its number % HINTS; another tile may be there since */
  unsigned char *slot; /* n_slots x tile_bytes */
  unsigned char *record; /* of version 2: work for a record of the file */
  double *values; /* of a table: all values, instead of tiles */
  ali3_cell *cells; /* CELLS x CELLS cells of this file, never out of date */
  char read_error[MESSAGE_BYTES];
};

/* Writes a message; returns 0. */
static int write_message(char *message, size_t size, const char *error) {
  if (message != NULL && size > 0) snprintf(message, size, "%s", error);
  return 0;
}

int32_t ali3_road_file_kind(const ali3_road_file *file) { return file->head.kind; }

const double *ali3_road_file_reals(const ali3_road_file *file) { return file->head.real; }

uint32_t ali3_road_file_identity(const ali3_road_file *file) { return file->identity; }

const char *ali3_road_file_read_error(const ali3_road_file *file) {
  return file->read_error[0] != 0 ? file->read_error : NULL;
}

void ali3_road_file_clear_read_error(ali3_road_file *file) { file->read_error[0] = 0; }

int64_t ali3_road_file_reads(const ali3_road_file *file) { return file->reads; }

void ali3_road_file_size(const ali3_road_file *file, int32_t *nx, int32_t *ny) {
  *nx = (int32_t)file->head.nx;
  *ny = (int32_t)file->head.ny;
}

/* NULL, or what is wrong with the values of a tile, including those beyond the grid. */
static const char *value_error(const ali3_road_file *file, const double *value) {
  for (int k = 0; k < TILE_POINTS; k++)
    if (!(fabs(value[k]) <= ALI3_ROAD_HIGHEST)) return "has a height that is not finite or beyond 1e5 m";
  for (int k = TILE_POINTS; k < file->head.maps * TILE_POINTS; k++)
    if (!(value[k] >= 0.0 && value[k] <= ALI3_ROAD_FRICTION)) return "has a friction outside 0 to 10";
  return NULL;
}

/* Reads a tile of version 1; NULL, or why it is invalid. */
static const char *read_tile_version_1(const ali3_road_file *file, int64_t number, unsigned char *tile) {
  const int64_t offset = ALI3_ROAD_HEADER + number * (int64_t)file->tile_bytes;
  const size_t checked_bytes = file->tile_bytes - sizeof(uint32_t);
  int64_t stored_number;
  uint32_t crc;
  if (!ali3_file_read(file->stream, offset, tile, file->tile_bytes)) return "cannot be read";
  memcpy(&stored_number, tile + file->tile_bytes - ALI3_ROAD_TRAILER, sizeof stored_number);
  memcpy(&crc, tile + checked_bytes, sizeof crc);
  return stored_number != number || crc != ali3_crc32(tile, checked_bytes) ? "was altered or damaged" : NULL;
}

/* Reads a tile of either version; if it is invalid, writes read_error and returns 0. */
static int read_tile(ali3_road_file *file, int64_t number, unsigned char *tile) {
  const ali3_tile_table table = {file->stream, file->head.size, file->n_tiles, ALI3_ROAD_HEADER, file->head.maps};
  const char *error;
  if (file->stream == NULL)
    error = "cannot be read";
  else if (file->version == ALI3_ROAD_SHARED)
    error = ali3_shared_tile(&table, number, file->record, (double *)tile);
  else
    error = read_tile_version_1(file, number, tile);
  if (error == NULL) error = value_error(file, (const double *)tile);
  file->reads++; /* failed reads count, too */
  if (error == NULL) return 1;
  const double *p = file->head.real;
  snprintf(file->read_error, sizeof file->read_error, "its part beginning at x = %.6g m, y = %.6g m %s",
           p[0] + (double)(number / file->tiles_y) * ALI3_ROAD_TILE * p[2],
           p[1] + (double)(number % file->tiles_y) * ALI3_ROAD_TILE * p[3], error);
  return 0;
}

/* A slot for a tile: a free one, or the least recently used one. */
static int32_t claim_slot(ali3_road_file *file) {
  if (file->used_slots < file->n_slots) return file->used_slots++;
  int32_t oldest = 0;
  for (int32_t k = 1; k < file->n_slots; k++)
    if (file->accessed[k] < file->accessed[oldest]) oldest = k;
  return oldest;
}

/* Slot of a tile, or -1. */
static int32_t find_slot(const ali3_road_file *file, int64_t number) {
  const int32_t hint = file->hint[number % HINTS];
  if (hint < file->used_slots && file->number[hint] == number) return hint;
  for (int32_t k = 0; k < file->used_slots; k++)
    if (file->number[k] == number) return k;
  return -1;
}

/* Values of the tile with point (i, j), or NULL. */
static const double *tile_at(ali3_road_file *file, int32_t i, int32_t j) {
  const int64_t number = (int64_t)(i / ALI3_ROAD_TILE) * file->tiles_y + j / ALI3_ROAD_TILE;
  if (file->number[file->last] != number) {
    int32_t k = find_slot(file, number);
    if (k < 0) {
      k = claim_slot(file);
      file->number[k] = read_tile(file, number, file->slot + (size_t)k * file->tile_bytes) ? number : -1;
      file->accessed[k] = 0;
      if (file->number[k] < 0) return NULL;
    }
    file->hint[number % HINTS] = (unsigned char)k;
    file->last = k;
    file->accessed[k] = ++file->accesses;
  }
  return (const double *)(file->slot + (size_t)file->last * file->tile_bytes);
}

/* Index of point (i, j) among the points of its tile. */
static int32_t index_in_tile(int32_t i, int32_t j) { return i % ALI3_ROAD_TILE * ALI3_ROAD_TILE + j % ALI3_ROAD_TILE; }

double ali3_road_file_height(ali3_road_file *file, int32_t i, int32_t j) {
  if (file->values != NULL) return file->values[(int64_t)i * file->head.ny + j];
  const double *tile = tile_at(file, i, j);
  return tile != NULL ? tile[index_in_tile(i, j)] : 0.0;
}

const double *ali3_road_file_block(ali3_road_file *file, int32_t i, int32_t j, int32_t size[2], int32_t *stride) {
  *stride = file->values != NULL ? (int32_t)file->head.ny : ALI3_ROAD_TILE;
  if (file->values != NULL) return file->values + (int64_t)i * file->head.ny + j;
  const int32_t offset[2] = {i % ALI3_ROAD_TILE, j % ALI3_ROAD_TILE};
  for (int k = 0; k < 2; k++)
    if (size[k] > ALI3_ROAD_TILE - offset[k]) size[k] = ALI3_ROAD_TILE - offset[k];
  const double *tile = tile_at(file, i, j);
  return tile != NULL ? tile + index_in_tile(i, j) : NULL;
}

double ali3_road_file_friction(ali3_road_file *file, int32_t i, int32_t j) {
  if (file->head.maps < 2) return file->head.real[4];
  if (file->values != NULL) return file->values[(file->head.nx + i) * file->head.ny + j];
  const double *tile = tile_at(file, i, j);
  return tile != NULL ? tile[TILE_POINTS + index_in_tile(i, j)] : 0.0;
}

ali3_cell *ali3_road_file_cell(const ali3_road_file *file, int32_t i, int32_t j) {
  return &file->cells[(uint32_t)i % CELLS * CELLS + (uint32_t)j % CELLS];
}

/* CRC-32 of the checksums of all tiles in memory, or of the table of shared tiles; 0: it cannot be read. */
static uint32_t checksum_of_tiles(ali3_road_file *file) {
  uint32_t crc[ALI3_TILES_NEAR];
  const size_t table = (size_t)file->n_tiles * ALI3_TILE_ENTRY;
  if (file->version == ALI3_ROAD_SHARED)
    return ali3_file_read(file->stream, ALI3_ROAD_HEADER, file->record, table) ? ali3_crc32(file->record, table) : 0;
  for (int64_t k = 0; k < file->n_tiles; k++) /* the CRC-32 is the last of a tile */
    memcpy(&crc[k], file->slot + (size_t)(k + 1) * file->tile_bytes - sizeof *crc, sizeof *crc);
  return ali3_crc32(crc, (size_t)file->n_tiles * sizeof *crc);
}

/* Marks all slots as empty; reads all tiles of a small grid and closes its stream. */
static int load_tiles(ali3_road_file *file, char *message, size_t size) {
  for (int k = 0; k < ALI3_TILES_NEAR; k++) file->number[k] = -1;
  if (file->n_tiles > ALI3_TILES_NEAR) return 1;
  for (int64_t number = 0; number < file->n_tiles; number++) {
    if (!read_tile(file, number, file->slot + (size_t)number * file->tile_bytes))
      return write_message(message, size, file->read_error);
    file->number[number] = number;
    file->used_slots++;
  }
  if (file->n_tiles > 0 && file->head.contents != checksum_of_tiles(file))
    return write_message(message, size, "parts of it belong to another file");
  ali3_file_close(file->stream);
  file->stream = NULL;
  return 1;
}

void ali3_road_file_close(ali3_road_file *file) {
  if (file == NULL) return;
  if (file->stream != NULL) ali3_file_close(file->stream);
  if (file->values != NULL) file->release(file->values);
  file->release(file);
}

/* Allocates a copy of `start` with cells and `size` bytes for tiles; NULL: no memory. */
static ali3_road_file *allocate_file(const ali3_road_file *start, size_t size,
                                     void *(*allocate)(size_t count, size_t size)) {
  const size_t offset = (sizeof *start + 15u) / 16u * 16u; /* of the cells, aligned to 16 bytes */
  const size_t cells = CELLS * CELLS * sizeof(ali3_cell);
  ali3_road_file *file = allocate(1, offset + cells + size);
  if (file == NULL) return NULL;
  *file = *start;
  file->cells = (ali3_cell *)((unsigned char *)file + offset);
  file->slot = (unsigned char *)file->cells + cells;
  memset(file->cells, 0, cells);
  return file;
}

/* Reads the text of a table and closes its stream; NULL: it is refused. */
static char *read_text(ali3_road_file *start, int64_t size, void *(*allocate)(size_t count, size_t size), char *message,
                       size_t message_size) {
  const char *error = NULL;
  char *text = NULL;
  if (size > ALI3_MAX_TABLE)
    error = "it is longer than 64 MB; make a road file of it by: ali3 road INPUT OUTPUT.road";
  else if ((text = allocate(1, (size_t)size + 1)) == NULL)
    error = NO_MEMORY;
  else if (!ali3_file_read(start->stream, 0, text, (size_t)size))
    error = "it cannot be read";
  ali3_file_close(start->stream);
  start->stream = NULL;
  if (error == NULL) return text;
  if (text != NULL) start->release(text);
  write_message(message, message_size, error);
  return NULL;
}

/* Opens a table, which is read completely, and closes its stream. */
static ali3_road_file *open_table(ali3_road_file *start, int64_t size, void *(*allocate)(size_t count, size_t size),
                                  char *message, size_t message_size) {
  ali3_road_table t = {0};
  char *text = read_text(start, size, allocate, message, message_size);
  if (text == NULL) return NULL;
  start->identity = ali3_crc32(text, (size_t)size);
  const int valid = ali3_road_table_read(text, (size_t)size, &t, allocate, start->release, message, message_size);
  start->release(text);
  if (!valid) return NULL;
  start->head = (ali3_road_header){.kind = ALI3_FILE_GRID,
                                   .nx = t.nx,
                                   .ny = t.ny,
                                   .tile = ALI3_ROAD_TILE,
                                   .maps = t.maps,
                                   .real = {t.first[0], t.first[1], t.spacing[0], t.spacing[1], TABLE_FRICTION}};
  const char *error = ali3_road_grid_problem(&start->head);
  ali3_road_file *file = error == NULL ? allocate_file(start, 0, allocate) : NULL;
  if (file == NULL) {
    write_message(message, message_size, error != NULL ? error : NO_MEMORY);
    start->release(t.values);
    return NULL;
  }
  file->values = t.values;
  return file;
}

/* Whether a path ends in one of four characters, in small or capital letters. */
static int ends_with(const char *path, const char *suffix) {
  const size_t n = strlen(path);
  if (n <= 4) return 0;
  for (size_t i = 0; i < 4; i++) {
    const char c = path[n - 4 + i];
    if ((c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c) != suffix[i]) return 0;
  }
  return 1;
}

/* Reads and checks the header of a road file and allocates *file, without its tiles. NULL, or what is wrong. */
static const char *read_header(ali3_road_file *start, int64_t size, void *(*allocate)(size_t count, size_t size),
                               ali3_road_file **file) {
  unsigned char bytes[ALI3_ROAD_HEADER] = {0};
  if (!ali3_file_read(start->stream, 0, bytes, size < ALI3_ROAD_HEADER ? (size_t)size : sizeof bytes))
    return "it cannot be read";
  const char *error = ali3_road_header_problem(bytes, size, &start->head, &start->version, &start->identity);
  if (error != NULL) return error;
  start->tile_bytes = ali3_road_tile_bytes(&start->head);
  start->tiles_y = ali3_road_tiles_along(start->head.ny);
  start->n_tiles = ali3_road_tiles_along(start->head.nx) * start->tiles_y;
  start->n_slots = start->n_tiles < ALI3_TILES_NEAR ? (int32_t)start->n_tiles : ALI3_TILES_NEAR;
  const size_t tile_memory = (size_t)start->n_slots * start->tile_bytes;
  *file = allocate_file(start, tile_memory + (start->version == ALI3_ROAD_SHARED ? ALI3_MAX_RECORD : 0), allocate);
  if (*file == NULL) return NO_MEMORY;
  (*file)->record = (*file)->slot + tile_memory;
  return NULL;
}

ali3_road_file *ali3_road_file_open(const char *path, void *(*allocate)(size_t count, size_t size),
                                    void (*release)(void *block), char *message, size_t message_size) {
  const char *error = NULL;
  int64_t size = 0;
  ali3_road_file start = {.release = release}, *file = NULL;
  start.stream = ali3_file_open(path, &size, &error);
  if (error == NULL && (ends_with(path, ".csv") || ends_with(path, ".txt")))
    return open_table(&start, size, allocate, message, message_size);
  if (error == NULL) error = read_header(&start, size, allocate, &file);
  if (error != NULL) {
    if (start.stream != NULL) ali3_file_close(start.stream);
    write_message(message, message_size, error);
    return NULL;
  }
  if (load_tiles(file, message, message_size)) return file;
  ali3_road_file_close(file);
  return NULL;
}
