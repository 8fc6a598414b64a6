/* A road that another program gives through inputs: a plane at each wheel, which the inputs call an answer. */
#ifndef ALI3_ROAD_PORT_H
#define ALI3_ROAD_PORT_H
#include <stdbool.h>

#include "../roads/grid.h"
#include "road.h"

/* Inputs of an answer: a point and its height, m, the unit normal, earth axes; friction. */
enum { PORT_X, PORT_Y, PORT_HEIGHT, PORT_NORMAL, PORT_FRICTION = PORT_NORMAL + 3 };
/* Reals of the road: number of answers, then the index of the first input of each. */
enum { PORT_ANSWERS, PORT_FIRST };

/* Surface under a place, m, earth axes; foot: a point of its plane. */
ali3_surface ali3_port_surface(const ali3_road *road, const double place[3], double foot[3]);
/* As ali3_road_contacts; always one contact. */
int ali3_port_contact(const ali3_road *road, const double centre[3], const double axis[3], double radius,
                      ali3_contact *out);
/* Upper bound of the height of the road, m, within the horizontal distance `reach`, m, of a place. */
double ali3_port_top(const ali3_road *road, const double place[3], double reach);

/* False if the road is at a port and a normal is not a unit vector that points up. */
bool ali3_port_normals(const ali3_road *road);
#endif
