/* Rates of the sensors that have one: their change along in->stored.direction, a direction in the space of states,
 * which is (qd, qdd, ...); a function for each such type. */
#include <math.h>
#include <string.h>

#include "../flexible/bodies.h"
#include "../flexible/flexible_body.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../lookup/lookup.h"
#include "../system/sensor_types.h"
#include "sensors.h"

typedef struct {
  double v[3], d[3]; /* value and change */
} dual_vector;

/* Signal i (order 0) or its first or second rate, of a state, without the constant. */
static double evaluate_signal(const ali3_instance *in, const ali3_vectors *x, int32_t i, int32_t order) {
  const ali3_system *S = in->system;
  const double *column = order == 0 ? x->q : (order == 1 ? x->qd : x->qdd);
  if (S->n_lookup > 0) column = in->lookup.extended[order + (x == &in->stored.direction)]; /* a direction is a rate */
  double sum = 0.0;
  for (int32_t k = S->sig_ptr[i]; k < S->sig_ptr[i + 1]; k++) sum += S->sig_val[k] * column[S->sig_col[k]];
  return sum;
}

/* n signals (order 1, 2: their rates), and their derivatives in the direction. */
static dual_vector evaluate_vector(const ali3_instance *in, const int32_t *v, int32_t order, int32_t n) {
  dual_vector m = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int32_t i = 0; i < n; i++) {
    m.v[i] = evaluate_signal(in, &in->now, v[i], order) + (order == 0 ? in->system->sig_const[v[i]] : 0.0);
    m.d[i] = evaluate_signal(in, &in->stored.direction, v[i], order);
  }
  return m;
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Derivative of a . b. */
static double dot_change(const dual_vector *a, const dual_vector *b) { return dot(a->d, b->v) + dot(a->v, b->d); }

