/* Dependent coordinates of tabled bodies and numbers, and what goes along B = dX/dq and back. */
#include <string.h>

#include "tabled.h"

enum { BY_A = 1, BY_B, BY_AA, BY_AB, BY_BB }; /* of ali3_tabled_work.value */

static ali3_tabled_work *work_of(const ali3_instance *in, int32_t i) { return in->tabled + i; }

static double parameter(const ali3_tabled *c, int which, const double *x) {
  return c->param[which] < 0 ? 0.0 : x[c->param[which]];
}

/* out (12) = Y t of each of the four vectors. */
static void turned(const double *restrict Y, const double *restrict t, double *restrict out) {
  for (int v = 0; v < 4; v++)
    for (int x = 0; x < 3; x++) out[3 * v + x] = Y[x] * t[3 * v] + Y[3 + x] * t[3 * v + 1] + Y[6 + x] * t[3 * v + 2];
}

static const double EARTH[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

/* r and Y of the base from a vector of coordinates; of the earth `fixed`. */
static void base(const ali3_tabled *c, const double *x, const double *fixed, double out[12]) {
  for (int i = 0; i < 12; i++) out[i] = c->frame[0] < 0 ? fixed[i] : x[c->frame[i]];
}

void ali3_tabled_prepare(const ali3_instance *in, const double *q) {
  const ali3_system *S = in->system;
  for (int32_t i = 0; i < S->n_tabled; i++) {
    const ali3_tabled *c = S->tabled + i;
    ali3_tabled_work *w = work_of(in, i);
    double frame[12];
    ali3_tabled_table(c, parameter(c, 0, q), parameter(c, 1, q), w->value);
    if (c->n != ALI3_TABLED_BODY) {
      w->by[0][0] = w->value[BY_A][0];
      w->by[1][0] = w->value[BY_B][0];
      continue;
    }
    base(c, q, EARTH, frame);
    memcpy(w->axes, frame + 3, sizeof w->axes);
    turned(w->axes, w->value[BY_A], w->by[0]);
    if (c->count[1] > 1) turned(w->axes, w->value[BY_B], w->by[1]);
  }
}

/* out = B x. */
static void along(const ali3_tabled *c, const ali3_tabled_work *w, const double *x, double *out) {
  static const double still[12] = {0.0};
  const double a = parameter(c, 0, x), b = parameter(c, 1, x);
  double frame[12];
  if (c->n == ALI3_TABLED_BODY) {
    base(c, x, still, frame);
    turned(frame + 3, w->value[0], out);
    for (int k = 0; k < 3; k++) out[k] += frame[k];
  } else {
    out[0] = 0.0;
  }
  for (int32_t i = 0; i < c->n; i++) out[i] += a * w->by[0][i];
  for (int32_t i = 0; c->count[1] > 1 && i < c->n; i++) out[i] += b * w->by[1][i];
}

/* out = Bd qd: what of the second rates of X comes from rates. */
static void bend(const ali3_tabled *c, const ali3_tabled_work *w, const double *qd, double *out) {
  static const double still[12] = {0.0};
  const double a = parameter(c, 0, qd), b = parameter(c, 1, qd);
  double t[ALI3_TABLED_BODY], first[ALI3_TABLED_BODY], frame[12];
  for (int32_t i = 0; i < c->n; i++) {
    t[i] = a * a * w->value[BY_AA][i] + 2.0 * a * b * w->value[BY_AB][i] + b * b * w->value[BY_BB][i];
    first[i] = 2.0 * (a * w->value[BY_A][i] + b * w->value[BY_B][i]);
  }
  if (c->n != ALI3_TABLED_BODY) {
    out[0] = t[0];
    return;
  }
  base(c, qd, still, frame);
  turned(w->axes, t, out);
  turned(frame + 3, first, t);
  for (int i = 0; i < ALI3_TABLED_BODY; i++) out[i] += t[i];
}

/* Q += B' f. */
static void back(const ali3_tabled *c, const ali3_tabled_work *w, const double *f, double *Q) {
  double a = 0.0, b = 0.0;
  for (int32_t i = 0; i < c->n; i++) a += w->by[0][i] * f[i];
  Q[c->param[0]] += a;
  if (c->count[1] > 1) {
    for (int32_t i = 0; i < c->n; i++) b += w->by[1][i] * f[i];
    Q[c->param[1]] += b;
  }
  if (c->n != ALI3_TABLED_BODY || c->frame[0] < 0) return;
  for (int x = 0; x < 3; x++) {
    Q[c->frame[x]] += f[x];
    for (int k = 0; k < 3; k++) {
      double sum = 0.0;
      for (int v = 0; v < 4; v++) sum += w->value[0][3 * v + k] * f[3 * v + x];
      Q[c->frame[3 + 3 * k + x]] += sum;
    }
  }
}

void ali3_tabled_extend(const ali3_instance *in, const double *q, const double *qd, const double *qdd) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  const double *from[3] = {q, qd, qdd};
  for (int k = 0; k < 3; k++)
    if (from[k] != NULL) memcpy(in->extended[k], from[k], (size_t)nq * sizeof(double));
  for (int32_t i = 0; i < S->n_tabled; i++) {
    const ali3_tabled *c = S->tabled + i;
    const ali3_tabled_work *w = work_of(in, i);
    const int32_t first = nq + c->first;
    double frame[12], bent[ALI3_TABLED_BODY];
    double *X = in->extended[0] + first;
    if (c->n == ALI3_TABLED_BODY) {
      base(c, q, EARTH, frame);
      turned(w->axes, w->value[0], X);
      for (int k = 0; k < 3; k++) X[k] += frame[k];
    } else {
      X[0] = w->value[0][0];
    }
    along(c, w, qd, in->extended[1] + first);
    if (qdd == NULL) continue;
    along(c, w, qdd, in->extended[2] + first);
    bend(c, w, qd, bent);
    for (int32_t k = 0; k < c->n; k++) in->extended[2][first + k] += bent[k];
  }
}

