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

real ali3_tyre_bore_step(ali3_element_args *a, ali3_tyre_bore *b, const ali3_tyre_held *by) {
  const real c = b->numbers[ALI3_BORE_STIFFNESS], d = b->numbers[ALI3_BORE_DAMPING], none = {0}, one = ali3_same(1.0);
  const truth holds = by->most > 0.0, bends = by->force < by->steady;
  const real share = ali3_where(bends, by->force / by->steady, one), share2 = share * share;
  const real g = ali3_where(
      holds, by->slope * by->most / (by->transport * by->most + by->slip * share2 * share2 * by->slope), none);
  const real *old = a->y_old + ALI3_BORE_STATES, turning = b->lever * b->lever * g, full = b->lever * by->most,
             use = by->use;
  const real theta = ali3_theta(a->h, c / (d + turning)), offset = c * (old[0] + a->h * (1.0 - theta) * old[1]);
  const real D = d + a->h * theta * c, part = turning / (turning + D);
  b->moment = part * (offset - D * b->rate);
  b->C = part * D;
  const real turns = ali3_where(holds, b->moment / full, none), asked = ali3_sqrt(use * use + turns * turns);
  const truth slides = holds & (asked > 1.0);
  const real left = ali3_where(slides, 1.0 / asked, one);
  ALI3_PIECE(&a->piece, slides, ALI3_TYRE_AT_LIMIT);
  const real flat = (use * left) * (use * left); /* of the derivative, not below the safe share of the secant */
  b->C *= left *
          ali3_where(slides & (flat < ALI3_SECANT_SHARE), ali3_same(ALI3_SECANT_SHARE), ali3_where(slides, flat, one));
  b->moment *= left;
  real *new = a->y_new + ALI3_BORE_STATES;
  new[0] = old[0];
  new[1] = (b->moment - offset) / D;
  if (!(a->h > 0.0)) return left;
  new[0] = (b->moment - d * new[1]) / c;
  const truth gone = ali3_abs(new[0]) < 1e-100; /* long in the air: no denormals */
  for (int i = 0; i < 2; i++) new[i] = ali3_where(gone, none, new[i]);
  return left;
}
