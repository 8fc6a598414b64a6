/* Velocity of the air over the ground from inputs. */
#ifndef ALI3_MOVING_AIR_H
#define ALI3_MOVING_AIR_H
#include <stdint.h>

#include "../algebra/elementary.h"

/* Inputs: speed of the air, m/s, and the direction it moves to, rad from the x axis of the earth to the left. */
enum { AIR_SPEED, AIR_HEADING, AIR_INPUTS };

/* Velocity of a point relative to the air, m/s; `integer` holds the inputs of the air. */
static inline void ali3_relative_to_air(const double *input, const int32_t *integer, const double *velocity,
                                        double over[3]) {
  const double speed = input[integer[AIR_SPEED]], heading = input[integer[AIR_HEADING]];
  over[0] = velocity[0] - speed * ali3_cos(heading);
  over[1] = velocity[1] - speed * ali3_sin(heading);
  over[2] = velocity[2];
}
#endif