void ali3_tabled_way(const ali3_instance *in, const double *D) {
  const ali3_system *S = in->system;
  memcpy(in->extended[0], D, (size_t)S->size.nq * sizeof(double));
  for (int32_t i = 0; i < S->n_tabled; i++) {
    const ali3_tabled *c = S->tabled + i;
    double bent[ALI3_TABLED_BODY], *way = in->extended[0] + S->size.nq + c->first;
    along(c, work_of(in, i), D, way);
    bend(c, work_of(in, i), D, bent);
    for (int32_t k = 0; k < c->n; k++) way[k] -= 0.5 * bent[k];
  }
}

/* out = M_X x of the four vectors of a body; moments: mass, first (3), second xx, yy, zz, yz, zx, xy. */
static void inertia(const double *m, const double *x, double *out) {
  for (int k = 0; k < 3; k++) {
    const double r = x[k], a = x[3 + k], b = x[6 + k], c = x[9 + k];
    out[k] = m[0] * r + m[1] * a + m[2] * b + m[3] * c;
    out[3 + k] = m[1] * r + m[4] * a + m[9] * b + m[8] * c;
    out[6 + k] = m[2] * r + m[9] * a + m[5] * b + m[7] * c;
    out[9 + k] = m[3] * r + m[8] * a + m[7] * b + m[6] * c;
  }
}

static bool heavy(const ali3_tabled *c) { return c->n == ALI3_TABLED_BODY && c->mass[0] > 0.0; }

void ali3_tabled_mass_times(const ali3_instance *in, const double *x, double *out) {
  const ali3_system *S = in->system;
  for (int32_t i = 0; i < S->n_tabled; i++) {
    const ali3_tabled *c = S->tabled + i;
    double X[ALI3_TABLED_BODY], P[ALI3_TABLED_BODY];
    if (!heavy(c)) continue;
    along(c, work_of(in, i), x, X);
    inertia(c->mass, X, P);
    back(c, work_of(in, i), P, out);
  }
}

/* Weight of a body on its four vectors. */
static void weight(const ali3_tabled *c, double f[ALI3_TABLED_BODY]) {
  for (int v = 0; v < 4; v++)
    for (int k = 0; k < 3; k++) f[3 * v + k] = c->mass[v] * c->gravity[k];
}

void ali3_tabled_forces(ali3_instance *in, const double *qd, double *Q) {
  const ali3_system *S = in->system;
  for (int32_t i = 0; i < S->n_tabled; i++) {
    const ali3_tabled *c = S->tabled + i;
    ali3_tabled_work *w = work_of(in, i);
    const double *element = in->extended_force + c->first;
    double bent[ALI3_TABLED_BODY], P[ALI3_TABLED_BODY];
    memset(w->force, 0, sizeof w->force);
    if (heavy(c)) {
      bend(c, w, qd, bent);
      inertia(c->mass, bent, P);
      weight(c, w->force);
      for (int k = 0; k < ALI3_TABLED_BODY; k++) w->force[k] -= P[k];
    }
    for (int32_t k = 0; k < c->n; k++) w->force[k] += element[k];
    back(c, w, w->force, Q);
  }
}

/* Energy of the weight of tabled bodies where they are prepared, J. */
double ali3_tabled_gravity(const ali3_instance *in, const double *q) {
  double energy = 0.0;
  for (int32_t i = 0; i < in->system->n_tabled; i++) {
    const ali3_tabled *c = in->system->tabled + i;
    double f[ALI3_TABLED_BODY], X[ALI3_TABLED_BODY], frame[12];
    if (!heavy(c)) continue;
    weight(c, f);
    base(c, q, EARTH, frame);
    turned(frame + 3, work_of(in, i)->value[0], X);
    for (int k = 0; k < 3; k++) X[k] += frame[k];
    for (int k = 0; k < ALI3_TABLED_BODY; k++) energy -= f[k] * X[k];
  }
  return energy;
}

void ali3_tabled_power(const ali3_instance *in, const double *qd, double *kinetic, double *gravity) {
  for (int32_t i = 0; i < in->system->n_tabled; i++) {
    const ali3_tabled *c = in->system->tabled + i;
    double f[ALI3_TABLED_BODY], X[ALI3_TABLED_BODY], P[ALI3_TABLED_BODY], bent[ALI3_TABLED_BODY];
    if (!heavy(c)) continue;
    along(c, work_of(in, i), qd, X);
    bend(c, work_of(in, i), qd, bent);
    inertia(c->mass, X, P);
    weight(c, f);
    for (int k = 0; k < ALI3_TABLED_BODY; k++) {
      *kinetic += P[k] * bent[k];
      *gravity -= f[k] * X[k];
    }
  }
}

bool ali3_tabled_left(const ali3_instance *in) {
  for (int32_t i = 0; i < in->system->n_tabled; i++) {
    const ali3_tabled *c = in->system->tabled + i;
    for (int which = 0; which < 2 && c->count[which] > 1; which++) {
      const double place = (in->now.q[c->param[which]] - c->axis[2 * which]) / c->axis[2 * which + 1];
      if (!(place >= -1.0 && place <= c->count[which] - 2.0)) return true;
    }
  }
  return false;
}
