/* A cell of a grid with all that its patch is made of. */
#ifndef ALI3_ROAD_CELL_H
#define ALI3_ROAD_CELL_H

typedef struct { /* a point of a grid: height, its differences per spacing, their twist */
  double z, x, y, xy;
} ali3_grid_point;

typedef struct { /* what lies around a cell of one grid; {0} before the first */
  int held, limited, bears, i, j; /* indices before its first corner; bears: its frictions are there */
  double z[4][4], friction[2][2];
  double least, most; /* no height between the corners is outside */
  ali3_grid_point corner[2][2]; /* where slopes are limited */
} ali3_cell;
#endif
