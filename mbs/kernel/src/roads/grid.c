/* Interpolation between the points of a grid. A cubic through a step exceeds the range of its ends by 4/27 of half the
 * step: it dips before a rise and bulges before a drop. Where that is more than MAX_OVERSHOOT of the spacing, beyond a
 * parabola through the ends, the slope at the point is limited to slopes for which the cubic stays in the range (F. N.
 * Fritsch, R. E. Carlson, SIAM Journal on Numerical Analysis 17, 1980, 238-246) or to twice the slope of the parabola
 * with the smaller one of the curvatures at both ends (A. Suresh, H. T. Huynh, Journal of Computational Physics 136,
 * 1997, 83-99), which preserves the crests of smooth roads; the twist at that point is zero. Slopes belong to points,
 * so that the patches around one are C1. */
#include "grid.h"

#include <math.h>

#include "../../include/ali3.h"
#include "../algebra/processor.h"
#include "../algebra/small_vectors.h"

#define MAX_OVERSHOOT 0.005                           /* of the spacing */
#define MAX_SLOPE_CHANGE (27.0 / 4.0 * MAX_OVERSHOOT) /* change of the slope that overshoots so much */

enum { MAX_POINTS = 400 }; /* read by ali3_grid_top */
#define OVERSHOOT 0.35     /* relative bound by which a bicubic patch exceeds the range of its values */
enum { AROUND = 6 };       /* points along a side that slopes at the corners of a cell depend on */

/* Index of the cell at s, in spacings; beyond the border the outermost cell. */
static int cell_of(double s, int n) { return s >= (double)(n - 1) ? n - 2 : s > 0.0 ? (int)s : 0; }

/* Cubic Hermite weights (slopes by central differences, one-sided at the border) of values first..first+3 (clamped to
 * 0..n-1). */
ALI3_INLINED void cubic(double s, int n, double w[4], double dw[4]) {
  const int i = cell_of(s, n);
  const int outside = s < 0.0 || s > (double)(n - 1);
  const double t = ali3_clamp(s - i, 0.0, 1.0), left = i > 0 ? 0.5 : 1.0, right = i + 2 < n ? 0.5 : 1.0;
  const double h10 = t * (1.0 - t) * (1.0 - t) * left, h11 = t * t * (t - 1.0) * right, h01 = t * t * (3.0 - 2.0 * t);
  const double d10 = (1.0 - t) * (1.0 - 3.0 * t) * left, d11 = t * (3.0 * t - 2.0) * right, d01 = 6.0 * t * (1.0 - t);
  w[0] = -h10, w[1] = 1.0 - h01 - h11, w[2] = h01 + h10, w[3] = h11;
  dw[0] = -d10, dw[1] = -d01 - d11, dw[2] = d01 + d10, dw[3] = d11;
  if (outside) dw[0] = dw[1] = dw[2] = dw[3] = 0.0; /* constant beyond the border */
}

/* Height of point (i, j), m. */
static double height(const ali3_grid *g, int32_t i, int32_t j) {
  return g->file != NULL ? ali3_road_file_height(g->file, i, j) : g->z[(int64_t)i * g->ny + j];
}

/* Friction of point (i, j). */
static double friction(const ali3_grid *g, int32_t i, int32_t j) {
  return g->file != NULL ? ali3_road_file_friction(g->file, i, j) : g->mu[(int64_t)i * g->ny + j];
}

static int32_t clamped_index(int32_t i, int32_t n) { return i < 0 ? 0 : i >= n ? n - 1 : i; }

/* The smaller slope; 0 if the signs differ. */
static double smaller(double a, double b) { return a * b > 0.0 ? (fabs(a) < fabs(b) ? a : b) : 0.0; }

/* Limits low..high to slopes with which a segment of difference d stays in its range, or follows a parabola. */
static void limit_slope(double d, double parabola, double *low, double *high) {
  const double a = fmin(0.0, fmin(3.0 * d, parabola)), b = fmax(0.0, fmax(3.0 * d, parabola));
  *low = fmax(*low, a);
  *high = fmin(*high, b);
}

