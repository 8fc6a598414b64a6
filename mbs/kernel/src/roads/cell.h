/* A cell of a grid with the values that its patch depends on. */
#ifndef ALI3_ROAD_CELL_H
#define ALI3_ROAD_CELL_H

typedef struct { /* a point of a grid, m: height, its differences per spacing in x and y, and their mixed difference */
  double z, x, y, xy;
} ali3_grid_point;

typedef struct { /* values around a cell of one grid; {0}: none */
  int held, limited, bears, i, j; /* i, j: indices before its first corner; bears: frictions are read */
  double z[4][4], friction[2][2]; /* m, [i in x][j in y] */
  double least, most; /* m: bounds of the heights of the cell */
  ali3_grid_point corner[2][2]; /* where slopes are limited */
} ali3_cell;
#endif
