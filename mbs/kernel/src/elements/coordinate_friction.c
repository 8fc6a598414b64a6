/* Coulomb friction on one signal, elastoplastic: a spring and a damper in series with a slider, as in brake.c.
 * Signals: u. Reals: largest force (N or N m), stick stiffness, stick damping. States: deflection z, z'.
 * Outputs: force on the coordinate, 1 while sticking.
 *
 * tau = k z + c z', z' = u' while |tau| is below the bound, else tau is at the bound and z' = (tau - k z)/c. Trapezoidal
 * rule for z, in closed form: see brake.c. */
#include "element.h"
#include "element_math.h"

enum { LARGEST, STIFFNESS, DAMPING, REALS };

static void evaluate(ali3_element_args *a) {
  const double *p = a->real, half = 0.5 * a->h;
  const double wound = p[STIFFNESS] * (a->y_old[0] + half * a->y_old[1]);
  const double D = p[DAMPING] + half * p[STIFFNESS], trial = wound + D * a->ud[0];
  const int sticks = fabs(trial) <= p[LARGEST];
  const double force = sticks ? trial : trial > 0.0 ? p[LARGEST] : -p[LARGEST];
  a->y_new[0] = a->y_old[0];
  a->y_new[1] = a->y_old[1];
  if (a->h > 0.0) {
    a->y_new[1] = (force - wound) / D;
    a->y_new[0] = (force - p[DAMPING] * a->y_new[1]) / p[STIFFNESS];
    if (fabs(a->y_new[0]) < 1e-100) a->y_new[0] = a->y_new[1] = 0.0; /* no denormals */
  }
  a->f[0] = -force;
  ali3_slider_piece(&a->piece, sticks, trial, p[LARGEST]);
  a->potential = 0.5 * p[STIFFNESS] * a->y_new[0] * a->y_new[0];
  a->out[0] = -force;
  a->out[1] = sticks && p[LARGEST] > 0.0;
  if (a->S) a->S[0] = a->wC * ali3_slider_slope(sticks, D, trial, p[LARGEST], a->reach);
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)nsig, (void)nreal, (void)integer, (void)nint, (void)n_inputs, (void)n_roads;
  if (real[LARGEST] < 0.0) return "the largest force of a friction must not be negative";
  if (!(real[STIFFNESS] > 0.0 && real[DAMPING] > 0.0))
    return "stick stiffness and damping of a friction must be positive";
  return 0;
}

const ali3_element_type ali3_coordinate_friction = {
    .evaluate = evaluate,
    .nsig = 1,
    .nreal = REALS,
    .nstate = 2,
    .nout = 2,
    .check = check,
};