/* Difference per spacing at the third of five collinear points; *limited: it was limited. */
static double slope_of(const double z[5], double spacing, int *limited) {
  double d[4], low = -INFINITY, high = INFINITY;
  for (int k = 0; k < 4; k++) d[k] = z[k + 1] - z[k];
  const double before = d[1] - d[0], here = d[2] - d[1], after = d[3] - d[2], own = 0.5 * (d[1] + d[2]);
  limit_slope(d[2], d[2] - smaller(here, after), &low, &high);
  limit_slope(d[1], d[1] + smaller(before, here), &low, &high);
  const double slope = ali3_clamp(own, low, high);
  if (!(fabs(slope - own) > MAX_SLOPE_CHANGE * spacing)) return own;
  *limited = 1;
  return slope;
}

/* Corner (k, l) of a cell, each 0 or 1, from the values around it; at the border slopes are one-sided and stay in the
 * range. */
static ali3_grid_point corner_at(const ali3_grid *g, const ali3_cell *cell, const double v[AROUND][AROUND], int k,
                                 int l, int *any_limited) {
  double line[5];
  int limited = 0;
  const int i = cell->i + 1 + k, j = cell->j + 1 + l, a = k + 2, b = l + 2; /* indices in the grid, in the values */
  ali3_grid_point c = {.z = v[a][b]};
  const int left = i > 0, right = i + 1 < g->nx, down = j > 0, up = j + 1 < g->ny;
  for (int n = -2; n <= 2; n++) line[n + 2] = v[a + n][b];
  c.x = left && right ? slope_of(line, g->dx, &limited) : left ? line[2] - line[1] : line[3] - line[2];
  c.y = down && up ? slope_of(&v[a][b - 2], g->dy, &limited) : down ? v[a][b] - v[a][b - 1] : v[a][b + 1] - v[a][b];
  if (limited) {
    *any_limited = 1;
    return c;
  }
  const double twist = v[a + right][b + up] - v[a + right][b - down] - (v[a - left][b + up] - v[a - left][b - down]);
  c.xy = twist / ((double)(left + right) * (double)(down + up));
  return c;
}

/* Hermite weights w[value, slope][end] of a segment, and their derivatives. */
ALI3_INLINED void hermite(double t, int outside, double w[2][2], double dw[2][2]) {
  const double s = 1.0 - t;
  w[0][1] = t * t * (3.0 - 2.0 * t), w[0][0] = 1.0 - w[0][1], w[1][0] = t * s * s, w[1][1] = -t * t * s;
  dw[0][1] = outside ? 0.0 : 6.0 * t * s, dw[0][0] = -dw[0][1];
  dw[1][0] = outside ? 0.0 : s * (1.0 - 3.0 * t), dw[1][1] = outside ? 0.0 : t * (3.0 * t - 2.0);
}

/* Height of a patch with limited slopes, and its slopes unless NULL. */
ALI3_INLINED double limited_patch(const ali3_grid *g, const ali3_cell *cell, const double s[2], double *slope) {
  const int first[2] = {cell->i + 1, cell->j + 1};
  double wx[2][2], dx[2][2], wy[2][2], dy[2][2], z = 0.0;
  hermite(ali3_clamp(s[0] - first[0], 0.0, 1.0), s[0] < 0.0 || s[0] > (double)(g->nx - 1), wx, dx);
  hermite(ali3_clamp(s[1] - first[1], 0.0, 1.0), s[1] < 0.0 || s[1] > (double)(g->ny - 1), wy, dy);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      const ali3_grid_point c = cell->corner[i][j];
      const double a = c.z * wy[0][j] + c.y * wy[1][j], b = c.x * wy[0][j] + c.xy * wy[1][j];
      z += wx[0][i] * a + wx[1][i] * b;
      if (slope == NULL) continue;
      const double da = c.z * dy[0][j] + c.y * dy[1][j], db = c.x * dy[0][j] + c.xy * dy[1][j];
      slope[0] += (dx[0][i] * a + dx[1][i] * b) / g->dx;
      slope[1] += (wx[0][i] * da + wx[1][i] * db) / g->dy;
    }
  return z;
}

/* Height and slope (unless NULL) on the patch of the loaded cell. */
ALI3_INLINED double patch(const ali3_grid *g, const ali3_cell *cell, const double s[2], double *slope) {
  double wx[4], dx[4], wy[4], dy[4], z = 0.0;
  if (cell->limited) return limited_patch(g, cell, s, slope);
  cubic(s[0], g->nx, wx, dx);
  cubic(s[1], g->ny, wy, dy);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      const double value = cell->z[i][j];
      z += wx[i] * wy[j] * value;
      if (slope == NULL) continue;
      slope[0] += dx[i] * wy[j] * value / g->dx;
      slope[1] += wx[i] * dy[j] * value / g->dy;
    }
  return z;
}

