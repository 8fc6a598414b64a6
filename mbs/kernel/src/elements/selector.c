/* Rates of the states of a drive's selector, and the share of the torque that it passes on. */
#include "selector.h"

#include "../algebra/small_vectors.h"

int ali3_selector_position(double value) { return value > 0.5 ? 1 : value < -0.5 ? -1 : 0; }

int ali3_selector_step(const double *y_old, double *y_new, double input, double part, double *share) {
  const int direction = ali3_selector_position(y_old[ALI3_SELECTOR_DIRECTION]);
  const int stays = ali3_selector_position(input) == direction;
  double engaged = ali3_clamp(y_old[ALI3_SELECTOR_ENGAGED], 0.0, 1.0);
  y_new[ALI3_SELECTOR_DIRECTION] = y_old[ALI3_SELECTOR_DIRECTION];
  y_new[ALI3_SELECTOR_ENGAGED] = y_old[ALI3_SELECTOR_ENGAGED];
  if (part > 0.0) { /* below 0: by how much the step went on after the torque had faded */
    engaged = direction == 0 ? 0.0 : stays ? ali3_clamp(engaged + part, 0.0, 1.0) : engaged - part;
    y_new[ALI3_SELECTOR_ENGAGED] = engaged;
  }
  const double x = ali3_clamp(engaged, 0.0, 1.0);
  *share = direction == 0 ? 0.0 : x * x * (3.0 - 2.0 * x);
  return direction;
}

int ali3_selector_accept(double *y, double input, double wheel_rate, double engage_speed, int start) {
  const int wanted = ali3_selector_position(input), direction = ali3_selector_position(y[ALI3_SELECTOR_DIRECTION]);
  const int allowed = wanted * wheel_rate > -engage_speed || wanted == 0;
  if (start) {
    y[ALI3_SELECTOR_DIRECTION] = allowed ? wanted : 0.0;
    y[ALI3_SELECTOR_ENGAGED] = allowed && wanted != 0 ? 1.0 : 0.0;
    return allowed && wanted != 0;
  }
  if (wanted == direction || (direction != 0 && y[ALI3_SELECTOR_ENGAGED] > 0.0)) return 0;
  y[ALI3_SELECTOR_DIRECTION] = allowed ? wanted : 0.0;
  y[ALI3_SELECTOR_ENGAGED] = allowed && wanted != 0 ? ali3_clamp(-y[ALI3_SELECTOR_ENGAGED], 0.0, 1.0) : 0.0;
  return allowed && wanted != 0;
}
