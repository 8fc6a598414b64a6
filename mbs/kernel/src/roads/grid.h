/* Heights and frictions on a regular grid: C1 bicubic and bilinear interpolation; constant beyond the border. */
#ifndef ALI3_ROAD_GRID_H
#define ALI3_ROAD_GRID_H
#include <stdint.h>

#include "road_file.h"

typedef struct { /* values in memory, y fastest, or in the tiles of a file */
  int32_t nx, ny;
  double x0, y0, dx, dy; /* m: first point, spacing; earth axes */
  const double *z, *mu; /* nx * ny: heights, m; frictions; NULL with a file */
  ali3_road_file *file; /* NULL: values in memory */
} ali3_grid;

typedef struct {
  double height, normal[3], friction; /* m; unit, upwards, earth axes */
} ali3_surface;

/* The surface at x, y, m. */
ali3_surface ali3_grid_at(const ali3_grid *g, double x, double y);
/* The same for successive points in few cells, whose values are read once. */
ali3_surface ali3_grid_near(const ali3_grid *g, ali3_cell *cell, double x, double y);
/* Only its height, m. */
double ali3_grid_height(const ali3_grid *g, ali3_cell *cell, double x, double y);
/* 1 if the surface at a point is not above z, m, otherwise 0. */
int ali3_grid_is_below(const ali3_grid *g, ali3_cell *cell, double x, double y, double z);
/* Height of the bilinear interpolation, m. */
double ali3_grid_chord(const ali3_grid *g, double x, double y);
/* Upper bound of the heights, m, within the horizontal distance `reach`, m, of a place; infinite where that takes too
 * many points. */
double ali3_grid_top(const ali3_grid *g, const double place[3], double reach);
#endif
