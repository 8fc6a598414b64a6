/* A road that another program gives through inputs; positions in the earth frame, m. */
#ifndef ALI3_ROAD_PORT_H
#define ALI3_ROAD_PORT_H
#include <stdbool.h>

#include "../roads/grid.h"
#include "road.h"

/* Inputs of an answer, the plane of the road near a point: point x, y, height there, unit normal (3), friction. */
enum { PORT_X, PORT_Y, PORT_HEIGHT, PORT_NORMAL, PORT_FRICTION = PORT_NORMAL + 3 };
/* Numbers of the road: number of answers; index of the first input of each. */
enum { PORT_ANSWERS, PORT_FIRST };

/* Surface below a position; foot: a point of its plane. */
ali3_surface ali3_port_surface(const ali3_road *road, const double place[3], double foot[3]);
/* Writes the contact of a disc, as ali3_road_contacts; returns 1. */
int ali3_port_contact(const ali3_road *road, const double centre[3], const double axis[3], double radius,
                      ali3_contact *out);
/* Upper bound of the height within the horizontal distance `reach` of a position. */
double ali3_port_top(const ali3_road *road, const double place[3], double reach);

/* False if the road is at ports and a normal is not a unit vector that points up. */
bool ali3_port_normals(const ali3_road *road);
#endif
