/* The tiles of a road file in memory: the least recently used one is replaced. Heights do not depend on which tiles are
 * in memory. */
#include "road_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../files/crc32.h"
#include "../files/regular_file.h"
#include "road_header.h"
#include "road_table.h"
#include "shared_tile.h"

enum { GRID = 2 }; /* elements/road.h */
enum { POINTS = ALI3_ROAD_TILE * ALI3_ROAD_TILE, HINTS = 256, TEXT = 200 };
enum { CELLS = 16 }; /* stored along x and y: enough for the wheels of a car */
static const double TABLE_FRICTION = 0.9; /* of a table without frictions */
static const char NO_MEMORY[] = "there is not enough memory";

struct ali3_road_file {
  void (*release)(void *block);
  ali3_file *stream; /* NULL once all tiles are in memory */
  uint32_t version;
  ali3_road_header head;
  uint32_t identity;
  int64_t tiles_y, n_tiles, reads;
  size_t tile_bytes;
  int32_t n_slots, used_slots, last;
  int64_t number[ALI3_TILES_NEAR];
  uint64_t clock, when[ALI3_TILES_NEAR];
  unsigned char hint[HINTS];
  unsigned char *slot; /* n_slots x tile_bytes */
  unsigned char *record; /* of version 2: work for a record of the file */
  double *values; /* of a table: all values, in place of tiles */
  ali3_cell *cells; /* CELLS x CELLS cells of this file, never out of date */
  char lost[TEXT];
};

static int refuse(char *message, size_t size, const char *error) {
  if (message != NULL && size > 0) snprintf(message, size, "%s", error);
  return 0;
}

int32_t ali3_road_file_kind(const ali3_road_file *file) { return file->head.kind; }

const double *ali3_road_file_reals(const ali3_road_file *file) { return file->head.real; }

uint32_t ali3_road_file_identity(const ali3_road_file *file) { return file->identity; }

const char *ali3_road_file_lost(const ali3_road_file *file) { return file->lost[0] != 0 ? file->lost : NULL; }

void ali3_road_file_forgive(ali3_road_file *file) { file->lost[0] = 0; }

int64_t ali3_road_file_reads(const ali3_road_file *file) { return file->reads; }

void ali3_road_file_size(const ali3_road_file *file, int32_t *nx, int32_t *ny) {
  *nx = (int32_t)file->head.nx;
  *ny = (int32_t)file->head.ny;
}

/* NULL, or what is wrong with the values of a tile, including those beyond the grid. */
static const char *value_error(const ali3_road_file *file, const double *value) {
  for (int k = 0; k < POINTS; k++)
    if (!(fabs(value[k]) <= ALI3_ROAD_HIGHEST)) return "has a height that is not finite or beyond 1e5 m";
  for (int k = POINTS; k < file->head.maps * POINTS; k++)
    if (!(value[k] >= 0.0 && value[k] <= ALI3_ROAD_FRICTION)) return "has a friction outside 0 to 10";
  return NULL;
}

/* Reads a tile of version 1; NULL, or why it is invalid. */
static const char *read_own_tile(const ali3_road_file *file, int64_t number, unsigned char *to) {
  const int64_t from = ALI3_ROAD_HEADER + number * (int64_t)file->tile_bytes;
  const size_t checked = file->tile_bytes - sizeof(uint32_t);
  int64_t written;
  uint32_t crc;
  if (!ali3_file_read(file->stream, from, to, file->tile_bytes)) return "cannot be read";
  memcpy(&written, to + file->tile_bytes - ALI3_ROAD_TRAILER, sizeof written);
  memcpy(&crc, to + checked, sizeof crc);
  return written != number || crc != ali3_crc32(to, checked) ? "was altered or damaged" : NULL;
}

static int read_tile(ali3_road_file *file, int64_t number, unsigned char *to) {
  const ali3_tile_table table = {file->stream, file->head.size, file->n_tiles, ALI3_ROAD_HEADER, file->head.maps};
  const char *error = file->stream == NULL                ? "cannot be read"
                      : file->version == ALI3_ROAD_SHARED ? ali3_shared_tile(&table, number, file->record, (double *)to)
                                                          : read_own_tile(file, number, to);
  if (error == NULL) error = value_error(file, (const double *)to);
  file->reads++;
  if (error == NULL) return 1;
  const double *p = file->head.real;
  snprintf(file->lost, sizeof file->lost, "its part from x = %.6g m, y = %.6g m on %s",
           p[0] + (double)(number / file->tiles_y) * ALI3_ROAD_TILE * p[2],
           p[1] + (double)(number % file->tiles_y) * ALI3_ROAD_TILE * p[3], error);
  return 0;
}

