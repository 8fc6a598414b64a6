/* Inertia of lookup-table bodies. With X_v = sum_K T_Kv y_K, y = (r, Y) and J the moments of a body, M = B' M_X B
 * consists of T J T' for r and Y, Y T J dT'/dp with a parameter, and tr(dT/dp J dT'/dq) between two, where Y is
 * orthonormal. All are sums over the bodies of a base, so that a product with M has the same cost for many bodies as
 * for one. The same applies to Q_v = -B' M_X Bd qd: the rates of Y with those of parameters contribute only by the
 * antisymmetric part of Y' Yd. */
#include <string.h>

#include "../algebra/processor.h"
#include "lookup.h"

ALI3_INLINED void moments(const double *m, const real *x, real *out) {
  for (int k = 0; k < 3; k++) {
    const real r = x[k], a = x[3 + k], b = x[6 + k], c = x[9 + k];
    out[k] = m[0] * r + m[1] * a + m[2] * b + m[3] * c;
    out[3 + k] = m[1] * r + m[4] * a + m[9] * b + m[8] * c;
    out[6 + k] = m[2] * r + m[9] * a + m[5] * b + m[7] * c;
    out[9 + k] = m[3] * r + m[8] * a + m[7] * b + m[6] * c;
  }
}

void ali3_lookup_moments(const double *m, const real *x, real *out) { moments(m, x, out); }

ALI3_INLINED real inner(const real *a, const real *b) {
  real sum = {0};
  for (int i = 0; i < 12; i++) sum += a[i] * b[i];
  return sum;
}

/* out (K = 0 .. 3, 3) += T P of the vectors P of a body. */
ALI3_INLINED void gather(const real *T, const real *P, real *out) {
  for (int k = 0; k < 3; k++) {
    out[k] += P[k];
    for (int K = 0; K < 3; K++)
      out[3 + 3 * K + k] += (T[K] * P[k] + T[3 + K] * P[3 + k]) + (T[6 + K] * P[6 + k] + T[9 + K] * P[9 + k]);
  }
}

ALI3_INLINED void lookup_add_inertia(const ali3_instance *in, const ali3_lookup *c, ali3_lookup_work *w) {
  ali3_lookup_base_work *b = in->lookup.base + c->base;
  real P[12], product[12], by[2][12];
  memset(product, 0, sizeof product);
  moments(c->mass, w->value[0], P);
  gather(w->value[0], P, product);
  b->mass[0][0] += c->mass[0];
  for (int k = 0; k < 3; k++) {
    b->mass[0][1 + k] += product[k];
    b->mass[1 + k][0] += product[k];
    for (int K = 0; K < 3; K++) b->mass[1 + K][1 + k] += product[3 + 3 * K + k];
  }
  const int n_par = c->count[1] > 1 ? 2 : 1;
  for (int p = 0; p < n_par; p++) {
    moments(c->mass, w->value[ALI3_BY_A + p], by[p]);
    gather(w->value[0], by[p], in->lookup.parameter[c->along[p]].own);
    for (int o = 0; o <= p; o++) w->inertia[p + o] = inner(w->value[ALI3_BY_A + o], by[p]);
  }
  for (int k = 0; n_par == 2 && k < 3; k++) {
    const int l = (k + 1) % 3;
    w->twist[k] = ali3_same(0.0);
    for (int v = 0; v < 12; v += 3)
      w->twist[k] += w->value[ALI3_BY_A][v + k] * by[1][v + l] - w->value[ALI3_BY_A][v + l] * by[1][v + k];
  }
}

ALI3_BY_PROCESSOR(in->system, void, lookup_add_inertia,
                  (const ali3_instance *in, const ali3_lookup *c, ali3_lookup_work *w), (in, c, w))

void ali3_lookup_mass_times(const ali3_instance *in, const real *x, real *out) {
  const ali3_system *S = in->system;
  for (int32_t b = 0; b < S->n_lookup_base; b++) {
    const ali3_lookup_base *base = S->lookup_base + b;
    real y[12], sum[12];
    if (base->frame[0] < 0) continue;
    for (int i = 0; i < 12; i++) y[i] = x[base->frame[i]];
    for (int K = 0; K < 4; K++) {
      const real *m = in->lookup.base[b].mass[K];
      for (int k = 0; k < 3; k++)
        sum[3 * K + k] = (m[0] * y[k] + m[1] * y[3 + k]) + (m[2] * y[6 + k] + m[3] * y[9 + k]);
    }
    for (int32_t p = base->first; p < base->end; p++) {
      const int32_t column = S->lookup_parameter[p].column;
      const real *turned = in->lookup.parameter[p].turned, rate = x[column];
      for (int i = 0; i < 12; i++) sum[i] += rate * turned[i];
      out[column] += inner(turned, y);
    }
    for (int i = 0; i < 12; i++) out[base->frame[i]] += sum[i];
  }
  for (int32_t i = 0; i < S->n_lookup; i++) {
    const ali3_lookup *c = S->lookup + i;
    const real *m = in->lookup.item[i].inertia;
    if (!ali3_lookup_heavy(c)) continue;
    out[c->param[0]] += m[0] * x[c->param[0]];
    if (c->count[1] == 1) continue;
    out[c->param[0]] += m[1] * x[c->param[1]];
    out[c->param[1]] += m[1] * x[c->param[0]] + m[2] * x[c->param[1]];
  }
}

