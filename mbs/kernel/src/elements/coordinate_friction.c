/* Coulomb friction on one signal, elastoplastic: a spring and a damper in series with a slider, as in brake.c.
 * States: deflection z, z'. The force on the signal u is -tau.
 *
 * tau = k z + c z', z' = u' while |tau| is below the bound, otherwise tau is at the bound and z' = (tau - k z)/c.
 * Trapezoidal rule for z, in closed form: see brake.c. */
#include "coordinate_friction_fields.h"
#include "element.h"
#include "element_math.h"

static void evaluate(ali3_element_args *a) {
  const double *p = a->real, half = 0.5 * a->h;
  const double elastic = p[STICK_STIFFNESS] * (a->y_old[0] + half * a->y_old[1]);
  const double D = p[STICK_DAMPING] + half * p[STICK_STIFFNESS], trial = elastic + D * a->ud[0];
  const int sticks = fabs(trial) <= p[LARGEST];
  const double force = sticks ? trial : trial > 0.0 ? p[LARGEST] : -p[LARGEST];
  a->y_new[0] = a->y_old[0];
  a->y_new[1] = a->y_old[1];
  if (a->h > 0.0) {
    a->y_new[1] = (force - elastic) / D;
    a->y_new[0] = (force - p[STICK_DAMPING] * a->y_new[1]) / p[STICK_STIFFNESS];
    if (fabs(a->y_new[0]) < 1e-100) a->y_new[0] = a->y_new[1] = 0.0; /* no denormals */
  }
  a->f[0] = -force;
  ali3_slider_piece(&a->piece, sticks, trial, p[LARGEST]);
  a->potential = 0.5 * p[STICK_STIFFNESS] * a->y_new[0] * a->y_new[0];
  a->out[0] = -force;
  a->out[1] = sticks && p[LARGEST] > 0.0;
  if (a->S) a->S[0] = a->wC * ali3_slider_slope(sticks, D, trial, p[LARGEST], a->reach);
}

const ali3_element_type ali3_coordinate_friction = {
    ALI3_COORDINATE_FRICTION,
    .evaluate = evaluate,
};
