/* Roads for laws that are evaluated for several discs at once: of several instances (../lanes/) or of one
 * (element_batches.h). */
#ifndef ALI3_LANE_ROAD_H
#define ALI3_LANE_ROAD_H
#include "../algebra/real.h"

enum { ALI3_MAX_LANES = 8 };

typedef struct ali3_lane_road {
  int32_t type; /* ALI3_ROAD_COUNT if the lanes have roads of several types */
  const struct ali3_road *lane[ALI3_MAX_LANES]; /* NULL: no road, no contact */
  real *numbers, *friction_factor; /* as written by ali3_road_numbers */
} ali3_lane_road;

/* The two contacts of ali3_road_contacts in each lane. */
void ali3_lane_contacts(const ali3_lane_road *road, int32_t width, const real *centre, const real *axis,
                        const real *radius, real *contacts);
#endif