static void cross(const double a[3], const double b[3], double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Derivative of atan2(y, x). */
static double angle_change(double y, double x, double dy, double dx) {
  const double square = x * x + y * y;
  return square > 0.0 ? (x * dy - y * dx) / square : 0.0;
}

/* real: scale. */
static double change_signal(const ali3_instance *in, const int32_t *v, const double *real) {
  return real[0] * evaluate_signal(in, &in->stored.direction, v[0], 0);
}

/* real: scale. */
static double change_signal_rate(const ali3_instance *in, const int32_t *v, const double *real) {
  return real[0] * evaluate_signal(in, &in->stored.direction, v[0], 1);
}

/* v: order, 3 signals of the vector, 3 of the axis. */
static double change_component(const ali3_instance *in, const int32_t *v, const double *real) {
  const dual_vector p = evaluate_vector(in, v + 1, v[0], 3), a = evaluate_vector(in, v + 4, 0, 3);
  (void)real;
  return dot_change(&p, &a);
}

/* v: order, 15 signals, 3 of the axis. */
static double change_carried(const ali3_instance *in, const int32_t *v, const double *real) {
  const dual_vector axis = evaluate_vector(in, v + 16, 0, 3);
  dual_vector p;
  (void)real;
  ali3_carried(in, v + 1, v[0], p.v);
  ali3_carried(in, v + 1, v[0] + 1, p.d);
  return dot_change(&p, &axis);
}

/* Of atan2(y, x), rad/s; v: signals of y and x. */
static double change_angle(const ali3_instance *in, const int32_t *v, const double *real) {
  const dual_vector y = evaluate_vector(in, v, 0, 1), x = evaluate_vector(in, v + 1, 0, 1);
  (void)real;
  return angle_change(y.v[0], x.v[0], y.d[0], x.d[0]);
}

/* Of -asin(u), rad/s; 0 at +-90 degrees. */
static double change_pitch(const ali3_instance *in, const int32_t *v, const double *real) {
  const dual_vector u = evaluate_vector(in, v, 0, 1);
  (void)real;
  const double rest = 1.0 - u.v[0] * u.v[0];
  return rest > 0.0 ? -u.d[0] / sqrt(rest) : 0.0;
}

/* Of (a' . b - b' . a) / 2, rad/s^2; a, b: 3 signals each. */
static double change_angular_rate(const ali3_instance *in, const int32_t *v, const double *real) {
  const dual_vector a = evaluate_vector(in, v, 0, 3), b = evaluate_vector(in, v + 3, 0, 3);
  const dual_vector ad = evaluate_vector(in, v, 1, 3), bd = evaluate_vector(in, v + 3, 1, 3);
  return real[0] * (0.5 * (dot_change(&ad, &b) - dot_change(&bd, &a)));
}

/* dp = 1/2 w p with the turn w = 1/2 sum a x da of the axes, both in earth axes. */
static double change_quaternion(const ali3_instance *in, const int32_t *v, const double *real) {
  double w[3] = {0.0, 0.0, 0.0}, one[3], p[4];
  const int32_t wanted = v[0];
  (void)real;
  ali3_quaternion(in, v + 1, p);
  for (int32_t i = 0; i < 3; i++) {
    const dual_vector a = evaluate_vector(in, v + 1 + 3 * i, 0, 3);
    cross(a.v, a.d, one);
    for (int32_t j = 0; j < 3; j++) w[j] += 0.5 * one[j];
  }
  cross(w, p + 1, one);
  return wanted == 0 ? -0.5 * dot(w, p + 1) : 0.5 * (p[0] * w[wanted - 1] + one[wanted - 1]);
}

/* Changes of the energies of flexible bodies with the positions: they are quadratic in q, for which differences of any
 * width are exact. */
static void flexible_energy(const ali3_instance *in, double *kinetic, double *gravity, double *elastic) {
  const int32_t nq = in->system->size.nq;
  for (int side = -1; side <= 1; side += 2) {
    double twice = 0.0, of_weight = 0.0, of_strain = 0.0;
    for (int32_t i = 0; i < nq; i++) in->step.w[i] = in->now.q[i] + side * in->stored.direction.q[i];
    ali3_bodies_prepare(in, in->step.w);
    ali3_bodies_energy(in, in->step.w, &of_weight, &of_strain);
    memset(in->step.x, 0, (size_t)nq * sizeof(double));
    ali3_flexible_mass_times(in, in->now.qd, in->step.x);
    for (int32_t i = 0; i < nq; i++) twice += in->step.x[i] * in->now.qd[i];
    *kinetic += 0.25 * side * twice;
    *gravity += 0.5 * side * of_weight;
    *elastic += 0.5 * side * of_strain;
  }
}

/* W; v[0]: kinetic, gravity, elastic, sum. */
static double change_energy(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  const ali3_system *S = in->system;
  double kinetic = 0.0, gravity = 0.0, elastic = 0.0;
  if (S->n_flexible > 0) flexible_energy(in, &kinetic, &gravity, &elastic);
  ali3_bodies_prepare(in, in->now.q);
  ali3_mass_times(in, in->now.qd, in->step.x);
  for (int32_t i = 0; i < S->size.nq; i++) {
    kinetic += in->step.x[i] * in->stored.direction.qd[i];
    gravity -= in->mass.gravity[i] * in->stored.direction.q[i];
  }
  if (S->n_lookup > 0) ali3_lookup_power(in, in->now.qd, &kinetic, &gravity);
  for (int32_t e = 0; e < S->size.ne; e++) elastic += in->stored.direction.potential[e];
  const double kinds[4] = {kinetic, gravity, elastic, kinetic + gravity + elastic};
  return kinds[v[0]];
}

static double change_mass(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)in, (void)v, (void)real;
  return 0.0;
}

/* Of a vector of v[1] signals or of its rate; 0 at length 0. */
static double change_norm(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  const dual_vector p = evaluate_vector(in, v + 2, v[0], v[1]);
  const double length = sqrt(dot(p.v, p.v));
  return length > 0.0 ? dot(p.v, p.d) / length : 0.0;
}