/* Adds -B' M_X Bd qd of a body, without the terms of the rates of Y on r and Y. */
ALI3_INLINED void add_velocity_terms(const ali3_lookup *c, const ali3_lookup_work *w, const real *qd,
                                     const real *turning, ali3_lookup_base_work *base, real *Q) {
  const real a = qd[c->param[0]], b = c->count[1] > 1 ? qd[c->param[1]] : ali3_same(0.0);
  real t[12], P[12];
  for (int i = 0; i < 12; i++) {
    t[i] = -a * a * w->value[ALI3_BY_AA][i];
    if (c->count[1] > 1) t[i] -= 2.0 * a * b * w->value[ALI3_BY_AB][i] + b * b * w->value[ALI3_BY_BB][i];
  }
  moments(c->mass, t, P);
  gather(w->value[0], P, base->force);
  Q[c->param[0]] += inner(w->value[ALI3_BY_A], P);
  if (c->count[1] == 1) return;
  const real twist = 2.0 * (turning[0] * w->twist[0] + turning[1] * w->twist[1] + turning[2] * w->twist[2]);
  Q[c->param[0]] -= b * twist;
  Q[c->param[1]] += inner(w->value[ALI3_BY_B], P) + a * twist;
}

ALI3_INLINED void lookup_inertia_forces(const ali3_instance *in, const real *qd, real *Q) {
  const ali3_system *S = in->system;
  for (int32_t b = 0; b < S->n_lookup_base; b++) memset(in->lookup.base[b].force, 0, sizeof in->lookup.base[b].force);
  for (int32_t i = 0; i < S->n_lookup; i++) {
    const ali3_lookup *c = S->lookup + i;
    ali3_lookup_base_work *w = in->lookup.base + c->base;
    real turning[3]; /* Y_k . Yd_(k + 1) */
    if (!ali3_lookup_heavy(c)) continue;
    memset(turning, 0, sizeof turning);
    for (int k = 0; c->count[1] > 1 && c->frame[0] >= 0 && k < 3; k++)
      for (int x = 0; x < 3; x++) turning[k] += w->axes[3 * k + x] * qd[c->frame[3 + 3 * ((k + 1) % 3) + x]];
    add_velocity_terms(c, in->lookup.item + i, qd, turning, w, Q);
  }
  for (int32_t b = 0; b < S->n_lookup_base; b++) {
    const ali3_lookup_base *base = S->lookup_base + b;
    const ali3_lookup_base_work *w = in->lookup.base + b;
    const double *g = base->gravity;
    real mixed[12], axes[9], turned[3];
    memset(mixed, 0, sizeof mixed);
    for (int32_t p = base->first; p < base->end; p++) {
      const ali3_lookup_parameter_work *of = in->lookup.parameter + p;
      const int32_t column = S->lookup_parameter[p].column;
      Q[column] += g[0] * of->turned[0] + g[1] * of->turned[1] + g[2] * of->turned[2];
      for (int i = 0; i < 12; i++) mixed[i] += 2.0 * qd[column] * of->own[i];
    }
    if (base->frame[0] < 0) continue;
    for (int i = 0; i < 9; i++) axes[i] = qd[base->frame[3 + i]];
    for (int K = 0; K < 4; K++) {
      real *to[3] = {Q + base->frame[3 * K], Q + base->frame[3 * K + 1], Q + base->frame[3 * K + 2]};
      ali3_lookup_turn(w->axes, w->force + 3 * K, turned);
      for (int k = 0; k < 3; k++) *to[k] += turned[k] + g[k] * w->mass[0][K];
      ali3_lookup_turn(axes, mixed + 3 * K, turned);
      for (int k = 0; k < 3; k++) *to[k] -= turned[k];
    }
  }
}

ALI3_BY_PROCESSOR(in->system, void, lookup_inertia_forces, (const ali3_instance *in, const real *qd, real *Q),
                  (in, qd, Q))

#ifndef ALI3_WIDTH
double ali3_lookup_gravity(const ali3_instance *in, const double *q) {
  double energy = 0.0;
  for (int32_t b = 0; b < in->system->n_lookup_base; b++) {
    const ali3_lookup_base *base = in->system->lookup_base + b;
    const double *m = in->lookup.base[b].mass[0], *axes = in->lookup.base[b].axes;
    for (int k = 0; k < 3; k++) {
      const double place = base->frame[0] < 0 ? 0.0 : q[base->frame[k]];
      energy -= base->gravity[k] * ((m[0] * place + m[1] * axes[k]) + (m[2] * axes[3 + k] + m[3] * axes[6 + k]));
    }
  }
  return energy;
}
#endif
