/* Reads a table of heights. The first row has the y of the columns after a cell that is not a number, the first column
 * the x of the rows; a later row that does not begin with a number is the first of the frictions. Cells are separated
 * by semicolons, tabs or commas, the first of these in the first row; if that is not the comma, the decimal separator
 * may be a comma. Lines that begin with # are comments. Independent of the locale. */
#include "road_table.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "../algebra/parse_number.h"
#include "road_file.h"

static const double TOLERANCE = 1e-6; /* of coordinates, relative to the spacing */
static const double ROUND_OFF = 1e-12; /* of coordinates, relative to the ends */

typedef struct {
  const char *position, *end;
  int line; /* its number, from 1 */
  char separator;
  char *message;
  size_t message_size;
} reader;

/* Writes a message; returns 0. */
static int write_message(const reader *r, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  if (r->message != NULL && r->message_size > 0) vsnprintf(r->message, r->message_size, format, arguments);
  va_end(arguments);
  return 0;
}

/* Finds the next line that is not empty and no comment; 0 at the end of the text. */
static int next_line(reader *r, const char **line, const char **line_end) {
  while (r->position < r->end) {
    const char *start = r->position, *stop = memchr(start, '\n', (size_t)(r->end - start));
    r->position = stop != NULL ? stop + 1 : r->end;
    if (stop == NULL) stop = r->end;
    r->line++;
    while (start < stop && (*start == ' ' || *start == '\r')) start++;
    while (stop > start && (stop[-1] == ' ' || stop[-1] == '\r')) stop--;
    if (start == stop || *start == '#') continue;
    *line = start;
    *line_end = stop;
    return 1;
  }
  return 0;
}

/* Trims a cell of a line: moves *cell to its start, returns its end; *next: start of the next cell or NULL. */
static const char *trim_cell(const reader *r, const char **cell, const char *line_end, const char **next) {
  const char *stop = memchr(*cell, r->separator, (size_t)(line_end - *cell));
  *next = stop != NULL ? stop + 1 : NULL;
  if (stop == NULL) stop = line_end;
  while (*cell < stop && **cell == ' ') ++*cell;
  while (stop > *cell && stop[-1] == ' ') stop--;
  return stop;
}

/* Parses a number; with separators other than a comma also with a decimal comma. 0: it is not one. */
static int parse_cell(const reader *r, const char *cell, const char *cell_end, double *value) {
  return ali3_parse_number(cell, cell_end, r->separator != ',', value);
}

/* Reads the first number of a line, NAN if it is not one, and the n numbers after it, all of which must be valid. */
static int read_row(const reader *r, const char *line, const char *line_end, int64_t n, double *first, double *values) {
  const char *cell = line, *next;
  for (int64_t k = 0; k <= n; k++) {
    if (cell == NULL)
      return write_message(r, "line %d has %lld cells, the first one %lld", r->line, (long long)k, (long long)n + 1);
    const char *stop = trim_cell(r, &cell, line_end, &next);
    double value = NAN;
    const int valid = parse_cell(r, cell, stop, &value);
    if (k == 0)
      *first = valid ? value : NAN;
    else if (valid)
      values[k - 1] = value;
    else
      return write_message(r, "'%.*s' in line %d is not a number", (int)(stop - cell < 20 ? stop - cell : 20), cell,
                           r->line);
    cell = next;
  }
  return cell == NULL ? 1 : write_message(r, "line %d has more cells than the first one", r->line);
}

/* Semicolon or tab if the line has one, otherwise comma. */
static char choose_separator(const char *line, const char *line_end) {
  const size_t size = (size_t)(line_end - line);
  if (memchr(line, ';', size) != NULL) return ';';
  return memchr(line, '\t', size) != NULL ? '\t' : ',';
}

/* Checks the first cell: its unit, if it has one in brackets, and that it is not a number. */
static int check_corner(const reader *r, const char *cell, const char *cell_end) {
  double value;
  if (cell_end > cell && cell_end[-1] == '"') cell_end--;
  const size_t size = (size_t)(cell_end - cell);
  if (memchr(cell, '[', size) != NULL && cell_end[-1] == ']' && (size < 3 || memcmp(cell_end - 3, "[m]", 3) != 0))
    return write_message(r, "its first cell is '%.*s'; coordinates and heights must be in m",
                         (int)(size < 40 ? size : 40), cell);
  if (parse_cell(r, cell, cell_end, &value))
    return write_message(r, "its first cell is a number, so that it has no coordinates; make a road file of it by: "
                            "ali3 road INPUT OUTPUT.road --spacing DX DY");
  return 1;
}

/* Counts the cells of a line from `cell`, which may be NULL. */
static int64_t count_cells(const reader *r, const char *cell, const char *line_end) {
  int64_t n = 0;
  for (; cell != NULL; n++) {
    cell = memchr(cell, r->separator, (size_t)(line_end - cell));
    if (cell != NULL) cell++;
  }
  return n;
}

