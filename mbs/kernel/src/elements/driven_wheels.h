/* Two wheels that a drive turns against the frame that carries it. Signals: the spins of the left and of the right
 * wheel, whose rates are absolute about the axis f x g, then f and g, which are orthonormal on the frame. */
#ifndef ALI3_DRIVEN_WHEELS_H
#define ALI3_DRIVEN_WHEELS_H
#include "../algebra/small_vectors.h"
#include "element.h"

enum { ALI3_DRIVEN_SIGNALS = 8 };

/* Rate of the frame about the axis of the wheels, rad/s. */
static inline double ali3_frame_rate(const ali3_element_args *a) {
  return 0.5 * (ali3_dot(a->ud + 2, a->u + 5) - ali3_dot(a->ud + 5, a->u + 2));
}

/* Mean rate of both wheels relative to the frame, rad/s. */
static inline double ali3_wheel_rate(const ali3_element_args *a) {
  return 0.5 * (a->ud[0] + a->ud[1]) - ali3_frame_rate(a);
}

/* Applies a torque, N m, half of it to each wheel, and its reaction to the frame; slope: its derivative by the mean
 * rate, N m s/rad. The tangent is without the rotation of f, g within the step. */
static inline void ali3_drive_wheels(ali3_element_args *a, double torque, double slope) {
  double b[ALI3_DRIVEN_SIGNALS] = {0.5, 0.5}; /* the mean relative rate is b . ud */
  for (int i = 0; i < 3; i++) b[2 + i] = -0.5 * a->u[5 + i], b[5 + i] = 0.5 * a->u[2 + i];
  for (int i = 0; i < ALI3_DRIVEN_SIGNALS; i++) a->f[i] = torque * b[i];
  if (a->S && slope < 0.0) ali3_add_outer(a->S, ALI3_DRIVEN_SIGNALS, -a->wC * slope, b);
}
#endif
