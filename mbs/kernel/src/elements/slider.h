/* A spring k and a damper c in series with a slider of Coulomb friction, as of a brake. States: deflection z, z'.
 *
 * tau = k z + c z', z' = w while |tau| is below the bound, else tau is at the bound and z' = (tau - k z)/c. With z = a
 * + h z'/2 (trapezoidal rule) and D = c + h k/2:
 *   tau = clamp(k a + D w), z' = (tau - k a)/D.
 * Slip power tau (w - z') = tau (k a + D w - tau)/D >= 0, and what sticks returns to its position: it does not
 * creep. */
#ifndef ALI3_SLIDER_H
#define ALI3_SLIDER_H
#include "element.h"
#include "element_math.h"

/* Pieces of the law: it sticks, or slips in one direction; none without friction. */
enum { ALI3_STICKS = 1, ALI3_SLIPS_UP = 2, ALI3_SLIPS_DOWN = 4 };

typedef struct {
  real force; /* tau */
  real slope; /* d tau/dw for the tangent: D, or, where it slips, the safe part of the secant or 0 */
  lane_mask sticks; /* it sticks, and there is a bound */
} ali3_slider;

/* Slope of a slider that slips: the safe part of the secant, zero if the rate cannot return to sticking in this
 * step. */
static inline real ali3_slip_slope(real D, real trial, real bound, real reach) {
  const real size = ali3_abs(trial), none = {0};
  const lane_mask stays = (reach > 0.0) & (size - bound > D * reach);
  return ali3_where(stays, none, ALI3_SECANT_FRACTION * D * (bound / size));
}

/* One step at the rate w: writes the states, which are the first two of the element, its potential and its piece. */
static inline ali3_slider ali3_slider_step(ali3_element_args *a, real k, real c, real bound, real w) {
  const double half = 0.5 * a->h;
  const real elastic = k * (a->y_old[0] + half * a->y_old[1]);
  const real D = c + half * k, trial = elastic + D * w;
  const lane_mask sticks = ali3_abs(trial) <= bound, holds = bound > 0.0, slips = holds & ali3_not(sticks);
  const real force = ali3_where(sticks, trial, ali3_where(trial > 0.0, bound, -bound));
  a->y_new[0] = a->y_old[0];
  a->y_new[1] = a->y_old[1];
  if (a->h > 0.0) {
    a->y_new[1] = (force - elastic) / D;
    a->y_new[0] = (force - c * a->y_new[1]) / k;
    const lane_mask released = ali3_abs(a->y_new[0]) < ALI3_NEGLIGIBLE;
    for (int i = 0; i < 2; i++) a->y_new[i] = ali3_where(released, ali3_same(0.0), a->y_new[i]);
  }
  a->potential = 0.5 * k * a->y_new[0] * a->y_new[0];
  ALI3_PIECE(&a->piece, holds & sticks, ALI3_STICKS);
  ALI3_PIECE(&a->piece, slips & (trial > 0.0), ALI3_SLIPS_UP);
  ALI3_PIECE(&a->piece, slips & ali3_not(trial > 0.0), ALI3_SLIPS_DOWN);
  return (ali3_slider){.force = force,
                       .slope = ali3_where(sticks, D, ali3_slip_slope(D, trial, bound, a->reach)),
                       .sticks = holds & sticks};
}
#endif
