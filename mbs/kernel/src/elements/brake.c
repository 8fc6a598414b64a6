/* Brake: elastoplastic friction torque between the spin of a wheel and its carrier.
 * f and g are orthonormal on the carrier with f x g along the axis, the rate Omega of the spin is absolute; the wheel
 * turns at w = Omega - (f' . g - g' . f)/2 on its carrier. -tau acts on the wheel, tau on the carrier. Inputs are
 * from 0 to 1; with the integer BY_SIZE the input of the pedal has no upper limit, as a torque or pressure. States:
 * wind-up z rad, z' rad/s.
 *
 * tau is the force of slider.h at the rate w. */
#include "brake_fields.h"
#include "element.h"
#include "element_math.h"
#include "slider.h"

/* Largest friction torque by pedal and hand brake. */
static real find_friction_bound(const ali3_element_args *a) {
  const real none = {0}, one = ali3_same(1.0);
  const real max_pedal = a->nint > BY_SIZE && a->integer[BY_SIZE] ? ali3_same(INFINITY) : one;
  const real *p = a->real, pedal = ali3_clamp(a->input[a->integer[PEDAL]], none, max_pedal);
  const real hand = ali3_clamp(ali3_input_or_zero(a->input, a->integer[HAND]), none, one);
  return p[MAX_TORQUE] * p[SHARE] * p[SIDE] * pedal + p[HAND_TORQUE] * hand;
}

static void evaluate(ali3_element_args *a) {
  const real *p = a->real, *f = a->u, *g = a->u + 3, *fd = a->ud, *gd = a->ud + 3;
  const real w = a->ud[6] - 0.5 * (ali3_dot(fd, g) - ali3_dot(gd, f));
  const ali3_slider slider = ali3_slider_step(a, p[STICK_STIFFNESS], p[STICK_DAMPING], find_friction_bound(a), w);
  const real torque = slider.force;
  real b[7];
  for (int i = 0; i < 3; i++) b[i] = -0.5 * g[i], b[3 + i] = 0.5 * f[i];
  b[6] = ali3_same(1.0);
  for (int i = 0; i < 7; i++) a->f[i] = -torque * b[i];
  a->out[BRAKE_OUT_TORQUE] = -torque;
  a->out[BRAKE_OUT_STICKING] = ali3_where(slider.sticks, ali3_same(1.0), ali3_same(0.0));
  a->out[BRAKE_OUT_RATE] = w;
  a->out[BRAKE_OUT_POWER] = -torque * w;
  if (a->S) ali3_add_outer(a->S, 7, a->wC * slider.slope, b); /* without the rotation of f, g within the step */
}

#ifndef ALI3_WIDTH
const ali3_element_type ali3_brake = {
    ALI3_BRAKE,
    .evaluate = evaluate,
};
#endif
