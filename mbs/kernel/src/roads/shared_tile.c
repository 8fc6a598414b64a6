/* Reads shared tiles of a road file and checks them: the entry by its checksum, which includes the number of the tile,
 * the record by the checksum in its entry, the sizes in its head by its length. */
#include "shared_tile.h"

#include <string.h>

#include "../files/crc32.h"

enum { SIDE = 32, POINTS = SIDE * SIDE, MAX_COEFFICIENTS = 8, MAX_LEVELS = 255, HEAD = 16 };

typedef struct {
  int64_t offset;
  int32_t bytes;
  uint32_t record_crc;
  uint32_t reserved; /* 0 */
  uint32_t crc;
} entry;

typedef struct {
  int32_t rows, columns, levels, reserved /* 0 */;
} head;

static const char ALTERED[] = "was altered or damaged";

/* CRC-32 of the number of a tile and its entry in the table. */
static uint32_t entry_crc(const unsigned char *bytes, int64_t number) {
  unsigned char checked[sizeof number + ALI3_TILE_ENTRY - 4];
  memcpy(checked, &number, sizeof number);
  memcpy(checked + sizeof number, bytes, ALI3_TILE_ENTRY - 4);
  return ali3_crc32(checked, sizeof checked);
}

/* Coordinate of point i of a tile, -31/32 to 31/32. */
static double normalised_coordinate(int i) { return (i - 0.5 * (SIDE - 1)) / (SIDE / 2); }

/* c[0] + c[1] t + ..., n coefficients. */
static double evaluate_polynomial(const double *c, int n, double t) {
  double value = 0.0;
  for (int k = n - 1; k >= 0; k--) value = value * t + c[k];
  return value;
}

/* Writes SIDE x SIDE heights, stored or from a polynomial. */
static void read_heights(const head *h, const unsigned char *from, double *to) {
  double c[MAX_COEFFICIENTS * MAX_COEFFICIENTS];
  if (h->rows == SIDE) {
    memcpy(to, from, POINTS * sizeof *to);
    return;
  }
  memcpy(c, from, (size_t)h->rows * (size_t)h->columns * sizeof *c);
  for (int j = 0; j < SIDE; j++) { /* Horner's scheme, in this order on every platform */
    double row[MAX_COEFFICIENTS];
    for (int a = 0; a < h->rows; a++)
      row[a] = evaluate_polynomial(c + a * h->columns, h->columns, normalised_coordinate(j));
    for (int i = 0; i < SIDE; i++) to[i * SIDE + j] = evaluate_polynomial(row, h->rows, normalised_coordinate(i));
  }
}

/* Writes SIDE x SIDE frictions; NULL, or what is wrong. */
static const char *read_frictions(const head *h, const unsigned char *from, double *to) {
  double level_frictions[MAX_LEVELS];
  if (h->levels == POINTS) {
    memcpy(to, from, POINTS * sizeof *to);
    return NULL;
  }
  memcpy(level_frictions, from, (size_t)h->levels * sizeof *level_frictions);
  const unsigned char *level_index = from + (size_t)h->levels * sizeof *level_frictions;
  for (int k = 0; k < POINTS; k++) {
    if (h->levels > 1 && level_index[k] >= h->levels) return "refers to a friction that it does not have";
    to[k] = level_frictions[h->levels > 1 ? level_index[k] : 0];
  }
  return NULL;
}

/* Size of a record with this head, bytes; 0: the head is invalid. */
static int64_t record_size(const head *h, int32_t maps) {
  const int is_full = h->rows == SIDE && h->columns == SIDE;
  const int is_polynomial =
      h->rows >= 1 && h->rows <= MAX_COEFFICIENTS && h->columns >= 1 && h->columns <= MAX_COEFFICIENTS;
  const int levels_valid =
      maps < 2 ? h->levels == 0 : (h->levels >= 1 && h->levels <= MAX_LEVELS) || h->levels == POINTS;
  if (!(is_full || is_polynomial) || !levels_valid || h->reserved != 0) return 0;
  const int64_t reals = (int64_t)h->rows * h->columns + h->levels;
  return HEAD + reals * (int64_t)sizeof(double) + (h->levels > 1 && h->levels < POINTS ? POINTS : 0);
}

const char *ali3_shared_tile(const ali3_tile_table *table, int64_t number, unsigned char *record, double *values) {
  unsigned char bytes[ALI3_TILE_ENTRY];
  entry e;
  head h;
  if (!ali3_file_read(table->stream, table->table + number * ALI3_TILE_ENTRY, bytes, sizeof bytes))
    return "cannot be read";
  memcpy(&e, bytes, sizeof e);
  if (e.reserved != 0 || e.crc != entry_crc(bytes, number)) return ALTERED;
  const int64_t first = table->table + table->tiles * ALI3_TILE_ENTRY;
  if (e.bytes < HEAD || e.bytes > ALI3_MAX_RECORD || e.offset < first || e.offset > table->size - e.bytes)
    return "lies outside of the file";
  if (!ali3_file_read(table->stream, e.offset, record, (size_t)e.bytes)) return "cannot be read";
  if (e.record_crc != ali3_crc32(record, (size_t)e.bytes)) return ALTERED;
  memcpy(&h, record, sizeof h);
  if (record_size(&h, table->maps) != e.bytes) return "has another form than its size says";
  read_heights(&h, record + HEAD, values);
  if (table->maps < 2) return NULL;
  return read_frictions(&h, record + HEAD + (size_t)h.rows * (size_t)h.columns * sizeof *values, values + POINTS);
}