/* Whether a second difference at a corner is large enough for a limit. */
static int may_be_limited(const ali3_grid *g, const double v[4][4]) {
  for (int k = 1; k < 3; k++)
    for (int l = 1; l < 3; l++)
      if (fabs(v[k + 1][l] - 2.0 * v[k][l] + v[k - 1][l]) > 2.0 * MAX_SLOPE_CHANGE * g->dx ||
          fabs(v[k][l + 1] - 2.0 * v[k][l] + v[k][l - 1]) > 2.0 * MAX_SLOPE_CHANGE * g->dy)
        return 1;
  return 0;
}

/* Reads heights of n x n points, the first at the indices i, j; outside the grid heights of the border. */
static void read_heights(const ali3_grid *g, int i, int j, int n, double *v) {
  if (g->file == NULL || i < 0 || j < 0 || i + n > g->nx || j + n > g->ny) {
    for (int k = 0; k < n; k++)
      for (int l = 0; l < n; l++) v[k * n + l] = height(g, clamped_index(i + k, g->nx), clamped_index(j + l, g->ny));
    return;
  }
  int32_t stride, size[2];
  for (int k = 0; k < n; k += size[0])
    for (int l = 0; l < n; l += size[1]) {
      size[0] = n - k, size[1] = n - l;
      const double *from = ali3_road_file_block(g->file, i + k, j + l, size, &stride);
      for (int a = 0; a < size[0]; a++)
        for (int b = 0; b < size[1]; b++) v[(k + a) * n + l + b] = from != NULL ? from[a * stride + b] : 0.0;
    }
}

/* Reads the values around the cell with the indices i0, j0 before its first corner, and computes the bounds of its
 * patch. */
static void fill_cell(const ali3_grid *g, ali3_cell *cell, int i0, int j0) {
  cell->held = 1, cell->limited = cell->bears = 0, cell->i = i0, cell->j = j0;
  read_heights(g, i0, j0, 4, cell->z[0]);
  double low = cell->z[0][0], high = low;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      low = cell->z[i][j] < low ? cell->z[i][j] : low;
      high = cell->z[i][j] > high ? cell->z[i][j] : high;
    }
  cell->least = low - OVERSHOOT * (high - low), cell->most = high + OVERSHOOT * (high - low);
  if (!may_be_limited(g, (const double (*)[4])cell->z)) return;
  double around[AROUND][AROUND];
  read_heights(g, i0 - 1, j0 - 1, AROUND, around[0]);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      cell->corner[i][j] = corner_at(g, cell, (const double (*)[AROUND])around, i, j, &cell->limited);
}

/* Reads the frictions at the corners of the loaded cell. */
static void load_friction(const ali3_grid *g, ali3_cell *cell) {
  if (cell->bears) return;
  cell->bears = 1;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) cell->friction[i][j] = friction(g, cell->i + 1 + i, cell->j + 1 + j);
}

/* Whether a cell holds the values of cell (i0, j0). */
static int is_loaded(const ali3_cell *cell, int i0, int j0) { return cell->held && cell->i == i0 && cell->j == j0; }

/* Loads a cell; cells of a file are stored with it, unless a tile could not be read. */
static void load_cell(const ali3_grid *g, ali3_cell *cell, int i0, int j0) {
  if (is_loaded(cell, i0, j0)) return;
  if (g->file == NULL) {
    fill_cell(g, cell, i0, j0);
    return;
  }
  ali3_cell *stored = ali3_road_file_cell(g->file, i0, j0);
  if (is_loaded(stored, i0, j0)) {
    *cell = *stored;
    return;
  }
  fill_cell(g, cell, i0, j0);
  load_friction(g, cell);
  if (ali3_road_file_read_error(g->file) == NULL) *stored = *cell;
}

