/* Interpolation between the points of a grid. A cubic through a step leaves the range of its ends by 4/27 of half the
 * step: it dips before a rise and bulges before a drop. Where that is more than PART of the spacing, beyond what a
 * parabola through the ends would, the slope of the point is limited to those of which the cubic stays in between (F. N.
 * Fritsch, R. E. Carlson, SIAM Journal on Numerical Analysis 17, 1980, 238-246) or to that of twice the parabola with the
 * smaller of the curvatures at both ends (A. Suresh, H. T. Huynh, Journal of Computational Physics 136, 1997, 83-99),
 * which keeps the crests of smooth roads; the twist of that point is none. A slope is one of its point, so that all
 * patches around it stay C1. */
#include "grid.h"

#include <math.h>

#include "../../include/ali3.h"
#include "../algebra/small_vectors.h"

#define PART 0.005                      /* of the spacing */
#define MOST_SLOPE (27.0 / 4.0 * PART) /* change from point to point over the spacing that leaves the range by PART */

enum { MOST_CELLS = 400 }; /* looked at for a top */
#define OVERSHOOT 0.35     /* a bicubic patch leaves the range of its values by less than this part of it */

/* Cubic Hermite weights (slopes by central differences, one-sided at the border) of values first..first+3 (clamped to
 * 0..n-1). */
static int cubic(double s, int n, double w[4], double dw[4]) {
  int i = s >= (double)(n - 1) ? n - 2 : s > 0.0 ? (int)s : 0;
  const int outside = s < 0.0 || s > (double)(n - 1);
  const double t = ali3_clamp(s - i, 0.0, 1.0), left = i > 0 ? 0.5 : 1.0, right = i + 2 < n ? 0.5 : 1.0;
  const double h10 = t * (1.0 - t) * (1.0 - t) * left, h11 = t * t * (t - 1.0) * right, h01 = t * t * (3.0 - 2.0 * t);
  const double d10 = (1.0 - t) * (1.0 - 3.0 * t) * left, d11 = t * (3.0 * t - 2.0) * right, d01 = 6.0 * t * (1.0 - t);
  w[0] = -h10, w[1] = 1.0 - h01 - h11, w[2] = h01 + h10, w[3] = h11;
  dw[0] = -d10, dw[1] = -d01 - d11, dw[2] = d01 + d10, dw[3] = d11;
  if (outside) dw[0] = dw[1] = dw[2] = dw[3] = 0.0; /* the border value goes on */
  return i - 1;
}

static double height(const ali3_grid *g, int32_t i, int32_t j) {
  return g->file != NULL ? ali3_road_file_height(g->file, i, j) : g->z[(int64_t)i * g->ny + j];
}

static double friction(const ali3_grid *g, int32_t i, int32_t j) {
  return g->file != NULL ? ali3_road_file_friction(g->file, i, j) : g->mu[(int64_t)i * g->ny + j];
}

static int32_t within(int32_t i, int32_t n) { return i < 0 ? 0 : i >= n ? n - 1 : i; }

static double smaller(double a, double b) { return a * b > 0.0 ? (fabs(a) < fabs(b) ? a : b) : 0.0; }

/* Narrows low..high to slopes with which a segment of the difference d keeps its range, or follows a parabola. */
static void narrow(double d, double parabola, double *low, double *high) {
  const double a = fmin(0.0, fmin(3.0 * d, parabola)), b = fmax(0.0, fmax(3.0 * d, parabola));
  *low = fmax(*low, a);
  *high = fmin(*high, b);
}

/* Difference per spacing at the third of five points in a line, and whether it was limited. */
static double slope_of(const double z[5], double spacing, int *limited) {
  double d[4], low = -INFINITY, high = INFINITY;
  for (int k = 0; k < 4; k++) d[k] = z[k + 1] - z[k];
  const double before = d[1] - d[0], here = d[2] - d[1], after = d[3] - d[2], own = 0.5 * (d[1] + d[2]);
  narrow(d[2], d[2] - smaller(here, after), &low, &high);
  narrow(d[1], d[1] + smaller(before, here), &low, &high);
  const double slope = ali3_clamp(own, low, high);
  if (!(fabs(slope - own) > MOST_SLOPE * spacing)) return own;
  *limited = 1;
  return slope;
}

