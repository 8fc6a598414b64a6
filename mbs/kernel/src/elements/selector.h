/* Selector of a drive: R, N or D for an input of -1, 0 or 1. Two states: engaged direction (-1, 0, 1) and its
 * engagement, 0 to 1.
 * When the input leaves the engaged direction, the torque decreases to 0 within the engage time; then it increases in
 * the new direction, but only if the wheels do not rotate against it faster than the engage speed. Until then the drive
 * is in neutral. */
#ifndef ALI3_SELECTOR_H
#define ALI3_SELECTOR_H

enum { ALI3_SELECTOR_DIRECTION, ALI3_SELECTOR_ENGAGED, ALI3_SELECTOR_STATES };

/* States after a step; fraction: step size / engage time. Returns the direction; *factor: on its torque, 0 to 1. */
int ali3_selector_step(const double *y_old, double *y_new, double input, double fraction, double *factor);

/* Changes the direction between two steps, at the wheel rate at the end of the step; at a start (h = 0) it is engaged
 * at once. Returns 1 if a direction becomes engaged. */
int ali3_selector_accept(double *y, double input, double wheel_rate, double engage_speed, int start);
#endif
