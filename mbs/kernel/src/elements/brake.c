/* Brake: elastoplastic friction torque between a wheel's spin and its carrier.
 * Signals: f (3), g (3) orthonormal on the carrier with f x g along the axis, chi with chi' = Omega the absolute rate
 * about it.
 * Reals: largest torque N m, stick stiffness N m/rad, stick damping N m s/rad; then the share of the torque that is this
 * wheel's and the largest torque of the hand brake N m, or none. Integers: input (0..1); that of the hand brake or -1,
 * where there are five reals; then 1 where the input is not a pedal but any size that is not negative, as a torque or a
 * pressure, or none. States: wind-up z rad, z' rad/s.
 * Outputs: torque on the wheel N m, 1 while sticking, relative rate w rad/s, power of the torque W.
 *
 * A spring and damper (k, c) in series with a slider: tau = k z + c z', z' = w while |tau| is below the bound, else
 * tau is at the bound and z' = (tau - k z)/c. With z = a + h z'/2 (trapezoidal rule) and D = c + h k/2:
 * tau = clamp(k a + D w), z' = (tau - k a)/D.
 * Slip power tau (w - z') = tau (k a + D w - tau)/D >= 0, and a sticking brake returns to where it was: it does not
 * creep. */
#include "element.h"
#include "element_math.h"

enum { MAX_TORQUE, STIFFNESS, DAMPING, PLAIN, SHARE = PLAIN, HAND_TORQUE, REALS };
enum { PEDAL, HAND, PEDALS, BY_SIZE = PEDALS, INTEGERS };

/* What the pads can hold: both pedals press them. */
static double capacity(const ali3_element_args *a) {
  const double most = a->nint == INTEGERS && a->integer[BY_SIZE] ? INFINITY : 1.0;
  const double *p = a->real, pedal = ali3_clamp(a->input[a->integer[PEDAL]], 0.0, most);
  if (a->nreal == PLAIN) return p[MAX_TORQUE] * pedal;
  const double hand = ali3_clamp(ali3_input_or_zero(a->input, a->integer[HAND]), 0.0, 1.0);
  return p[MAX_TORQUE] * p[SHARE] * pedal + p[HAND_TORQUE] * hand;
}

static void evaluate(ali3_element_args *a) {
  const double *p = a->real, *f = a->u, *g = a->u + 3, *fd = a->ud, *gd = a->ud + 3;
  const double w = a->ud[6] - 0.5 * (ali3_dot(fd, g) - ali3_dot(gd, f));
  const double bound = capacity(a);
  const double half = 0.5 * a->h, wound = p[STIFFNESS] * (a->y_old[0] + half * a->y_old[1]);
  const double D = p[DAMPING] + half * p[STIFFNESS], trial = wound + D * w;
  const int sticks = fabs(trial) <= bound;
  const double torque = sticks ? trial : trial > 0.0 ? bound : -bound;
  a->y_new[0] = a->y_old[0];
  a->y_new[1] = a->y_old[1];
  if (a->h > 0.0) {
    a->y_new[1] = (torque - wound) / D;
    a->y_new[0] = (torque - p[DAMPING] * a->y_new[1]) / p[STIFFNESS];
    if (fabs(a->y_new[0]) < 1e-100) a->y_new[0] = a->y_new[1] = 0.0; /* long released: no denormals */
  }
  a->piece = ali3_slider_piece(sticks, trial, bound);
  double b[7];
  for (int i = 0; i < 3; i++) b[i] = -0.5 * g[i], b[3 + i] = 0.5 * f[i];
  b[6] = 1.0;
  for (int i = 0; i < 7; i++) a->f[i] = -torque * b[i];
  a->potential = 0.5 * p[STIFFNESS] * a->y_new[0] * a->y_new[0];
  a->out[0] = -torque;
  a->out[1] = sticks && bound > 0.0;
  a->out[2] = w;
  a->out[3] = -torque * w;
  if (!a->S) return; /* turning of f, g within the step is left out of the tangent */
  const double slope = sticks ? D : ALI3_SECANT_SHARE * D * (bound / fabs(trial));
  ali3_add_outer(a->S, 7, a->wC * slope, b);
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)nsig, (void)n_roads;
  if (!(nreal == PLAIN && nint == 1) && !(nreal == REALS && (nint == PEDALS || nint == INTEGERS)))
    return "a brake has 3 numbers and an input, or 5 and two inputs, and may say that the first is no pedal";
  if (integer[PEDAL] < 0 || integer[PEDAL] >= n_inputs ||
      (nint > 1 && (integer[HAND] < -1 || integer[HAND] >= n_inputs)))
    return "a brake names an input that does not exist";
  if (nint == INTEGERS && integer[BY_SIZE] != 0 && integer[BY_SIZE] != 1)
    return "whether the input of a brake is no pedal must be 0 or 1";
  if (nreal == REALS && (real[SHARE] < 0.0 || real[HAND_TORQUE] < 0.0))
    return "the share and the torque of the hand brake of a brake must not be negative";
  if (real[MAX_TORQUE] < 0.0) return "the largest torque of a brake must not be negative";
  if (!(real[STIFFNESS] > 0.0 && real[DAMPING] > 0.0)) return "stick stiffness and damping of a brake must be positive";
  return 0;
}

const ali3_element_type ali3_brake = {
    .evaluate = evaluate,
    .nsig = 7,
    .nreal = -1,
    .nint = -1,
    .nstate = 2,
    .nout = 4,
    .check = check,
};
