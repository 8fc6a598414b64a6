/* Brake: elastoplastic friction torque between the spin of a wheel and its carrier.
 * f and g are orthonormal on the carrier with f x g along the axis, the rate Omega of the spin is absolute; the wheel
 * turns at w = Omega - (f' . g - g' . f)/2 on its carrier. -tau acts on the wheel, tau on the carrier. Inputs are
 * from 0 to 1; with the integer BY_SIZE the input of the pedal has no upper limit, as a torque or pressure. States:
 * wind-up z rad, z' rad/s.
 *
 * A spring and damper (k, c) in series with a slider: tau = k z + c z', z' = w while |tau| is below the bound, otherwise
 * tau is at the bound and z' = (tau - k z)/c. With z = a + h z'/2 (trapezoidal rule) and D = c + h k/2:
 *   tau = clamp(k a + D w), z' = (tau - k a)/D.
 * Slip power tau (w - z') = tau (k a + D w - tau)/D >= 0, and a sticking brake returns to its position: it does not
 * creep. */
#include "brake_fields.h"
#include "element.h"
#include "element_math.h"

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
  const real bound = find_friction_bound(a);
  const double half = 0.5 * a->h;
  const real elastic = p[STICK_STIFFNESS] * (a->y_old[0] + half * a->y_old[1]);
  const real D = p[STICK_DAMPING] + half * p[STICK_STIFFNESS], trial = elastic + D * w;
  const truth sticks = ali3_abs(trial) <= bound;
  const real torque = ali3_where(sticks, trial, ali3_where(trial > 0.0, bound, -bound));
  a->y_new[0] = a->y_old[0];
  a->y_new[1] = a->y_old[1];
  if (a->h > 0.0) {
    a->y_new[1] = (torque - elastic) / D;
    a->y_new[0] = (torque - p[STICK_DAMPING] * a->y_new[1]) / p[STICK_STIFFNESS];
    const truth released = ali3_abs(a->y_new[0]) < 1e-100; /* long after release: avoids denormals */
    for (int i = 0; i < 2; i++) a->y_new[i] = ali3_where(released, ali3_same(0.0), a->y_new[i]);
  }
  ali3_slider_piece(&a->piece, sticks, trial, bound);
  real b[7];
  for (int i = 0; i < 3; i++) b[i] = -0.5 * g[i], b[3 + i] = 0.5 * f[i];
  b[6] = ali3_same(1.0);
  for (int i = 0; i < 7; i++) a->f[i] = -torque * b[i];
  a->potential = 0.5 * p[STICK_STIFFNESS] * a->y_new[0] * a->y_new[0];
  a->out[0] = -torque;
  a->out[1] = ali3_where(sticks & (bound > 0.0), ali3_same(1.0), ali3_same(0.0));
  a->out[2] = w;
  a->out[3] = -torque * w;
  if (!a->S) return; /* the tangent is without the rotation of f, g within the step */
  const real slope = ali3_slider_slope(sticks, D, trial, bound, a->reach);
  ali3_add_outer(a->S, 7, a->wC * slope, b);
}

#ifndef ALI3_WIDTH
const ali3_element_type ali3_brake = {
    ALI3_BRAKE,
    .evaluate = evaluate,
};
#endif
