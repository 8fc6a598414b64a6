/* A road that other programs answer for. */
#ifndef ALI3_ROAD_PORT_H
#define ALI3_ROAD_PORT_H
#include <stdbool.h>

#include "../roads/grid.h"
#include "road.h"

/* Inputs of an answer. */
enum { PORT_X, PORT_Y, PORT_HEIGHT, PORT_NORMAL, PORT_FRICTION = PORT_NORMAL + 3 };
/* Numbers of the road. */
enum { PORT_ANSWERS, PORT_FIRST };

/* Surface under a place; foot: a point of its plane. */
ali3_surface ali3_port_surface(const ali3_road *road, const double place[3], double foot[3]);
int ali3_port_contact(const ali3_road *road, const double centre[3], const double axis[3], double radius,
                      ali3_contact *out);
double ali3_port_top(const ali3_road *road, const double place[3], double reach);

/* Whether the road is at ports whose normals are all unit vectors that point up, or at none. */
bool ali3_port_normals(const ali3_road *road);
#endif
