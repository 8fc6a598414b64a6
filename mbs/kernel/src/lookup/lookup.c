/* Dependent coordinates X of lookup-table bodies and numbers over the coordinates q, their rates, and their forces.
 *
 * With r and Y, the position and the axes of a base, and the functions p(a, b) and R_i(a, b) of the table:
 *   X = (r + Y p, Y R_1, Y R_2, Y R_3) of a body, X = p of a number,
 *   Xd = B qd, Xdd = B qdd + Bd qd, Q = B' f with B = dX/dq, d for rates and ' for the transpose, f the forces on X.
 * Vector v of a body is one of the four, 0 its position; the position without r, which affine signals add. */
#include "lookup.h"

#include <string.h>

/* Values of item i at the prepared q. */
static ali3_lookup_work *work_of(const ali3_instance *in, int32_t i) { return in->lookup.item + i; }

/* Coordinate or rate of parameter 0 or 1; 0 without it. */
static real parameter(const ali3_lookup *c, int which, const real *x) {
  return c->param[which] < 0 ? ali3_same(0.0) : x[c->param[which]];
}

static const double EARTH[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, STILL[12];

/* Reads r and Y of a base from a vector of coordinates; `fixed` for the earth. */
static void read_base(const ali3_lookup_base *b, const real *x, const double *fixed, real out[12]) {
  for (int i = 0; i < 12; i++) out[i] = b->frame[0] < 0 ? ali3_same(fixed[i]) : x[b->frame[i]];
}

void ali3_lookup_prepare(const ali3_instance *in, const real *q) {
  const ali3_system *S = in->system;
  for (int32_t b = 0; b < S->n_lookup_base; b++) {
    real frame[12];
    ali3_lookup_base_work *w = in->lookup.base + b;
    read_base(S->lookup_base + b, q, EARTH, frame);
    memcpy(w->axes, frame + 3, sizeof w->axes);
    memset(w->mass, 0, sizeof w->mass);
  }
  memset(in->lookup.parameter, 0, (size_t)S->n_lookup_parameter * sizeof *in->lookup.parameter);
  for (int32_t i = 0; i < S->n_lookup; i++) {
    const ali3_lookup *c = S->lookup + i;
    ali3_lookup_work *w = work_of(in, i);
    ali3_lookup_table(S, c, parameter(c, 0, q), parameter(c, 1, q), w->value);
    if (c->n != ALI3_LOOKUP_BODY) {
      for (int p = 0; p < (c->count[1] > 1 ? 2 : 1); p++) w->by[p][0] = w->value[ALI3_BY_A + p][0];
      continue;
    }
    for (int32_t k = 0; k < c->n_seen; k++)
      for (int p = 0; p < (c->count[1] > 1 ? 2 : 1); p++)
        ali3_lookup_turn(in->lookup.base[c->base].axes, w->value[ALI3_BY_A + p] + 3 * c->seen[k],
                         w->by[p] + 3 * c->seen[k]);
    if (ali3_lookup_heavy(c)) ali3_lookup_add_inertia(in, c, w);
  }
  for (int32_t b = 0; b < S->n_lookup_base; b++)
    for (int32_t p = S->lookup_base[b].first; p < S->lookup_base[b].end; p++)
      for (int v = 0; v < 4; v++)
        ali3_lookup_turn(in->lookup.base[b].axes, in->lookup.parameter[p].own + 3 * v,
                         in->lookup.parameter[p].turned + 3 * v);
}

/* First and second time derivatives of functions i to i + n - 1 at rates a, b of the parameters, without second rates
 * of these. */
static void parameter_rates(const ali3_lookup *c, const ali3_lookup_work *w, real a, real b, int32_t i, int32_t n,
                            real *first, real *second) {
  for (int32_t k = 0; k < n; k++, i++) {
    first[k] = a * w->value[ALI3_BY_A][i];
    second[k] = a * a * w->value[ALI3_BY_AA][i];
    if (c->count[1] == 1) continue;
    first[k] += b * w->value[ALI3_BY_B][i];
    second[k] += 2.0 * a * b * w->value[ALI3_BY_AB][i] + b * b * w->value[ALI3_BY_BB][i];
  }
}

/* Vector v of B x, x a vector of coordinates and `frame` its entries of r and Y. */
static void first_rate(const ali3_instance *in, const ali3_lookup *c, const ali3_lookup_work *w, const real *x,
                       const real frame[12], int32_t v, real out[3]) {
  real first[3], second[3], rotated[3];
  parameter_rates(c, w, parameter(c, 0, x), parameter(c, 1, x), 3 * v, 3, first, second);
  ali3_lookup_turn(in->lookup.base[c->base].axes, first, rotated);
  ali3_lookup_turn(frame + 3, w->value[0] + 3 * v, out);
  for (int k = 0; k < 3; k++) out[k] += rotated[k];
}

/* Vector v of Bd qd, the part of the second rates of X by the rates of coordinates; `frame`: of qd. */
static void second_rate(const ali3_instance *in, const ali3_lookup *c, const ali3_lookup_work *w, const real *qd,
                        const real frame[12], int32_t v, real out[3]) {
  real first[3], second[3], rotated[3];
  parameter_rates(c, w, parameter(c, 0, qd), parameter(c, 1, qd), 3 * v, 3, first, second);
  ali3_lookup_turn(in->lookup.base[c->base].axes, second, out);
  ali3_lookup_turn(frame + 3, first, rotated);
  for (int k = 0; k < 3; k++) out[k] += 2.0 * rotated[k];
}

/* Value and rates of a number, to entry `to` of in->lookup.extended; qdd NULL: without the second rate. */
static void extend_number(const ali3_instance *in, const ali3_lookup *c, const ali3_lookup_work *w, const real *qd,
                          const real *qdd, int32_t to) {
  real first, second, unused;
  in->lookup.extended[0][to] = w->value[0][0];
  parameter_rates(c, w, parameter(c, 0, qd), parameter(c, 1, qd), 0, 1, &first, &second);
  in->lookup.extended[1][to] = first;
  if (qdd == NULL) return;
  parameter_rates(c, w, parameter(c, 0, qdd), parameter(c, 1, qdd), 0, 1, &first, &unused);
  in->lookup.extended[2][to] = first + second;
}

void ali3_lookup_extend(const ali3_instance *in, const real *q, const real *qd, const real *qdd, bool all) {
  static const int32_t all_vectors[4] = {0, 1, 2, 3};
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  const real *from[3] = {q, qd, qdd};
  for (int k = 0; k < 3; k++)
    if (from[k] != NULL) memcpy(in->lookup.extended[k], from[k], (size_t)nq * sizeof(real));
  for (int32_t i = 0; i < S->n_lookup; i++) {
    const ali3_lookup *c = S->lookup + i;
    const ali3_lookup_work *w = work_of(in, i);
    const int32_t *vector = all ? all_vectors : c->seen, n = all ? 4 : c->n_seen;
    real place[12], rate[12], second[12];
    if (c->n != ALI3_LOOKUP_BODY) {
      extend_number(in, c, w, qd, qdd, nq + c->first);
      continue;
    }
    if (n == 0) continue;
    const ali3_lookup_base *b = S->lookup_base + c->base;
    read_base(b, q, EARTH, place);
    read_base(b, qd, STILL, rate);
    if (qdd != NULL) read_base(b, qdd, STILL, second);
    for (int32_t k = 0; k < n; k++) {
      const int32_t v = vector[k], to = nq + c->first + 3 * v;
      real curvature[3];
      ali3_lookup_turn(place + 3, w->value[0] + 3 * v, in->lookup.extended[0] + to);
      first_rate(in, c, w, qd, rate, v, in->lookup.extended[1] + to);
      if (qdd == NULL) continue;
      first_rate(in, c, w, qdd, second, v, in->lookup.extended[2] + to);
      second_rate(in, c, w, qd, rate, v, curvature);
      for (int x = 0; x < 3; x++) in->lookup.extended[2][to + x] += curvature[x];
    }
  }
}

void ali3_lookup_displacements(const ali3_instance *in, const real *D) {
  const ali3_system *S = in->system;
  memcpy(in->lookup.extended[0], D, (size_t)S->size.nq * sizeof(real));
  for (int32_t i = 0; i < S->n_lookup; i++) {
    const ali3_lookup *c = S->lookup + i;
    const ali3_lookup_work *w = work_of(in, i);
    real *displacement = in->lookup.extended[0] + S->size.nq + c->first, frame[12];
    if (c->n != ALI3_LOOKUP_BODY) {
      real second;
      parameter_rates(c, w, parameter(c, 0, D), parameter(c, 1, D), 0, 1, displacement, &second);
      displacement[0] -= 0.5 * second;
      continue;
    }
    if (c->n_seen == 0) continue;
    read_base(S->lookup_base + c->base, D, STILL, frame);
    for (int32_t k = 0; k < c->n_seen; k++) {
      real curvature[3];
      first_rate(in, c, w, D, frame, c->seen[k], displacement + 3 * c->seen[k]);
      second_rate(in, c, w, D, frame, c->seen[k], curvature);
      for (int x = 0; x < 3; x++) displacement[3 * c->seen[k] + x] -= 0.5 * curvature[x];
    }
  }
}

/* Q += B' f of the vectors on which signals depend. */
static void add_generalised_forces(const ali3_lookup *c, const ali3_lookup_work *w, const real *f, real *Q) {
  for (int p = 0; p < (c->count[1] > 1 ? 2 : 1); p++) {
    real sum = {0};
    if (c->n != ALI3_LOOKUP_BODY) sum = w->by[p][0] * f[0];
    for (int32_t k = 0; c->n == ALI3_LOOKUP_BODY && k < c->n_seen; k++)
      for (int32_t i = 3 * c->seen[k], end = i + 3; i < end; i++) sum += w->by[p][i] * f[i];
    Q[c->param[p]] += sum;
  }
  if (c->n != ALI3_LOOKUP_BODY || c->frame[0] < 0) return;
  for (int32_t n = 0; n < c->n_seen; n++) {
    const int32_t v = 3 * c->seen[n];
    for (int x = 0; x < 3; x++)
      for (int k = 0; k < 3; k++) Q[c->frame[3 + 3 * k + x]] += w->value[0][v + k] * f[v + x];
  }
}

void ali3_lookup_forces(ali3_instance *in, const real *qd, real *Q) {
  const ali3_system *S = in->system;
  memcpy(Q, in->lookup.force, (size_t)S->size.nq * sizeof *Q);
  ali3_lookup_inertia_forces(in, qd, Q);
  for (int32_t i = 0; i < S->n_lookup; i++) {
    const ali3_lookup *c = S->lookup + i;
    ali3_lookup_work *w = work_of(in, i);
    if (c->n_seen == 0) continue;
    memcpy(w->force, in->lookup.force + S->size.nq + c->first, (size_t)c->n * sizeof *w->force);
    add_generalised_forces(c, w, w->force, Q);
  }
}

#ifndef ALI3_WIDTH
void ali3_lookup_power(const ali3_instance *in, const double *qd, double *kinetic, double *gravity) {
  for (int32_t i = 0; i < in->system->n_lookup; i++) {
    const ali3_lookup *c = in->system->lookup + i;
    double frame[12], X[12], P[12], curvature[12];
    if (!ali3_lookup_heavy(c)) continue;
    read_base(in->system->lookup_base + c->base, qd, STILL, frame);
    for (int32_t v = 0; v < 4; v++) {
      first_rate(in, c, work_of(in, i), qd, frame, v, X + 3 * v);
      second_rate(in, c, work_of(in, i), qd, frame, v, curvature + 3 * v);
    }
    for (int k = 0; k < 3; k++) X[k] += frame[k];
    ali3_lookup_moments(c->mass, X, P);
    for (int k = 0; k < 12; k++) {
      *kinetic += P[k] * curvature[k];
      *gravity -= c->mass[k / 3] * c->gravity[k % 3] * X[k];
    }
  }
}

ali3_status ali3_beyond_table(const ali3_instance *in, int32_t *column, double value_and_ends[3]) {
  ali3_status status = ALI3_OK;
  double farthest = 1.0; /* in spacings of control points */
  if (in == NULL) return ALI3_BAD_ARGUMENT;
  if (column != NULL) *column = -1;
  for (int32_t i = 0; i < in->system->n_lookup; i++) {
    const ali3_lookup *c = in->system->lookup + i;
    for (int which = 0; which < 2 && c->count[which] > 1; which++) {
      const double q = in->now.q[c->param[which]], first = c->axis[2 * which], spacing = c->axis[2 * which + 1];
      const double last = c->count[which] - 3.0, place = (q - first) / spacing;
      const double beyond = -place > place - last ? -place : place - last;
      if (beyond <= farthest) continue;
      farthest = beyond;
      status = ALI3_BEYOND_TABLE;
      if (column != NULL) *column = c->param[which];
      if (value_and_ends != NULL) {
        value_and_ends[0] = q;
        value_and_ends[1] = first;
        value_and_ends[2] = first + spacing * last;
      }
    }
  }
  return status;
}
#endif