/* Loads the cell at a point; s: its position in spacings from the first point. */
static void load_cell_at(const ali3_grid *g, ali3_cell *cell, double x, double y, double s[2]) {
  s[0] = ali3_clamp((x - g->x0) / g->dx, -1.0, (double)g->nx);
  s[1] = ali3_clamp((y - g->y0) / g->dy, -1.0, (double)g->ny);
  load_cell(g, cell, cell_of(s[0], g->nx) - 1, cell_of(s[1], g->ny) - 1);
}

ali3_surface ali3_grid_near(const ali3_grid *g, ali3_cell *cell, double x, double y) {
  double s[2], slope[2] = {0.0, 0.0};
  load_cell_at(g, cell, x, y, s);
  load_friction(g, cell);
  const double z = patch(g, cell, s, slope);
  const double tx = ali3_clamp(s[0] - (cell->i + 1), 0.0, 1.0), ty = ali3_clamp(s[1] - (cell->j + 1), 0.0, 1.0);
  const double (*m)[2] = (const double (*)[2])cell->friction;
  const double mu = (1.0 - tx) * ((1.0 - ty) * m[0][0] + ty * m[0][1]) + tx * ((1.0 - ty) * m[1][0] + ty * m[1][1]);
  const double size = sqrt(1.0 + slope[0] * slope[0] + slope[1] * slope[1]);
  const ali3_surface surface = {z, {-slope[0] / size, -slope[1] / size, 1.0 / size}, mu};
  return surface;
}

double ali3_grid_height(const ali3_grid *g, ali3_cell *cell, double x, double y) {
  double s[2];
  load_cell_at(g, cell, x, y, s);
  return patch(g, cell, s, NULL);
}

int ali3_grid_is_below(const ali3_grid *g, ali3_cell *cell, double x, double y, double z) {
  double s[2];
  load_cell_at(g, cell, x, y, s);
  return cell->most <= z || (cell->least <= z && patch(g, cell, s, NULL) <= z);
}

ali3_surface ali3_grid_at(const ali3_grid *g, double x, double y) {
  ali3_cell cell = {0};
  return ali3_grid_near(g, &cell, x, y);
}

double ali3_grid_chord(const ali3_grid *g, double x, double y) {
  const double sx = ali3_clamp((x - g->x0) / g->dx, 0.0, (double)(g->nx - 1)),
               sy = ali3_clamp((y - g->y0) / g->dy, 0.0, (double)(g->ny - 1));
  const int i = clamped_index((int)sx, g->nx - 1), j = clamped_index((int)sy, g->ny - 1);
  const double a = height(g, i, j), b = height(g, i + 1, j), c = height(g, i, j + 1), d = height(g, i + 1, j + 1);
  const double near = a + (sx - i) * (b - a), far = c + (sx - i) * (d - c);
  return near + (sy - j) * (far - near);
}

/* Index range low..high of the points that cells within reach of a position depend on. */
static void index_range(double centre, double reach, double first, double spacing, int n, int *low, int *high) {
  const double last = (double)(n - 1), a = (centre - reach - first) / spacing, b = (centre + reach - first) / spacing;
  *low = (int)ali3_clamp(a - 1.0, 0.0, last);
  *high = (int)ali3_clamp(b + 3.0, 0.0, last);
}

double ali3_grid_top(const ali3_grid *g, const double place[3], double reach) {
  int low[2], high[2];
  index_range(place[0], reach, g->x0, g->dx, g->nx, &low[0], &high[0]);
  index_range(place[1], reach, g->y0, g->dy, g->ny, &low[1], &high[1]);
  if ((int64_t)(high[0] - low[0] + 1) * (high[1] - low[1] + 1) > MAX_POINTS) return INFINITY;
  double top = -INFINITY, bottom = INFINITY;
  for (int i = low[0]; i <= high[0]; i++)
    for (int j = low[1]; j <= high[1]; j++) {
      const double z = height(g, i, j);
      top = z > top ? z : top;
      bottom = z < bottom ? z : bottom;
    }
  return top + OVERSHOOT * (top - bottom);
}

void ali3_grid_heights(int32_t nx, int32_t ny, const double grid[4], const double *z, int64_t n, const double *places,
                       double *heights) {
  const ali3_grid g = {.nx = nx, .ny = ny, .x0 = grid[0], .y0 = grid[1], .dx = grid[2], .dy = grid[3], .z = z, .mu = z};
  for (int64_t k = 0; k < n; k++) heights[k] = ali3_grid_at(&g, places[2 * k], places[2 * k + 1]).height;
}
