/* A start in motion that is held while the rest settles: what is held, and the scene put back to it. */
#ifndef ALI3_SETTLED_START_H
#define ALI3_SETTLED_START_H
#include "../instance.h"

/* Coordinates along x of the heaviest point and of the heaviest direction; their place, velocity, direction, rate. */
typedef struct {
  int32_t point, axis;
  double place[2], velocity[2], direction[2], rate;
} ali3_held_motion;

bool ali3_hold(ali3_instance *in, ali3_held_motion *held); /* false: no body has a point and a direction of its own */
double ali3_heading_change(const ali3_instance *in, const ali3_held_motion *held); /* sine of the angle to the left */
void ali3_follow_slope(ali3_instance *in, const ali3_held_motion *held); /* the velocity of a start: along the road */
/* `kept`: the share of the velocity beside the held one that stays. */
void ali3_put_back(ali3_instance *in, const ali3_held_motion *held, double kept);
double ali3_kept_velocity(const ali3_held_motion *held, double h, double done); /* done: share of the settling */
/* m/s beside the held motion, or at which the road comes to parts unevenly in it */
double ali3_unsettled_speed(ali3_instance *in, const ali3_held_motion *held);
#endif