/* rad/s: turn of a vector between two axes; v: order, 3 signals each of the vector and both axes. */
static double change_direction(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  const dual_vector p = evaluate_vector(in, v + 1, v[0], 3), a = evaluate_vector(in, v + 4, 0, 3),
                    b = evaluate_vector(in, v + 7, 0, 3);
  const double along = dot(p.v, a.v), across = dot(p.v, b.v);
  if (v[0] == 1 && along * along + across * across < ALI3_SLOWEST_DIRECTION * ALI3_SLOWEST_DIRECTION) return 0.0;
  return angle_change(across, along, dot_change(&p, &b), dot_change(&p, &a));
}

/* rad/s: angle from b to a about c, 3 signals each. */
static double change_angle_about(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  const dual_vector a = evaluate_vector(in, v, 0, 3), b = evaluate_vector(in, v + 3, 0, 3),
                    c = evaluate_vector(in, v + 6, 0, 3);
  double one[3], two[3];
  dual_vector turn;
  cross(b.v, a.v, turn.v);
  cross(b.d, a.v, one);
  cross(b.v, a.d, two);
  for (int32_t i = 0; i < 3; i++) turn.d[i] = one[i] + two[i];
  return angle_change(dot(turn.v, c.v), dot(a.v, b.v), dot_change(&turn, &c), dot_change(&a, &b));
}

/* v: driving function, order; real: scale. */
static double change_driving(const ali3_instance *in, const int32_t *v, const double *real) {
  const double *of_order[3] = {in->stored.direction.s, in->stored.direction.sd, in->stored.direction.sdd};
  return real[0] * of_order[v[1]][v[0]];
}

typedef double sensor_function(const ali3_instance *in, const int32_t *v, const double *real);
#define FUNCTION_NEVER(name) NULL
#define FUNCTION_ALWAYS(name) change_##name
#define FUNCTION_BY_FIRST(name) change_##name
#define FUNCTION_BY_SECOND(name) change_##name
static sensor_function *const change_of[ALI3_SENSOR_TYPE_COUNT] = {
#define ALI3_SENSOR_TYPE(number, NAME, name, integers, reals, each, rate, ...) [number] = FUNCTION_##rate(name),
    ALI3_SENSOR_TYPES(ALI3_SENSOR_TYPE)
#undef ALI3_SENSOR_TYPE
};

/* Whether the rate is computed; accelerations have none. */
static unsigned char rate_known(int32_t type, const int32_t *v) {
  switch (ali3_sensor_types[type].rate) {
  case ALI3_RATE_ALWAYS:
    return 1;
  case ALI3_RATE_BY_FIRST:
    return v[0] < 2;
  case ALI3_RATE_BY_SECOND:
    return v[1] < 2;
  default:
    return 0;
  }
}

ali3_status ali3_sensor_rates(ali3_instance *in, double *rates, unsigned char *known) {
  if (in == NULL || rates == NULL || known == NULL) return ALI3_BAD_ARGUMENT;
  if (!in->start.initialised) return ALI3_NOT_INITIALISED;
  const ali3_system *S = in->system;
  const ali3_vectors *now = &in->now;
  ali3_vectors *d = &in->stored.direction;
  const size_t nq = (size_t)S->size.nq * sizeof(double), ng = (size_t)S->size.ng * sizeof(double);
  memset(d->q, 0, in->stored.n * sizeof(double));
  if (nq > 0) {
    memcpy(d->q, now->qd, nq);
    memcpy(d->qd, now->qdd, nq);
  }
  if (ng > 0) {
    memcpy(d->s, now->sd, ng);
    memcpy(d->sd, now->sdd, ng);
  }
  if (S->n_lookup > 0) {
    ali3_lookup_prepare(in, now->q);
    ali3_lookup_extend(in, now->q, now->qd, now->qdd, true);
  }
  for (int32_t i = 0; i < S->size.ns; i++) {
    const int32_t type = S->sen_type[i], *v = S->sen_int + S->sen_int_ptr[i];
    known[i] = rate_known(type, v);
    rates[i] = known[i] ? change_of[type](in, v, in->parameters.sen_parameter + S->sen_parameter_ptr[i]) : 0.0;
  }
  return ALI3_OK;
}
