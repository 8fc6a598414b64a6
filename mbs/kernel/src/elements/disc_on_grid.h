/* Contacts of a wheel, taken as a disc, with a grid of heights; m, earth axes. */
#ifndef ALI3_DISC_ON_GRID_H
#define ALI3_DISC_ON_GRID_H
#include "../roads/grid.h"
#include "road.h"

/* Writes the deepest contact, or two of nearly equal depth that share their load. `axis`: unit vector of the disc's
 * axis. Returns their number. */
int ali3_disc_on_grid(const ali3_grid *g, const double centre[3], const double axis[3], double radius,
                      ali3_contact out[2]);
#endif
