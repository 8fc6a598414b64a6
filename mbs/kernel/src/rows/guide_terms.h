/* Terms h s^power q_a q_b of rows, s a guide: what they add to Phi, Phi_q, Phi_t, gamma and the geometric term. */
#ifndef ALI3_GUIDE_TERMS_H
#define ALI3_GUIDE_TERMS_H
#include "../algebra/real.h"
#include "../algebra/stretch.h"
#include "../instance.h"

/* 1 where there is no coordinate. */
static inline real value_of(const real *q, int32_t coordinate) {
  return coordinate < 0 ? ali3_same(1.0) : q[coordinate];
}

static inline real rate_of(const real *qd, int32_t coordinate) {
  return coordinate < 0 ? ali3_same(0.0) : qd[coordinate];
}

/* w = h s^power and its two rates. */
static inline real guide_factor(const ali3_guide_term *g, const real *s) {
  const real v = s[g->guide];
  return g->power == 1 ? g->term.h * v : g->term.h * v * v;
}

static inline real guide_rate(const ali3_guide_term *g, const ali3_vectors *x) {
  const real vd = x->sd[g->guide];
  return g->power == 1 ? g->term.h * vd : 2.0 * g->term.h * x->s[g->guide] * vd;
}

static inline real guide_second_rate(const ali3_guide_term *g, const ali3_vectors *x) {
  const real vd = x->sd[g->guide], vdd = x->sdd[g->guide];
  return g->power == 1 ? g->term.h * vdd : 2.0 * g->term.h * (x->s[g->guide] * vdd + vd * vd);
}

/* Terms of one guide and row with two coordinates each, from g on; these four return the last of them. */
static inline const ali3_guide_term *pairs_values(const ali3_guide_term *g, const real *q, const real *s, real *Phi,
                                                  real *J) {
  const ali3_guide_term *const last = g + g->pairs - 1;
  const real v = s[g->guide];
  real value = Phi[g->row];
  ALI3_SHORT
  for (; g <= last; g++) {
    const real qa = q[g->term.a], qb = q[g->term.b], w = g->term.h * v;
    value += w * qa * qb;
    J[g->term.ja] += w * qb;
    J[g->term.jb] += w * qa;
  }
  Phi[last->row] = value;
  return last;
}

static inline const ali3_guide_term *pairs_rate(const ali3_guide_term *g, const real *q, const real *sd, real *Phit) {
  const ali3_guide_term *const last = g + g->pairs - 1;
  const real vd = sd[g->guide];
  real value = Phit[g->row];
  ALI3_SHORT
  for (; g <= last; g++) value += g->term.h * vd * q[g->term.a] * q[g->term.b];
  Phit[last->row] = value;
  return last;
}

static inline const ali3_guide_term *pairs_gamma(const ali3_guide_term *g, const real *q, const real *qd,
                                                 const ali3_vectors *x, real *gamma) {
  const ali3_guide_term *const last = g + g->pairs - 1;
  const real v = x->s[g->guide], vd = x->sd[g->guide], vdd = x->sdd[g->guide];
  real value = gamma[g->row];
  ALI3_SHORT
  for (; g <= last; g++) {
    const real qa = q[g->term.a], qb = q[g->term.b], va = qd[g->term.a], vb = qd[g->term.b];
    const real w = g->term.h * v, wd = g->term.h * vd, wdd = g->term.h * vdd;
    value += wdd * qa * qb + 2.0 * wd * (va * qb + qa * vb) + 2.0 * w * va * vb;
  }
  gamma[last->row] = value;
  return last;
}

/* factor: of the second derivatives */
static inline const ali3_guide_term *pairs_geometric(const ali3_guide_term *g, real factor, const real *s, real *F) {
  const ali3_guide_term *const last = g + g->pairs - 1;
  const real v = s[g->guide];
  ALI3_SHORT
  for (; g <= last; g++) F[g->term.pos] += factor * (g->term.h * v) * (g->term.a == g->term.b ? 2.0 : 1.0);
  return last;
}

/* Phi += w q_a q_b, and Phi_q. */
static inline void guide_values(const ali3_system *S, const real *q, const real *s, real *Phi, real *J) {
  for (const ali3_guide_term *g = S->gterm, *last = g + S->n_gterm_row; g < last; g++) {
    if (g->pairs > 0) {
      g = pairs_values(g, q, s, Phi, J);
      continue;
    }
    const real qa = value_of(q, g->term.a), qb = value_of(q, g->term.b);
    const real w = guide_factor(g, s);
    Phi[g->row] += w * qa * qb;
    if (g->term.a >= 0) J[g->term.ja] += w * qb;
    if (g->term.b >= 0) J[g->term.jb] += w * qa;
  }
}

/* Phit += w' q_a q_b */
static inline void guide_rates(const ali3_system *S, const real *q, const ali3_vectors *guides, real *Phit) {
  for (const ali3_guide_term *g = S->gterm, *last = g + S->n_gterm_row; g < last; g++) {
    if (g->pairs > 0) {
      g = pairs_rate(g, q, guides->sd, Phit);
      continue;
    }
    const real qa = value_of(q, g->term.a), qb = value_of(q, g->term.b);
    Phit[g->row] += guide_rate(g, guides) * qa * qb;
  }
}

static inline void guide_gamma(const ali3_system *S, const real *q, const real *qd, const ali3_vectors *guides,
                               real *gamma) {
  for (const ali3_guide_term *g = S->gterm, *last = g + S->n_gterm_row; g < last; g++) {
    if (g->pairs > 0) {
      g = pairs_gamma(g, q, qd, guides, gamma);
      continue;
    }
    const real qa = value_of(q, g->term.a), qb = value_of(q, g->term.b);
    const real va = rate_of(qd, g->term.a), vb = rate_of(qd, g->term.b);
    const real w = guide_factor(g, guides->s), wd = guide_rate(g, guides), wdd = guide_second_rate(g, guides);
    gamma[g->row] += wdd * qa * qb + 2.0 * wd * (va * qb + qa * vb) + 2.0 * w * va * vb;
  }
}

/* F += weight * lam w of each, twice where a and b are the same. */
static inline void guide_geometric(const ali3_system *S, const real *s, const real *lam, double weight, real *F) {
  for (const ali3_guide_term *g = S->gterm, *last = g + S->n_gterm_row; g < last; g++) {
    if (g->pairs > 0) {
      g = pairs_geometric(g, weight * lam[g->row], s, F);
      continue;
    }
    if (g->term.pos < 0) continue;
    F[g->term.pos] += weight * lam[g->row] * guide_factor(g, s) * (g->term.a == g->term.b ? 2.0 : 1.0);
  }
}
#endif