/* Counts rows after the first ones; a second table has the frictions. */
static int count_rows(reader *r, ali3_road_table *t) {
  const char *line, *line_end, *next;
  double value;
  int64_t rows[2] = {0, 0};
  t->maps = 1;
  while (next_line(r, &line, &line_end)) {
    const char *cell = line, *cell_end = trim_cell(r, &cell, line_end, &next);
    if (parse_cell(r, cell, cell_end, &value))
      rows[t->maps - 1]++;
    else if (++t->maps > 2)
      return write_message(r, "line %d begins a third table; there are heights and frictions", r->line);
  }
  t->nx = rows[0];
  if (t->nx < 2 || t->ny < 2)
    return write_message(r, "it has %lld x %lld points; at least 2 x 2 are needed", (long long)t->nx, (long long)t->ny);
  if (t->maps == 2 && rows[1] != rows[0])
    return write_message(r, "it has %lld rows of heights and %lld of frictions", (long long)rows[0],
                         (long long)rows[1]);
  return 1;
}

/* Finds separator, columns, rows and tables. */
static int read_layout(reader *r, ali3_road_table *t) {
  const char *line, *line_end, *next;
  if (!next_line(r, &line, &line_end)) return write_message(r, "it is empty");
  r->separator = choose_separator(line, line_end);
  const char *cell = line, *cell_end = trim_cell(r, &cell, line_end, &next);
  if (!check_corner(r, cell, cell_end)) return 0;
  t->ny = count_cells(r, next, line_end);
  return count_rows(r, t);
}

/* First value and spacing of n ascending, equidistant coordinates. */
static int check_spacing(const reader *r, const double *coordinates, int64_t n, char axis, double *first,
                         double *spacing) {
  const double start = coordinates[0], end = coordinates[n - 1], step = (end - start) / (double)(n - 1);
  if (!(step > 0.0)) return write_message(r, "its coordinates %c do not ascend", axis);
  for (int64_t k = 0; k < n; k++) {
    const double expected = start + step * (double)k;
    if (!(fabs(coordinates[k] - expected) <= TOLERANCE * step + ROUND_OFF * (fabs(start) + fabs(end))))
      return write_message(r, "its coordinates %c are not regular: %.12g should be %.12g", axis, coordinates[k],
                           expected);
  }
  *first = start;
  *spacing = step;
  return 1;
}

/* Reads one table into nx * ny values; x, y: scratch for coordinates, whose first ones and spacings it finds. */
static int read_map(reader *r, const ali3_road_table *t, double *values, double *x, double *y, double first[2],
                    double spacing[2]) {
  const char *line, *line_end;
  if (!next_line(r, &line, &line_end) || !read_row(r, line, line_end, t->ny, &x[0], y)) return 0;
  for (int64_t i = 0; i < t->nx; i++) {
    if (!next_line(r, &line, &line_end) || !read_row(r, line, line_end, t->ny, &x[i], values + i * t->ny)) return 0;
    if (!isfinite(x[i])) return write_message(r, "line %d does not begin with a number", r->line);
  }
  return check_spacing(r, x, t->nx, 'x', &first[0], &spacing[0]) &&
         check_spacing(r, y, t->ny, 'y', &first[1], &spacing[1]);
}

/* Reads heights and frictions; x, y: scratch for coordinates. */
static int read_values(reader *r, ali3_road_table *t, double *x, double *y) {
  double first[2], spacing[2];
  if (!read_map(r, t, t->values, x, y, t->first, t->spacing)) return 0;
  if (t->maps == 1) return 1;
  if (!read_map(r, t, t->values + t->nx * t->ny, x, y, first, spacing)) return 0;
  for (int k = 0; k < 2; k++)
    if (first[k] != t->first[k] || spacing[k] != t->spacing[k])
      return write_message(r, "its frictions have other coordinates than its heights");
  return 1;
}

/* Checks the range of heights and frictions. */
static int check_values(const reader *r, const ali3_road_table *t) {
  const int64_t points = t->nx * t->ny;
  for (int64_t k = 0; k < t->maps * points; k++) {
    const double v = t->values[k];
    const int valid = k < points ? fabs(v) <= ALI3_ROAD_HIGHEST : v >= 0.0 && v <= ALI3_ROAD_FRICTION;
    if (!valid)
      return write_message(r, "its %s at row %lld, column %lld of the points is %g", k < points ? "height" : "friction",
                           (long long)(k % points / t->ny + 1), (long long)(k % t->ny + 1), v);
  }
  return 1;
}

int ali3_road_table_read(const char *text, size_t size, ali3_road_table *table,
                         void *(*allocate)(size_t count, size_t size), void (*release)(void *block), char *message,
                         size_t message_size) {
  reader r = {.position = text, .end = text + size, .message = message, .message_size = message_size};
  if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) r.position += 3;
  const char *start = r.position;
  if (!read_layout(&r, table)) return 0;
  if (table->nx > (int64_t)size / table->ny) /* before memory is taken */
    return write_message(&r, "its size does not allow so many rows and columns");
  const size_t points = (size_t)table->nx * (size_t)table->ny;
  table->values = allocate((size_t)table->maps * points + (size_t)table->nx + (size_t)table->ny, sizeof(double));
  if (table->values == NULL) return write_message(&r, "there is not enough memory");
  double *x = table->values + (size_t)table->maps * points;
  r.position = start;
  r.line = 0;
  if (read_values(&r, table, x, x + table->nx) && check_values(&r, table)) return 1;
  release(table->values);
  table->values = NULL;
  return 0;
}
