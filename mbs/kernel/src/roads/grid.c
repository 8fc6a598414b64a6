/* Interpolation between the points of a grid. */
#include "grid.h"

#include <math.h>

#include "../algebra/small_vectors.h"

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

ali3_surface ali3_grid_at(const ali3_grid *g, double x, double y) {
  double wx[4], dx[4], wy[4], dy[4], z = 0.0, slope[2] = {0.0, 0.0};
  const double sx = ali3_clamp((x - g->x0) / g->dx, -1.0, (double)g->nx),
               sy = ali3_clamp((y - g->y0) / g->dy, -1.0, (double)g->ny);
  const int i0 = cubic(sx, g->nx, wx, dx), j0 = cubic(sy, g->ny, wy, dy);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      const double value = height(g, within(i0 + i, g->nx), within(j0 + j, g->ny));
      z += wx[i] * wy[j] * value;
      slope[0] += dx[i] * wy[j] * value / g->dx;
      slope[1] += wx[i] * dy[j] * value / g->dy;
    }
  const double tx = ali3_clamp(sx - (i0 + 1), 0.0, 1.0), ty = ali3_clamp(sy - (j0 + 1), 0.0, 1.0);
  double m[2][2];
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) m[i][j] = friction(g, i0 + 1 + i, j0 + 1 + j);
  const double mu = (1.0 - tx) * ((1.0 - ty) * m[0][0] + ty * m[0][1]) + tx * ((1.0 - ty) * m[1][0] + ty * m[1][1]);
  const double size = sqrt(1.0 + slope[0] * slope[0] + slope[1] * slope[1]);
  const ali3_surface found = {z, {-slope[0] / size, -slope[1] / size, 1.0 / size}, mu};
  return found;
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
