/* A cell of a grid with the values that its patch depends on. */
#ifndef ALI3_ROAD_CELL_H
#define ALI3_ROAD_CELL_H

typedef struct { /* a point of a grid: height, its differences per spacing, their twist */
  double z, x, y, xy;
} ali3_grid_point;

typedef struct { /* values around a cell of one grid; {0}: no cell yet */
  int held, limited, bears, i, j; /* i, j: indices before its first corner; bears: frictions are read */
  double z[4][4], friction[2][2];
  double least, most; /* bounds of the heights of the cell */
  ali3_grid_point corner[2][2]; /* where slopes are limited */
} ali3_cell;
#endif