/* A point whose neighbours are all there; at the border slopes are one-sided and stay in the range anyway. */
static ali3_grid_point corner_at(const ali3_grid *g, int i, int j, int *any) {
  double line[5];
  int limited = 0;
  ali3_grid_point c = {.z = height(g, i, j)};
  const int left = i > 0, right = i + 1 < g->nx, down = j > 0, up = j + 1 < g->ny;
  for (int k = -2; k <= 2; k++) line[k + 2] = height(g, within(i + k, g->nx), j);
  c.x = left && right ? slope_of(line, g->dx, &limited) : left ? line[2] - line[1] : line[3] - line[2];
  for (int k = -2; k <= 2; k++) line[k + 2] = height(g, i, within(j + k, g->ny));
  c.y = down && up ? slope_of(line, g->dy, &limited) : down ? line[2] - line[1] : line[3] - line[2];
  if (limited) {
    *any = 1;
    return c;
  }
  const double twist = height(g, i + right, j + up) - height(g, i + right, j - down) -
                       (height(g, i - left, j + up) - height(g, i - left, j - down));
  c.xy = twist / ((double)(left + right) * (double)(down + up));
  return c;
}

/* Weights of value and slope at both ends of a segment, and their derivatives. */
static void hermite(double t, int outside, double w[2][2], double dw[2][2]) {
  const double s = 1.0 - t;
  w[0][1] = t * t * (3.0 - 2.0 * t), w[0][0] = 1.0 - w[0][1], w[1][0] = t * s * s, w[1][1] = -t * t * s;
  dw[0][1] = outside ? 0.0 : 6.0 * t * s, dw[0][0] = -dw[0][1];
  dw[1][0] = outside ? 0.0 : s * (1.0 - 3.0 * t), dw[1][1] = outside ? 0.0 : t * (3.0 * t - 2.0);
}

/* Height and slope of a patch whose slopes are limited. */
static void limited_patch(const ali3_grid *g, const ali3_cell *cell, const double s[2], double *z, double slope[2]) {
  const int first[2] = {cell->i + 1, cell->j + 1};
  double wx[2][2], dx[2][2], wy[2][2], dy[2][2];
  hermite(ali3_clamp(s[0] - first[0], 0.0, 1.0), s[0] < 0.0 || s[0] > (double)(g->nx - 1), wx, dx);
  hermite(ali3_clamp(s[1] - first[1], 0.0, 1.0), s[1] < 0.0 || s[1] > (double)(g->ny - 1), wy, dy);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      const ali3_grid_point c = cell->corner[i][j];
      const double a = c.z * wy[0][j] + c.y * wy[1][j], b = c.x * wy[0][j] + c.xy * wy[1][j];
      const double da = c.z * dy[0][j] + c.y * dy[1][j], db = c.x * dy[0][j] + c.xy * dy[1][j];
      *z += wx[0][i] * a + wx[1][i] * b;
      slope[0] += (dx[0][i] * a + dx[1][i] * b) / g->dx;
      slope[1] += (wx[0][i] * da + wx[1][i] * db) / g->dy;
    }
}

/* Whether a second difference at a corner is large enough for a limit. */
static int may_be_limited(const ali3_grid *g, const double v[4][4]) {
  for (int k = 1; k < 3; k++)
    for (int l = 1; l < 3; l++)
      if (fabs(v[k + 1][l] - 2.0 * v[k][l] + v[k - 1][l]) > 2.0 * MOST_SLOPE * g->dx ||
          fabs(v[k][l + 1] - 2.0 * v[k][l] + v[k][l - 1]) > 2.0 * MOST_SLOPE * g->dy)
        return 1;
  return 0;
}

