/* Reads a table of heights. The first row has the y of the columns after a cell that is not a number, the first column
 * the x of the rows; another row that does not begin with a number begins the frictions. Cells are separated by
 * semicolons, tabs or commas, the first of these in the first row; unless it is the comma, the decimal separator may be
 * a comma. Lines that begin with # are comments. Independent of the locale. */
#include "road_table.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const double REGULAR = 1e-6; /* tolerance of coordinates, of the spacing */

typedef struct {
  const char *position, *end;
  int line;
  char separator;
  char *message;
  size_t message_size;
} reader;

static int refuse(const reader *r, const char *format, ...) {
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

/* Returns the end of a cell of a line, without blanks around it; *next: start of the next cell or NULL. */
static const char *cell_end(const reader *r, const char **cell, const char *line_end, const char **next) {
  const char *stop = memchr(*cell, r->separator, (size_t)(line_end - *cell));
  *next = stop != NULL ? stop + 1 : NULL;
  if (stop == NULL) stop = line_end;
  while (*cell < stop && **cell == ' ') ++*cell;
  while (stop > *cell && stop[-1] == ' ') stop--;
  return stop;
}

static int digit(const char *p, const char *end) { return p < end && *p >= '0' && *p <= '9'; }

/* Parses a cell as a number, identically on all platforms: error at most 1.5 units in the last place, exact to 15
 * digits. */
static int parse_number(const reader *r, const char *p, const char *end, double *value) {
  uint64_t digits = 0;
  int power = 0, has_digits = 0, exponent = 0, negative_exponent;
  const int negative = p < end && *p == '-';
  if (p < end && (*p == '-' || *p == '+')) p++;
  for (int in_fraction = 0;
       digit(p, end) || (!in_fraction && p < end && (*p == '.' || (*p == ',' && r->separator != ','))); p++) {
    if (!digit(p, end)) {
      in_fraction = 1;
      continue;
    }
    has_digits = 1;
    if (digits < 100000000000000000u) {
      digits = 10 * digits + (uint64_t)(*p - '0');
      power -= in_fraction;
    } else {
      power += !in_fraction;
    }
  }
  if (!has_digits) return 0;
  if (p < end && (*p == 'e' || *p == 'E')) {
    p++;
    negative_exponent = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) p++;
    if (!digit(p, end)) return 0;
    for (; digit(p, end); p++)
      if (exponent < 1000) exponent = 10 * exponent + (*p - '0');
    power += negative_exponent ? -exponent : exponent;
  }
  double v = (double)digits;
  for (; power > 0 && v > 0.0 && v < 1e300; power--) v *= 10.0;
  double divisor = 1.0;
  for (int k = 0; power < 0 && k < 22; k++, power++) divisor *= 10.0; /* exact up to 1e22 */
  v /= divisor;
  for (; power < 0 && v > 0.0; power++) v /= 10.0;
  *value = negative ? -v : v;
  return p == end && v < 1e300;
}

/* Reads the n numbers of a line from its second cell on, and the first one, NAN if it is not a number. */
static int read_row(const reader *r, const char *line, const char *line_end, int64_t n, double *first, double *to) {
  const char *cell = line, *next;
  for (int64_t k = 0; k <= n; k++) {
    if (cell == NULL)
      return refuse(r, "line %d has %lld cells, the first one %lld", r->line, (long long)k, (long long)n + 1);
    const char *stop = cell_end(r, &cell, line_end, &next);
    double value = NAN;
    const int valid = parse_number(r, cell, stop, &value);
    if (k == 0)
      *first = valid ? value : NAN;
    else if (valid)
      to[k - 1] = value;
    else
      return refuse(r, "'%.*s' in line %d is not a number", (int)(stop - cell < 20 ? stop - cell : 20), cell, r->line);
    cell = next;
  }
  return cell == NULL || refuse(r, "line %d has more cells than the first one", r->line);
}

