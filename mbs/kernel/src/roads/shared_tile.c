/* Shared tiles of a road file, read and checked before use: the entry by its checksum, which the number of the tile is
 * part of, the record by the one in its entry, its sizes by what they must add up to. */
#include "shared_tile.h"

#include <string.h>

#include "../files/crc32.h"

enum { SIDE = 32, POINTS = SIDE * SIDE, MOST_COEFFICIENTS = 8, MOST_LEVELS = 255, HEAD = 16 };

typedef struct {
  int64_t place;
  int32_t bytes;
  uint32_t record_crc;
  uint32_t zero;
  uint32_t crc;
} entry;

typedef struct {
  int32_t rows, columns, levels, zero;
} head;

static const char ALTERED[] = "was altered or damaged";

static uint32_t entry_crc(const unsigned char *bytes, int64_t number) {
  unsigned char checked[sizeof number + ALI3_TILE_ENTRY - 4];
  memcpy(checked, &number, sizeof number);
  memcpy(checked + sizeof number, bytes, ALI3_TILE_ENTRY - 4);
  return ali3_crc32(checked, sizeof checked);
}

static double place_in_tile(int i) { return (i - 0.5 * (SIDE - 1)) / (SIDE / 2); }

static double nested(const double *c, int n, double t) {
  double value = 0.0;
  for (int k = n - 1; k >= 0; k--) value = value * t + c[k];
  return value;
}

static void heights(const head *h, const unsigned char *from, double *to) {
  double c[MOST_COEFFICIENTS * MOST_COEFFICIENTS];
  if (h->rows == SIDE) {
    memcpy(to, from, POINTS * sizeof *to);
    return;
  }
  memcpy(c, from, (size_t)h->rows * (size_t)h->columns * sizeof *c);
  for (int j = 0; j < SIDE; j++) { /* nested products, in this order on every platform */
    double row[MOST_COEFFICIENTS];
    for (int a = 0; a < h->rows; a++) row[a] = nested(c + a * h->columns, h->columns, place_in_tile(j));
    for (int i = 0; i < SIDE; i++) to[i * SIDE + j] = nested(row, h->rows, place_in_tile(i));
  }
}

static const char *frictions(const head *h, const unsigned char *from, double *to) {
  double level[MOST_LEVELS];
  if (h->levels == POINTS) {
    memcpy(to, from, POINTS * sizeof *to);
    return NULL;
  }
  memcpy(level, from, (size_t)h->levels * sizeof *level);
  const unsigned char *which = from + (size_t)h->levels * sizeof *level;
  for (int k = 0; k < POINTS; k++) {
    if (h->levels > 1 && which[k] >= h->levels) return "names a friction that it does not have";
    to[k] = level[h->levels > 1 ? which[k] : 0];
  }
  return NULL;
}

/* Bytes of a record with this head; 0 where no record has it. */
static int64_t bytes_of(const head *h, int32_t maps) {
  const int whole = h->rows == SIDE && h->columns == SIDE;
  const int few = h->rows >= 1 && h->rows <= MOST_COEFFICIENTS && h->columns >= 1 && h->columns <= MOST_COEFFICIENTS;
  const int level = maps < 2 ? h->levels == 0 : (h->levels >= 1 && h->levels <= MOST_LEVELS) || h->levels == POINTS;
  if (!(whole || few) || !level || h->zero != 0) return 0;
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
  if (e.zero != 0 || e.crc != entry_crc(bytes, number)) return ALTERED;
  const int64_t first = table->table + table->tiles * ALI3_TILE_ENTRY;
  if (e.bytes < HEAD || e.bytes > ALI3_MOST_RECORD || e.place < first || e.place > table->size - e.bytes)
    return "lies outside of the file";
  if (!ali3_file_read(table->stream, e.place, record, (size_t)e.bytes)) return "cannot be read";
  if (e.record_crc != ali3_crc32(record, (size_t)e.bytes)) return ALTERED;
  memcpy(&h, record, sizeof h);
  if (bytes_of(&h, table->maps) != e.bytes) return "has another form than its size says";
  heights(&h, record + HEAD, values);
  if (table->maps < 2) return NULL;
  return frictions(&h, record + HEAD + (size_t)h.rows * (size_t)h.columns * sizeof *values, values + POINTS);
}
