/* Terms h s^power q_a q_b of rows, s a driving function: what they add to Phi, Phi_q, Phi_t, gamma and the geometric
 * term. */
#ifndef ALI3_DRIVING_TERMS_H
#define ALI3_DRIVING_TERMS_H
#include "../algebra/real.h"
#include "../instance.h"

/* Value of a coordinate; 1 if there is none. */
static inline real value_of(const real *q, int32_t coordinate) {
  return coordinate < 0 ? ali3_same(1.0) : q[coordinate];
}

/* Rate of a coordinate; 0 if there is none. */
static inline real rate_of(const real *qd, int32_t coordinate) {
  return coordinate < 0 ? ali3_same(0.0) : qd[coordinate];
}

/* w = h s^power */
static inline real driving_factor(const ali3_driving_term *g, const real *s) {
  const real v = s[g->driving];
  return g->power == 1 ? g->term.h * v : g->term.h * v * v;
}

/* w' */
static inline real driving_rate(const ali3_driving_term *g, const ali3_vectors *x) {
  const real vd = x->sd[g->driving];
  return g->power == 1 ? g->term.h * vd : 2.0 * g->term.h * x->s[g->driving] * vd;
}

/* w'' */
static inline real driving_second_rate(const ali3_driving_term *g, const ali3_vectors *x) {
  const real vd = x->sd[g->driving], vdd = x->sdd[g->driving];
  return g->power == 1 ? g->term.h * vdd : 2.0 * g->term.h * (x->s[g->driving] * vdd + vd * vd);
}

/* Second derivative of w q_a q_b with respect to time without coordinate accelerations; va, vb: rates of q_a, q_b. */
static inline real driving_second_derivative(real qa, real qb, real va, real vb, real w, real wd, real wdd) {
  return wdd * qa * qb + 2.0 * wd * (va * qb + qa * vb) + 2.0 * w * va * vb;
}

/* Phi += w q_a q_b, and Phi_q. */
static inline void driving_values(const ali3_system *S, const real *q, const real *s, real *Phi, real *J) {
  for (const ali3_driving_term *g = S->gterm, *last = g + S->n_gterm_row; g < last; g++) {
    const real qa = value_of(q, g->term.a), qb = value_of(q, g->term.b), w = driving_factor(g, s);
    Phi[g->row] += w * qa * qb;
    if (g->term.a >= 0) J[g->term.ja] += w * qb;
    if (g->term.b >= 0) J[g->term.jb] += w * qa;
  }
}

/* Phit += w' q_a q_b */
static inline void driving_rates(const ali3_system *S, const real *q, const ali3_vectors *driving, real *Phit) {
  for (const ali3_driving_term *g = S->gterm, *last = g + S->n_gterm_row; g < last; g++)
    Phit[g->row] += driving_rate(g, driving) * value_of(q, g->term.a) * value_of(q, g->term.b);
}

/* gamma += second time derivatives of the terms, without accelerations of coordinates. */
static inline void driving_gamma(const ali3_system *S, const real *q, const real *qd, const ali3_vectors *driving,
                                 real *gamma) {
  for (const ali3_driving_term *g = S->gterm, *last = g + S->n_gterm_row; g < last; g++)
    gamma[g->row] += driving_second_derivative(value_of(q, g->term.a), value_of(q, g->term.b), rate_of(qd, g->term.a),
                                               rate_of(qd, g->term.b), driving_factor(g, driving->s),
                                               driving_rate(g, driving), driving_second_rate(g, driving));
}

/* F += weight * lam w of each, twice if a and b are the same. */
static inline void driving_geometric(const ali3_system *S, const real *s, const real *lam, double weight, real *F) {
  for (const ali3_driving_term *g = S->gterm, *last = g + S->n_gterm_row; g < last; g++) {
    if (g->term.pos < 0) continue;
    F[g->term.pos] += weight * lam[g->row] * driving_factor(g, s) * (g->term.a == g->term.b ? 2.0 : 1.0);
  }
}
#endif
