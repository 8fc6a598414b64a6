/* Level rays from the point are followed to where the surface falls below it; the nearest such place is the foot, with
 * the direction of the best ray refined. The distance is then continuous in the point and its gradient the normal of the
 * face, so that what a face takes up it also gives back. */
#include "way_out_of_grid.h"

#include <math.h>

#include "../algebra/elementary.h"

enum { RAYS = 16, MOST = 64, HALVINGS = 40, SECTIONS = 24 }; /* MOST: places that are looked at on a ray */

static int is_out(const ali3_grid *g, const double point[3], const double way[2], double r) {
  return ali3_grid_at(g, point[0] + r * way[0], point[1] + r * way[1]).height <= point[2];
}

/* Distance along a way to the first place out of the surface, `reach` where none is nearer. */
static double crossing(const ali3_grid *g, const double point[3], const double way[2], double step, double reach) {
  double in = 0.0, out = 0.0;
  do {
    in = out;
    out += step;
    if (!(in < reach)) return reach;
  } while (!is_out(g, point, way, out));
  for (int i = 0; i < HALVINGS; i++) {
    const double middle = 0.5 * (in + out);
    if (is_out(g, point, way, middle))
      out = middle;
    else
      in = middle;
  }
  return fmin(out, reach);
}

static double crossing_at(const ali3_grid *g, const double point[3], double angle, double step, double reach) {
  const double way[2] = {ali3_cos(angle), ali3_sin(angle)};
  return crossing(g, point, way, step, reach);
}

int ali3_way_out_of_grid(const ali3_grid *g, const double point[3], double reach, double foot[2]) {
  const double step = fmax(0.5 * fmin(g->dx, g->dy), reach / MOST), between = 2.0 * 3.14159265358979323846 / RAYS;
  double nearest = reach, best = 0.0;
  for (int k = 0; k < RAYS; k++) {
    const double r = crossing_at(g, point, between * k, step, nearest);
    if (r < nearest) nearest = r, best = between * k;
  }
  if (!(nearest < reach)) return 0;
  double low = best - between, high = best + between; /* golden sections */
  for (int i = 0; i < SECTIONS; i++) {
    const double part = 0.38196601125010515 * (high - low), a = low + part, b = high - part;
    if (crossing_at(g, point, a, step, reach) < crossing_at(g, point, b, step, reach))
      high = b;
    else
      low = a;
  }
  const double middle = 0.5 * (low + high), r = crossing_at(g, point, middle, step, reach);
  if (r < nearest) nearest = r, best = middle;
  foot[0] = point[0] + nearest * ali3_cos(best);
  foot[1] = point[1] + nearest * ali3_sin(best);
  return 1;
}