/* A slot for a tile: a free one, or the least recently used one. */
static int32_t free_slot(ali3_road_file *file) {
  if (file->used_slots < file->n_slots) return file->used_slots++;
  int32_t oldest = 0;
  for (int32_t k = 1; k < file->n_slots; k++)
    if (file->when[k] < file->when[oldest]) oldest = k;
  return oldest;
}

static int32_t slot_of(const ali3_road_file *file, int64_t number) {
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
    int32_t k = slot_of(file, number);
    if (k < 0) {
      k = free_slot(file);
      file->number[k] = read_tile(file, number, file->slot + (size_t)k * file->tile_bytes) ? number : -1;
      file->when[k] = 0;
      if (file->number[k] < 0) return NULL;
    }
    file->hint[number % HINTS] = (unsigned char)k;
    file->last = k;
    file->when[k] = ++file->clock;
  }
  return (const double *)(file->slot + (size_t)file->last * file->tile_bytes);
}

double ali3_road_file_height(ali3_road_file *file, int32_t i, int32_t j) {
  if (file->values != NULL) return file->values[(int64_t)i * file->head.ny + j];
  const double *tile = tile_at(file, i, j);
  return tile != NULL ? tile[i % ALI3_ROAD_TILE * ALI3_ROAD_TILE + j % ALI3_ROAD_TILE] : 0.0;
}

const double *ali3_road_file_block(ali3_road_file *file, int32_t i, int32_t j, int32_t size[2], int32_t *stride) {
  *stride = file->values != NULL ? (int32_t)file->head.ny : ALI3_ROAD_TILE;
  if (file->values != NULL) return file->values + (int64_t)i * file->head.ny + j;
  const int32_t offset[2] = {i % ALI3_ROAD_TILE, j % ALI3_ROAD_TILE};
  for (int k = 0; k < 2; k++)
    if (size[k] > ALI3_ROAD_TILE - offset[k]) size[k] = ALI3_ROAD_TILE - offset[k];
  const double *tile = tile_at(file, i, j);
  return tile != NULL ? tile + offset[0] * ALI3_ROAD_TILE + offset[1] : NULL;
}

double ali3_road_file_friction(ali3_road_file *file, int32_t i, int32_t j) {
  if (file->head.maps < 2) return file->head.real[4];
  if (file->values != NULL) return file->values[(file->head.nx + i) * file->head.ny + j];
  const double *tile = tile_at(file, i, j);
  return tile != NULL ? tile[POINTS + i % ALI3_ROAD_TILE * ALI3_ROAD_TILE + j % ALI3_ROAD_TILE] : 0.0;
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
  for (int64_t k = 0; k < file->n_tiles; k++)
    memcpy(&crc[k], file->slot + (size_t)(k + 1) * file->tile_bytes - sizeof *crc, sizeof *crc);
  return ali3_crc32(crc, (size_t)file->n_tiles * sizeof *crc);
}

