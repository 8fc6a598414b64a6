/* Horizontal exit of a point below the surface of a grid road. Horizontal rays from the point are followed to where the
 * surface falls below it; the nearest such position is the foot, with the direction of the shortest ray refined. The
 * distance is continuous in the point and its gradient is the normal of the face, so that the contact is conservative.
 * It has a kink where two faces are equally distant: there the normal jumps from one to the other, the distance does
 * not. */
#include "grid_exit.h"

#include <math.h>

#include "../algebra/elementary.h"

/* Number of rays, most samples on a ray, bisections of a crossing, golden sections of the direction. The distance is
 * that of the tangent plane at the foot, so that errors of position and direction enter it in second order only. False
 * position takes as many instructions as bisection, which needs no more than bounds of most cells. */
enum { RAYS = 16, MAX_SAMPLES = 64, HALVINGS = 24, SECTIONS = 10 };

/* Whether the surface is below the height of the point at horizontal distance r along `direction`. */
static int is_outside(const ali3_grid *g, ali3_cell *cell, const double point[3], const double direction[2], double r) {
  return ali3_grid_is_below(g, cell, point[0] + r * direction[0], point[1] + r * direction[1], point[2]);
}

/* Distance along `direction` to the first position outside the surface, `reach` if there is none nearer. */
static double find_crossing(const ali3_grid *g, ali3_cell *cell, const double point[3], const double direction[2],
                            double step, double reach) {
  double in = 0.0, out = 0.0;
  do {
    in = out;
    out += step;
    if (!(in < reach)) return reach;
  } while (!is_outside(g, cell, point, direction, out));
  for (int i = 0; i < HALVINGS && in < reach; i++) {
    const double middle = 0.5 * (in + out);
    if (is_outside(g, cell, point, direction, middle))
      out = middle;
    else
      in = middle;
  }
  return fmin(out, reach);
}

/* `find_crossing` along the direction of an angle, rad. */
static double find_crossing_at(const ali3_grid *g, ali3_cell *cell, const double point[3], double angle, double step,
                               double reach) {
  const double direction[2] = {ali3_cos(angle), ali3_sin(angle)};
  return find_crossing(g, cell, point, direction, step, reach);
}

int ali3_grid_exit(const ali3_grid *g, const double point[3], double reach, double foot[2]) {
  const double step = fmax(0.5 * fmin(g->dx, g->dy), reach / MAX_SAMPLES),
               spacing = 2.0 * 3.14159265358979323846 / RAYS;
  double nearest = reach, best = 0.0;
  ali3_cell cell = {0};
  for (int k = 0; k < RAYS; k++) {
    const double r = find_crossing_at(g, &cell, point, spacing * k, step, nearest);
    if (r < nearest) nearest = r, best = spacing * k;
  }
  if (!(nearest < reach)) return 0;
  const double golden = 0.61803398874989485;
  double low = best - spacing, high = best + spacing, a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = find_crossing_at(g, &cell, point, a, step, reach),
         at_b = find_crossing_at(g, &cell, point, b, step, reach);
  for (int i = 0; i < SECTIONS; i++) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a, a = high - golden * (high - low);
      at_a = find_crossing_at(g, &cell, point, a, step, reach);
    } else {
      low = a, a = b, at_a = at_b, b = low + golden * (high - low);
      at_b = find_crossing_at(g, &cell, point, b, step, reach);
    }
  }
  const double r = fmin(at_a, at_b);
  if (r < nearest) nearest = r, best = at_a < at_b ? a : b;
  foot[0] = point[0] + nearest * ali3_cos(best);
  foot[1] = point[1] + nearest * ali3_sin(best);
  return 1;
}
