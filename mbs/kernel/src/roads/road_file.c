/* Header of a road's file and the tiles in memory: the one that was not used for the longest time makes room. What they
 * hold is the file's, so a road does not depend on which of them are there. */
#include "road_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../files/crc32.h"
#include "../files/regular_file.h"
#include "road_table.h"

enum { PLANE, KERB, GRID }; /* elements/road.h */
enum { POINTS = ALI3_ROAD_TILE * ALI3_ROAD_TILE, HINTS = 256, TEXT = 200, TRAILER = 16, MOST_SIDE = 1 << 30 };
static const double TABLE_FRICTION = 0.9; /* of a text without frictions */

typedef struct { /* from byte 16 on */
  int64_t size;
  int32_t kind;
  uint32_t contents;
  int64_t nx, ny;
  int32_t tile, maps;
  double real[ALI3_ROAD_REALS], zero;
} header;

struct ali3_road_file {
  void (*release)(void *block);
  ali3_file *stream; /* NULL once all tiles are in memory */
  header head;
  uint32_t identity;
  int64_t tiles_y, n_tiles, reads;
  size_t tile_bytes;
  int32_t n_slots, used_slots, last;
  int64_t number[ALI3_TILES_NEAR];
  uint64_t clock, when[ALI3_TILES_NEAR];
  unsigned char hint[HINTS];
  unsigned char *slot; /* n_slots x tile_bytes */
  double *values; /* of a text: all of its grid, in place of tiles */
  char lost[TEXT];
};

static int refuse(char *message, size_t size, const char *why) {
  if (message != NULL && size > 0) snprintf(message, size, "%s", why);
  return 0;
}

static const char *plane_and_kerb_problem(const header *h) {
  const double *p = h->real, friction = p[h->kind == PLANE ? 3 : 4];
  if (h->nx != 0 || h->ny != 0 || h->maps != 0 || h->contents != 0) return "a plane or kerb has no grid";
  for (int i = 0; i < ALI3_ROAD_REALS; i++)
    if (!(fabs(p[i]) <= ALI3_ROAD_FARTHEST)) return "a number in its header is not finite or beyond 1e8";
  if (!(friction >= 0.0 && friction <= ALI3_ROAD_FRICTION)) return "its friction lies outside 0 to 10";
  if (h->kind == PLANE && !(fabs(p[1]) <= 10.0 && fabs(p[2]) <= 10.0)) return "a grade of it lies outside -10 to 10";
  if (h->kind == KERB && !(p[2] > 0.0)) return "the step of its kerb is not positive";
  if (h->kind == KERB && p[3] != 1.0 && p[3] != -1.0) return "the side of its kerb is neither 1 nor -1";
  return NULL;
}

static const char *grid_problem(const header *h) {
  const double *p = h->real;
  if (h->tile != ALI3_ROAD_TILE || (h->maps != 1 && h->maps != 2)) return "its tiles have another form";
  if (h->nx < 2 || h->ny < 2 || h->nx > MOST_SIDE || h->ny > MOST_SIDE ||
      (double)h->nx * (double)h->ny > ALI3_ROAD_POINTS)
    return "its grid has fewer than 2 x 2 or more than 1e12 points";
  if (!(p[2] > 0.0 && p[3] > 0.0)) return "the spacing of its grid is not positive";
  if (!(fabs(p[0]) <= ALI3_ROAD_FARTHEST && fabs(p[1]) <= ALI3_ROAD_FARTHEST &&
        (double)h->nx * p[2] <= ALI3_ROAD_FARTHEST && (double)h->ny * p[3] <= ALI3_ROAD_FARTHEST))
    return "its grid reaches farther than 1e8 m";
  if (!(p[4] >= 0.0 && p[4] <= ALI3_ROAD_FRICTION)) return "its friction lies outside 0 to 10";
  return NULL;
}

static int64_t tiles_along(int64_t n) { return (n + ALI3_ROAD_TILE - 1) / ALI3_ROAD_TILE; }

static size_t bytes_of_tile(const header *h) { return (size_t)h->maps * POINTS * sizeof(double) + TRAILER; }