/* Values around the cell with the indices i, j before its first corner. */
static void hold(const ali3_grid *g, ali3_cell *cell, int i0, int j0) {
  if (cell->held && cell->i == i0 && cell->j == j0) return;
  cell->held = 1, cell->limited = 0, cell->i = i0, cell->j = j0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) cell->z[i][j] = height(g, within(i0 + i, g->nx), within(j0 + j, g->ny));
  const int look = may_be_limited(g, (const double (*)[4])cell->z);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      cell->friction[i][j] = friction(g, i0 + 1 + i, j0 + 1 + j);
      if (look) cell->corner[i][j] = corner_at(g, i0 + 1 + i, j0 + 1 + j, &cell->limited);
    }
}

ali3_surface ali3_grid_near(const ali3_grid *g, ali3_cell *cell, double x, double y) {
  double wx[4], dx[4], wy[4], dy[4], z = 0.0, slope[2] = {0.0, 0.0};
  const double s[2] = {ali3_clamp((x - g->x0) / g->dx, -1.0, (double)g->nx),
                       ali3_clamp((y - g->y0) / g->dy, -1.0, (double)g->ny)};
  const int i0 = cubic(s[0], g->nx, wx, dx), j0 = cubic(s[1], g->ny, wy, dy);
  hold(g, cell, i0, j0);
  if (cell->limited)
    limited_patch(g, cell, s, &z, slope);
  else
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) {
        const double value = cell->z[i][j];
        z += wx[i] * wy[j] * value;
        slope[0] += dx[i] * wy[j] * value / g->dx;
        slope[1] += wx[i] * dy[j] * value / g->dy;
      }
  const double tx = ali3_clamp(s[0] - (i0 + 1), 0.0, 1.0), ty = ali3_clamp(s[1] - (j0 + 1), 0.0, 1.0);
  const double (*m)[2] = (const double (*)[2])cell->friction;
  const double mu = (1.0 - tx) * ((1.0 - ty) * m[0][0] + ty * m[0][1]) + tx * ((1.0 - ty) * m[1][0] + ty * m[1][1]);
  const double size = sqrt(1.0 + slope[0] * slope[0] + slope[1] * slope[1]);
  const ali3_surface found = {z, {-slope[0] / size, -slope[1] / size, 1.0 / size}, mu};
  return found;
}

ali3_surface ali3_grid_at(const ali3_grid *g, double x, double y) {
  ali3_cell cell = {0};
  return ali3_grid_near(g, &cell, x, y);
}

double ali3_grid_chord(const ali3_grid *g, double x, double y) {
  const double sx = ali3_clamp((x - g->x0) / g->dx, 0.0, (double)(g->nx - 1)),
               sy = ali3_clamp((y - g->y0) / g->dy, 0.0, (double)(g->ny - 1));
  const int i = within((int)sx, g->nx - 1), j = within((int)sy, g->ny - 1);
  const double a = height(g, i, j), b = height(g, i + 1, j), c = height(g, i, j + 1), d = height(g, i + 1, j + 1);
  const double near = a + (sx - i) * (b - a), far = c + (sx - i) * (d - c);
  return near + (sy - j) * (far - near);
}

/* Indices low..high of the values that cells within reach of a place take. */
static void cells(double place, double reach, double first, double spacing, int n, int *low, int *high) {
  const double last = (double)(n - 1), a = (place - reach - first) / spacing, b = (place + reach - first) / spacing;
  *low = (int)ali3_clamp(a - 1.0, 0.0, last);
  *high = (int)ali3_clamp(b + 3.0, 0.0, last);
}

double ali3_grid_top(const ali3_grid *g, const double place[3], double reach) {
  int low[2], high[2];
  cells(place[0], reach, g->x0, g->dx, g->nx, &low[0], &high[0]);
  cells(place[1], reach, g->y0, g->dy, g->ny, &low[1], &high[1]);
  if ((int64_t)(high[0] - low[0] + 1) * (high[1] - low[1] + 1) > MOST_CELLS) return INFINITY;
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
