/* Steps of the states of a drive's selector, and the factor on the torque. */
#include "selector.h"

#include "../algebra/small_vectors.h"

/* Position -1, 0 or 1 of an input or a state. */
static int position(double value) { return value > 0.5 ? 1 : value < -0.5 ? -1 : 0; }

int ali3_selector_step(const double *y_old, double *y_new, double input, double fraction, double *factor) {
  const int direction = position(y_old[ALI3_SELECTOR_DIRECTION]);
  const int unchanged = position(input) == direction;
  double engaged = ali3_clamp(y_old[ALI3_SELECTOR_ENGAGED], 0.0, 1.0);
  y_new[ALI3_SELECTOR_DIRECTION] = y_old[ALI3_SELECTOR_DIRECTION];
  y_new[ALI3_SELECTOR_ENGAGED] = y_old[ALI3_SELECTOR_ENGAGED];
  if (fraction > 0.0) { /* below 0: fraction of the step after the torque became 0 */
    engaged = direction == 0 ? 0.0 : unchanged ? ali3_clamp(engaged + fraction, 0.0, 1.0) : engaged - fraction;
    y_new[ALI3_SELECTOR_ENGAGED] = engaged;
  }
  const double x = ali3_clamp(engaged, 0.0, 1.0);
  *factor = direction == 0 ? 0.0 : x * x * (3.0 - 2.0 * x);
  return direction;
}

int ali3_selector_accept(double *y, double input, double wheel_rate, double engage_speed, int start) {
  const int requested = position(input), direction = position(y[ALI3_SELECTOR_DIRECTION]);
  const int allowed = requested * wheel_rate > -engage_speed || requested == 0;
  if (start) {
    y[ALI3_SELECTOR_DIRECTION] = allowed ? requested : 0.0;
    y[ALI3_SELECTOR_ENGAGED] = allowed && requested != 0 ? 1.0 : 0.0;
    return allowed && requested != 0;
  }
  if (requested == direction || (direction != 0 && y[ALI3_SELECTOR_ENGAGED] > 0.0)) return 0;
  y[ALI3_SELECTOR_DIRECTION] = allowed ? requested : 0.0;
  y[ALI3_SELECTOR_ENGAGED] = allowed && requested != 0 ? ali3_clamp(-y[ALI3_SELECTOR_ENGAGED], 0.0, 1.0) : 0.0;
  return allowed && requested != 0;
}
