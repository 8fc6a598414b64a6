/* Shortest horizontal exit of a point below the surface of a grid. */
#ifndef ALI3_GRID_EXIT_H
#define ALI3_GRID_EXIT_H
#include "../roads/grid.h"

/* Writes the position of the face, x and y, that is nearest at the height of the point and nearer than `reach`, m;
 * returns whether there is one. */
int ali3_grid_exit(const ali3_grid *g, const double point[3], double reach, double foot[2]);
#endif
