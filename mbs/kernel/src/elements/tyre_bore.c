/* Bore torque of a tyre with the state of its torsion spring. */
#include "tyre_bore.h"

#include "element_math.h"
#include "tyre_contact.h"

ali3_tyre_bore ali3_tyre_bore_at(const ali3_element_args *a, const real *numbers, const real normal[3], const real e[3],
                                 real length) {
  ali3_tyre_bore b = {.numbers = numbers, .lever = (length + numbers[ALI3_BORE_WIDTH]) / 6.0};
  ali3_cross(normal, e, b.row + 3);
  b.row[6] = ali3_dot(normal, e);
  for (int i = 3; i < 7; i++) b.rate += b.row[i] * a->ud[i];
  return b;
}

/* Secant damping g of the rotation over R^2, N s/m; `by`: horizontal force. */
static real find_bore_damping(const ali3_tyre_horizontal_force *by) {
  const real none = {0};
  const lane_mask grips = by->most > 0.0, sticks = by->force < by->steady;
  const real share = ali3_where(sticks, by->force / by->steady, ali3_same(1.0)), share2 = share * share;
  return ali3_where(grips, by->slope * by->most / (by->transport * by->most + by->slip * share2 * share2 * by->slope),
                    none);
}

/* Scales moment and derivative to the friction that force and moment share; returns the factor on the force. */
static real share_friction(ali3_element_args *a, ali3_tyre_bore *b, const ali3_tyre_horizontal_force *by) {
  const real none = {0}, one = ali3_same(1.0), max_torque = b->lever * by->most, use = by->use;
  const lane_mask grips = by->most > 0.0;
  const real torque_share = ali3_where(grips, b->moment / max_torque, none),
             demand = ali3_sqrt(use * use + torque_share * torque_share);
  const lane_mask slides = grips & (demand > 1.0);
  const real remaining = ali3_where(slides, 1.0 / demand, one);
  ALI3_PIECE(&a->piece, slides, ALI3_TYRE_AT_LIMIT);
  /* factor on the derivative, not below the safe part of the secant */
  const real factor = (use * remaining) * (use * remaining);
  b->C *= remaining * ali3_where(slides & (factor < ALI3_SECANT_FRACTION), ali3_same(ALI3_SECANT_FRACTION),
                                 ali3_where(slides, factor, one));
  b->moment *= remaining;
  return remaining;
}

void ali3_tyre_bore_step(ali3_element_args *a, ali3_tyre_bore *b, const ali3_tyre_horizontal_force *by,
                         ali3_tyre_force *force) {
  const real c = b->numbers[ALI3_BORE_STIFFNESS], d = b->numbers[ALI3_BORE_DAMPING], none = {0};
  const real *old = a->y_old + ALI3_BORE_STATES, damping = b->lever * b->lever * find_bore_damping(by);
  const real theta = ali3_theta(a->h, c / (d + damping)), offset = c * (old[0] + a->h * (1.0 - theta) * old[1]);
  const real D = d + a->h * theta * c, fraction = damping / (damping + D);
  b->moment = fraction * (offset - D * b->rate);
  b->C = fraction * D;
  const real remaining = share_friction(a, b, by);
  for (int i = 0; i < 2; i++) {
    force->F[i] *= remaining;
    force->safe[i] *= remaining;
    for (int j = 0; j < 2; j++) force->J[i][j] *= remaining;
  }
  real *new = a->y_new + ALI3_BORE_STATES;
  new[0] = old[0];
  new[1] = (b->moment - offset) / D;
  if (!(a->h > 0.0)) return;
  new[0] = (b->moment - d * new[1]) / c;
  const lane_mask negligible = ali3_abs(new[0]) < ALI3_NEGLIGIBLE; /* after a long time in the air */
  for (int i = 0; i < 2; i++) new[i] = ali3_where(negligible, none, new[i]);
}

real ali3_tyre_bore_energy(const ali3_element_args *a, const ali3_tyre_bore *b) {
  const real twist = a->y_new[ALI3_BORE_STATES];
  return 0.5 * b->numbers[ALI3_BORE_STIFFNESS] * twist * twist;
}
