/* Contacts of a disc with a grid. */
#ifndef ALI3_DISC_ON_GRID_H
#define ALI3_DISC_ON_GRID_H
#include "../roads/grid.h"
#include "road.h"

/* Writes the deepest contact, or two of nearly equal depth that share their load. Returns their number. */
int ali3_disc_on_grid(const ali3_grid *g, const double centre[3], const double axis[3], double radius,
                      ali3_contact out[2]);
#endif
