/* A start in motion, held until the rest has settled. */
#ifndef ALI3_SETTLED_START_H
#define ALI3_SETTLED_START_H
#include "../instance.h"

/* Motion of a scene along the ground, in earth axes. */
typedef struct {
  int32_t point, axis; /* coordinates that are the x components of the heaviest point and of the heaviest direction */
  double place[2], velocity[2]; /* of the point, x and y: m, m/s */
  double direction[2], rate; /* of the direction: unit vector along the ground, x and y; yaw rate, rad/s */
} ali3_held_motion;

/* Measures the motion; false: no body has a point and a direction of its own. */
bool ali3_measure_held_motion(ali3_instance *in, ali3_held_motion *held);
/* Sine of the change of heading, positive to the left. */
double ali3_heading_change(const ali3_instance *in, const ali3_held_motion *held);
/* Adds the vertical velocity that follows the road. */
void ali3_follow_slope(ali3_instance *in, const ali3_held_motion *held);
/* Moves the scene back to the held motion; kept_velocity: factor on the difference of velocities. */
void ali3_restore_motion(ali3_instance *in, const ali3_held_motion *held, double kept_velocity);
/* Factor, 0 to 1, that ali3_restore_motion applies after a step of h, s; `progress`: fraction of the settling time. */
double ali3_velocity_factor(const ali3_held_motion *held, double h, double progress);
/* Largest deviation of a velocity from the held motion, or of climb rates of the contacts in it, m/s. */
double ali3_unsettled_speed(ali3_instance *in, const ali3_held_motion *held);
#endif
