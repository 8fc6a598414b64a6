/* Angles that turn with more than what they measure: those with an armature, and those that a gear, rack or screw ties
 * to other coordinates. The trapezoidal rule turns a body by 2 atan(rate h/2) and takes an angle by rate h. With the
 * rates of both alike, wheels of unequal rates miss the ratio of their gear by unequal shares, and in each step the row
 * takes the difference as a force, which brings energy. So the rows of these angles are open at rates by what leaves no
 * difference. */
#ifndef ALI3_TURNING_H
#define ALI3_TURNING_H
#include "../algebra/elementary.h"
#include "driving_terms.h"

/* Phi_q qd of an angle's row. */
static inline real angle_rate(const ali3_system *S, int32_t i, const real *q, const real *qd) {
  const real theta = q[S->angle_theta_col[i]], cosine = ali3_cos(theta), sine = ali3_sin(theta);
  real vectors = {0}, length = {0};
  for (int32_t t = S->angle_ptr[i]; t < S->angle_ptr[i + 1]; t++) {
    const ali3_angle_term *x = &S->angle[t];
    const real qa = value_of(q, x->a), qb = value_of(q, x->b);
    vectors += (cosine * x->hs - sine * x->hc) * (rate_of(qd, x->a) * qb + qa * rate_of(qd, x->b));
    length += (sine * x->hs + cosine * x->hc) * qa * qb;
  }
  return vectors - length * qd[S->angle_theta_col[i]];
}

/* Phit of (24) from the rates of the rows before it. Where a step begins with rows open by b too much, the forces that
 * turn the bodies to their angles leave them open by b too little: between lies what the rule turns by. */
static inline void turning_rates(const ali3_instance *in, const real *rate, real *Phit) {
  const ali3_system *S = in->system;
  for (int32_t n = 0; n < S->n_turning; n++) {
    const int32_t i = S->turning[n], k = S->angle_row[i];
    Phit[k] -= 0.5 * (rate[k] + angle_rate(S, i, in->now.q, in->now.qd));
  }
}

static const double MAX_TURN = 0.52; /* rad in a step: there the first steps give some 8e-4 of the energy */

#ifndef ALI3_WIDTH
/* Largest rate of them, rad/s. */
static inline double fastest_turn(const ali3_instance *in) {
  const ali3_system *S = in->system;
  double fastest = 0.0;
  for (int32_t n = 0; n < S->n_turning; n++) {
    const double rate = in->now.qd[S->angle_theta_col[S->turning[n]]];
    fastest = rate > fastest ? rate : -rate > fastest ? -rate : fastest;
  }
  return fastest;
}
#endif
#endif