/* NULL, or what is wrong with the first bytes of a file of that size. */
static const char *header_problem(const unsigned char *bytes, int64_t size, header *h, uint32_t *crc) {
  static const unsigned char one[4] = {1, 0, 0, 0};
  uint32_t version, machine;
  memcpy(&machine, one, sizeof machine);
  memcpy(&version, bytes + 8, sizeof version);
  memcpy(crc, bytes + 12, sizeof *crc);
  memcpy(h, bytes + 16, sizeof *h);
  if (machine != 1) return "this machine is not little endian";
  if (memcmp(bytes, "ALI3ROAD", 8) != 0)
    return "it is no road file; make one of a CSV table, NumPy arrays, pictures or a TOML file by: ali3 road INPUT "
           "OUTPUT.road";
  if (size < ALI3_ROAD_HEADER) return "it ends too early: it was cut off";
  if (version != ALI3_ROAD_VERSION) return "it has another version than 1; write it again with ali3 road";
  if (*crc != ali3_crc32(bytes + 16, ALI3_ROAD_HEADER - 16)) return "its header was altered or damaged";
  if (h->kind < PLANE || h->kind > GRID) return "it has an unknown kind of road";
  const char *why = h->kind == GRID ? grid_problem(h) : plane_and_kerb_problem(h);
  if (why != NULL) return why;
  const int64_t tiles = h->kind == GRID ? tiles_along(h->nx) * tiles_along(h->ny) : 0;
  const int64_t whole = ALI3_ROAD_HEADER + tiles * (int64_t)bytes_of_tile(h);
  if (h->size != whole) return "its header contradicts itself";
  return size == whole  ? NULL
         : size < whole ? "it ends too early: it was cut off"
                        : "it is longer than its header says";
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

/* NULL, or what is wrong with a tile that was read; points beyond the grid count too, they are zeros. */
static const char *tile_problem(const ali3_road_file *file, const unsigned char *bytes, int64_t number) {
  const size_t checked = file->tile_bytes - sizeof(uint32_t);
  const double *value = (const double *)bytes;
  int64_t written;
  uint32_t crc;
  memcpy(&written, bytes + file->tile_bytes - TRAILER, sizeof written);
  memcpy(&crc, bytes + checked, sizeof crc);
  if (written != number || crc != ali3_crc32(bytes, checked)) return "was altered or damaged";
  for (int k = 0; k < POINTS; k++)
    if (!(fabs(value[k]) <= ALI3_ROAD_HIGHEST)) return "has a height that is not finite or beyond 1e5 m";
  for (int k = POINTS; k < file->head.maps * POINTS; k++)
    if (!(value[k] >= 0.0 && value[k] <= ALI3_ROAD_FRICTION)) return "has a friction outside 0 to 10";
  return NULL;
}

static int read_tile(ali3_road_file *file, int64_t number, unsigned char *to) {
  const int64_t from = ALI3_ROAD_HEADER + number * (int64_t)file->tile_bytes;
  const char *why = "cannot be read";
  if (file->stream != NULL && ali3_file_read(file->stream, from, to, file->tile_bytes))
    why = tile_problem(file, to, number);
  file->reads++;
  if (why == NULL) return 1;
  const double *p = file->head.real;
  snprintf(file->lost, sizeof file->lost, "its part from x = %.6g m, y = %.6g m on %s",
           p[0] + (double)(number / file->tiles_y) * ALI3_ROAD_TILE * p[2],
           p[1] + (double)(number % file->tiles_y) * ALI3_ROAD_TILE * p[3], why);
  return 0;
}

/* A slot for a tile: a free one, or that which was not used for the longest time. */
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

double ali3_road_file_friction(ali3_road_file *file, int32_t i, int32_t j) {
  if (file->head.maps < 2) return file->head.real[4];
  if (file->values != NULL) return file->values[(file->head.nx + i) * file->head.ny + j];
  const double *tile = tile_at(file, i, j);
  return tile != NULL ? tile[POINTS + i % ALI3_ROAD_TILE * ALI3_ROAD_TILE + j % ALI3_ROAD_TILE] : 0.0;
}

/* Memory for what is near; all of a small grid, whose stream is then closed. */
static int place_tiles(ali3_road_file *file, char *message, size_t size) {
  uint32_t crc[ALI3_TILES_NEAR];
  for (int k = 0; k < ALI3_TILES_NEAR; k++) file->number[k] = -1;
  for (int64_t number = 0; file->n_tiles <= ALI3_TILES_NEAR && number < file->n_tiles; number++) {
    unsigned char *to = file->slot + (size_t)number * file->tile_bytes;
    if (!read_tile(file, number, to)) return refuse(message, size, file->lost);
    memcpy(&crc[number], to + file->tile_bytes - sizeof *crc, sizeof *crc);
    file->number[number] = number;
    file->used_slots++;
  }
  if (file->used_slots < file->n_tiles) return 1;
  if (file->n_tiles > 0 && file->head.contents != ali3_crc32(crc, (size_t)file->n_tiles * sizeof *crc))
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

/* Values of a text that no road has; 0 and a sentence. */
static int table_values(const ali3_road_table *t, char *message, size_t size) {
  const int64_t points = t->nx * t->ny;
  for (int64_t k = 0; k < t->maps * points; k++) {
    const double v = t->values[k];
    const int good = k < points ? fabs(v) <= ALI3_ROAD_HIGHEST : v >= 0.0 && v <= ALI3_ROAD_FRICTION;
    if (good) continue;
    if (message != NULL && size > 0)
      snprintf(message, size, "its %s at row %lld, column %lld of the points is %g", k < points ? "height" : "friction",
               (long long)(k % points / t->ny + 1), (long long)(k % t->ny + 1), v);
    return 0;
  }
  return 1;
}

/* All of a text is read and its stream closed. */
static ali3_road_file *open_table(ali3_road_file *start, int64_t size, void *(*allocate)(size_t count, size_t size),
                                  char *message, size_t message_size) {
  ali3_road_table t = {0};
  header *h = &start->head;
  char *text = size <= ALI3_MOST_TABLE ? allocate(1, (size_t)size + 1) : NULL;
  int good = text != NULL ? ali3_file_read(start->stream, 0, text, (size_t)size)
                          : refuse(message, message_size,
                                   "it is longer than 64 MB; make a road file of it by: ali3 "
                                   "road INPUT OUTPUT.road");
  ali3_file_close(start->stream);
  start->stream = NULL;
  if (good) {
    start->identity = ali3_crc32(text, (size_t)size);
    good = ali3_road_table_read(text, (size_t)size, &t, allocate, start->release, message, message_size);
  } else if (text != NULL) {
    refuse(message, message_size, "it cannot be read");
  }
  if (text != NULL) start->release(text);
  if (!good) return NULL;
  const header given = {.kind = GRID,
                        .nx = t.nx,
                        .ny = t.ny,
                        .tile = ALI3_ROAD_TILE,
                        .maps = t.maps,
                        .real = {t.first[0], t.first[1], t.spacing[0], t.spacing[1], TABLE_FRICTION}};
  *h = given;
  const char *why = grid_problem(h);
  ali3_road_file *file = NULL;
  if (why != NULL)
    refuse(message, message_size, why);
  else if (table_values(&t, message, message_size))
    file = allocate(1, sizeof *file);
  if (file == NULL) {
    start->release(t.values);
    return NULL;
  }
  *file = *start;
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
  const char *why = NULL;
  int64_t size = 0;
  ali3_road_file start = {.release = release};
  start.stream = ali3_file_open(path, &size, &why);
  if (why == NULL && is_text(path)) return open_table(&start, size, allocate, message, message_size);
  if (why == NULL && !ali3_file_read(start.stream, 0, bytes, size < ALI3_ROAD_HEADER ? (size_t)size : sizeof bytes))
    why = "it cannot be read";
  if (why == NULL) why = header_problem(bytes, size, &start.head, &start.identity);
  ali3_road_file *file = NULL;
  if (why == NULL) {
    start.tile_bytes = bytes_of_tile(&start.head);
    start.tiles_y = tiles_along(start.head.ny);
    start.n_tiles = tiles_along(start.head.nx) * start.tiles_y;
    start.n_slots = start.n_tiles < ALI3_TILES_NEAR ? (int32_t)start.n_tiles : ALI3_TILES_NEAR;
    const size_t before = (sizeof start + 15u) / 16u * 16u;
    file = allocate(1, before + (size_t)start.n_slots * start.tile_bytes);
    if (file == NULL) why = "there is not enough memory";
    if (file != NULL) {
      *file = start;
      file->slot = (unsigned char *)file + before;
    }
  }
  if (why != NULL) {
    if (start.stream != NULL) ali3_file_close(start.stream);
    refuse(message, message_size, why);
    return NULL;
  }
  if (place_tiles(file, message, message_size)) return file;
  ali3_road_file_close(file);
  return NULL;
}