/* Counts columns and rows after the first ones and finds whether a second table follows. */
static int count_cells(reader *r, ali3_road_table *t) {
  const char *line, *line_end, *next;
  double value;
  int64_t rows[2] = {0, 0};
  if (!next_line(r, &line, &line_end)) return refuse(r, "it is empty");
  r->separator = memchr(line, ';', (size_t)(line_end - line)) != NULL    ? ';'
                 : memchr(line, '\t', (size_t)(line_end - line)) != NULL ? '\t'
                                                                         : ',';
  const char *cell = line, *corner_end = cell_end(r, &cell, line_end, &next);
  if (corner_end > cell && corner_end[-1] == '"') corner_end--;
  const size_t corner = (size_t)(corner_end - cell);
  if (memchr(cell, '[', corner) != NULL && corner_end[-1] == ']' &&
      (corner < 3 || memcmp(corner_end - 3, "[m]", 3) != 0))
    return refuse(r, "its first cell is '%.*s'; coordinates and heights must be in m", (int)(corner < 40 ? corner : 40),
                  cell);
  if (parse_number(r, cell, corner_end, &value))
    return refuse(r, "its first cell is a number, so that it has no coordinates; make a road file of it by: ali3 road "
                     "INPUT OUTPUT.road --spacing DX DY");
  t->ny = 0;
  while (next != NULL) {
    t->ny++;
    next = memchr(next, r->separator, (size_t)(line_end - next));
    if (next != NULL) next++;
  }
  t->maps = 1;
  while (next_line(r, &line, &line_end)) {
    cell = line;
    if (parse_number(r, cell, cell_end(r, &cell, line_end, &next), &value))
      rows[t->maps - 1]++;
    else if (++t->maps > 2)
      return refuse(r, "line %d begins a third table; there are heights and frictions", r->line);
  }
  t->nx = rows[0];
  if (t->nx < 2 || t->ny < 2)
    return refuse(r, "it has %lld x %lld points; at least 2 x 2 are needed", (long long)t->nx, (long long)t->ny);
  return t->maps == 1 || rows[1] == rows[0] ||
         refuse(r, "it has %lld rows of heights and %lld of frictions", (long long)rows[0], (long long)rows[1]);
}

/* First value and spacing of n ascending, equidistant coordinates. */
static int check_spacing(const reader *r, const double *v, int64_t n, char name, double *first, double *spacing) {
  const double step = (v[n - 1] - v[0]) / (double)(n - 1);
  if (!(step > 0.0)) return refuse(r, "its coordinates %c do not ascend", name);
  for (int64_t k = 0; k < n; k++) {
    const double expected = v[0] + step * (double)k;
    if (!(fabs(v[k] - expected) <= REGULAR * step + 1e-12 * (fabs(v[0]) + fabs(v[n - 1]))))
      return refuse(r, "its coordinates %c are not regular: %.12g should be %.12g", name, v[k], expected);
  }
  *first = v[0];
  *spacing = step;
  return 1;
}

/* Reads both tables; x and y are work for coordinates. The second table must have those of the first. */
static int read_values(reader *r, ali3_road_table *t, double *x, double *y) {
  const char *line, *line_end;
  double first;
  for (int32_t map = 0; map < t->maps; map++) {
    double *to = t->values + map * t->nx * t->ny, first_point[2], step[2];
    if (!next_line(r, &line, &line_end) || !read_row(r, line, line_end, t->ny, &first, y)) return 0;
    for (int64_t i = 0; i < t->nx; i++, to += t->ny) {
      if (!next_line(r, &line, &line_end) || !read_row(r, line, line_end, t->ny, &first, to)) return 0;
      if (!(first - first == 0.0)) return refuse(r, "line %d begins with no number", r->line);
      x[i] = first;
    }
    if (!check_spacing(r, x, t->nx, 'x', &first_point[0], &step[0]) ||
        !check_spacing(r, y, t->ny, 'y', &first_point[1], &step[1]))
      return 0;
    for (int k = 0; k < 2; k++) {
      if (map > 0 && (first_point[k] != t->first[k] || step[k] != t->spacing[k]))
        return refuse(r, "its frictions have other coordinates than its heights");
      t->first[k] = first_point[k];
      t->spacing[k] = step[k];
    }
  }
  return 1;
}

int ali3_road_table_read(const char *text, size_t size, ali3_road_table *t,
                         void *(*allocate)(size_t count, size_t size), void (*release)(void *block),
                         char *message, size_t message_size) {
  reader r = {.position = text, .end = text + size, .message = message, .message_size = message_size};
  if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) r.position += 3;
  const char *start = r.position;
  if (!count_cells(&r, t)) return 0;
  const size_t points = (size_t)t->nx * (size_t)t->ny;
  if (t->nx > (int64_t)size / t->ny) return refuse(&r, "it has fewer cells than rows and columns");
  t->values = allocate((size_t)t->maps * points + (size_t)t->nx + (size_t)t->ny, sizeof(double));
  if (t->values == NULL) return refuse(&r, "there is not enough memory");
  double *x = t->values + (size_t)t->maps * points;
  r.position = start;
  r.line = 0;
  if (read_values(&r, t, x, x + t->nx)) return 1;
  release(t->values);
  t->values = NULL;
  return 0;
}
