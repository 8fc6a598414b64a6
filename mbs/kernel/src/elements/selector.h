/* The selector of a drive: R, N or D from an input of -1, 0 or 1, with two states: the direction engaged (-1, 0, 1) and
 * how far it is engaged, 0 to 1.
 * When the selector leaves a direction, the torque fades out in the engage time; then the new direction fades in, but
 * only if the wheels do not turn against it faster than the engage speed: until then the drive is in neutral. */
#ifndef ALI3_SELECTOR_H
#define ALI3_SELECTOR_H

enum { ALI3_SELECTOR_DIRECTION, ALI3_SELECTOR_ENGAGED, ALI3_SELECTOR_STATES };

/* -1, 0 or 1 from an input or a state. */
int ali3_selector_position(double value);

/* States at the end of a step that takes the part h / (engage time) of a change; returns the direction, and in *share
 * the factor of its torque, 0 to 1. */
int ali3_selector_step(const double *y_old, double *y_new, double input, double part, double *share);

/* Change of direction between two steps, at the wheel rate at the end; at a start (h = 0) it is engaged at once.
 * Returns 1 if a direction is newly engaged. */
int ali3_selector_accept(double *y, double input, double wheel_rate, double engage_speed, int start);
#endif