/* Marks all slots as empty; reads all tiles of a small grid and closes its stream. */
static int load_tiles(ali3_road_file *file, char *message, size_t size) {
  for (int k = 0; k < ALI3_TILES_NEAR; k++) file->number[k] = -1;
  for (int64_t number = 0; file->n_tiles <= ALI3_TILES_NEAR && number < file->n_tiles; number++) {
    unsigned char *to = file->slot + (size_t)number * file->tile_bytes;
    if (!read_tile(file, number, to)) return refuse(message, size, file->lost);
    file->number[number] = number;
    file->used_slots++;
  }
  if (file->used_slots < file->n_tiles) return 1;
  if (file->n_tiles > 0 && file->head.contents != checksum_of_tiles(file))
    return refuse(message, size, "parts of it belong to another file");
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

/* Whether all values of a table are valid; if not, writes a sentence. */
static int check_table(const ali3_road_table *t, char *message, size_t size) {
  const int64_t points = t->nx * t->ny;
  for (int64_t k = 0; k < t->maps * points; k++) {
    const double v = t->values[k];
    const int valid = k < points ? fabs(v) <= ALI3_ROAD_HIGHEST : v >= 0.0 && v <= ALI3_ROAD_FRICTION;
    if (valid) continue;
    if (message != NULL && size > 0)
      snprintf(message, size, "its %s at row %lld, column %lld of the points is %g", k < points ? "height" : "friction",
               (long long)(k % points / t->ny + 1), (long long)(k % t->ny + 1), v);
    return 0;
  }
  return 1;
}

/* Allocates a copy of `start` with cells and `size` bytes for tiles; NULL: no memory. */
static ali3_road_file *allocate_file(const ali3_road_file *start, size_t size,
                                     void *(*allocate)(size_t count, size_t size)) {
  const size_t before = (sizeof *start + 15u) / 16u * 16u, cells = CELLS * CELLS * sizeof(ali3_cell);
  ali3_road_file *file = allocate(1, before + cells + size);
  if (file == NULL) return NULL;
  *file = *start;
  file->cells = (ali3_cell *)((unsigned char *)file + before);
  file->slot = (unsigned char *)file->cells + cells;
  memset(file->cells, 0, cells);
  return file;
}

/* Reads the text of a table and closes its stream; NULL: it is refused. */
static char *read_text(ali3_road_file *start, int64_t size, void *(*allocate)(size_t count, size_t size), char *message,
                       size_t message_size) {
  const char *error = NULL;
  char *text = NULL;
  if (size > ALI3_MOST_TABLE)
    error = "it is longer than 64 MB; make a road file of it by: ali3 road INPUT OUTPUT.road";
  else if ((text = allocate(1, (size_t)size + 1)) == NULL)
    error = NO_MEMORY;
  else if (!ali3_file_read(start->stream, 0, text, (size_t)size))
    error = "it cannot be read";
  ali3_file_close(start->stream);
  start->stream = NULL;
  if (error == NULL) return text;
  if (text != NULL) start->release(text);
  refuse(message, message_size, error);
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
  start->head = (ali3_road_header){.kind = GRID,
                                   .nx = t.nx,
                                   .ny = t.ny,
                                   .tile = ALI3_ROAD_TILE,
                                   .maps = t.maps,
                                   .real = {t.first[0], t.first[1], t.spacing[0], t.spacing[1], TABLE_FRICTION}};
  const char *error = ali3_road_grid_problem(&start->head);
  ali3_road_file *file = NULL;
  if (error != NULL) {
    refuse(message, message_size, error);
  } else if (check_table(&t, message, message_size)) {
    file = allocate_file(start, 0, allocate);
    if (file == NULL) refuse(message, message_size, NO_MEMORY);
  }
  if (file == NULL) {
    start->release(t.values);
    return NULL;
  }
  file->values = t.values;
  return file;
}

static int is_text(const char *path) {
  static const char *const suffix[] = {".csv", ".txt"};
  const size_t n = strlen(path);
  for (int k = 0; k < 2; k++) {
    int same = n > 4;
    for (size_t i = 0; same && i < 4; i++) {
      const char c = path[n - 4 + i];
      same = (c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c) == suffix[k][i];
    }
    if (same) return 1;
  }
  return 0;
}

ali3_road_file *ali3_road_file_open(const char *path, void *(*allocate)(size_t count, size_t size),
                                    void (*release)(void *block), char *message, size_t message_size) {
  unsigned char bytes[ALI3_ROAD_HEADER] = {0};
  const char *error = NULL;
  int64_t size = 0;
  ali3_road_file start = {.release = release};
  start.stream = ali3_file_open(path, &size, &error);
  if (error == NULL && is_text(path)) return open_table(&start, size, allocate, message, message_size);
  if (error == NULL && !ali3_file_read(start.stream, 0, bytes, size < ALI3_ROAD_HEADER ? (size_t)size : sizeof bytes))
    error = "it cannot be read";
  if (error == NULL) error = ali3_road_header_problem(bytes, size, &start.head, &start.version, &start.identity);
  ali3_road_file *file = NULL;
  if (error == NULL) {
    start.tile_bytes = ali3_road_tile_bytes(&start.head);
    start.tiles_y = ali3_road_tiles_along(start.head.ny);
    start.n_tiles = ali3_road_tiles_along(start.head.nx) * start.tiles_y;
    start.n_slots = start.n_tiles < ALI3_TILES_NEAR ? (int32_t)start.n_tiles : ALI3_TILES_NEAR;
    const size_t tile_memory = (size_t)start.n_slots * start.tile_bytes;
    file = allocate_file(&start, tile_memory + (start.version == ALI3_ROAD_SHARED ? ALI3_MOST_RECORD : 0), allocate);
    if (file == NULL) error = NO_MEMORY;
    if (file != NULL) file->record = file->slot + tile_memory;
  }
  if (error != NULL) {
    if (start.stream != NULL) ali3_file_close(start.stream);
    refuse(message, message_size, error);
    return NULL;
  }
  if (load_tiles(file, message, message_size)) return file;
  ali3_road_file_close(file);
  return NULL;
}
