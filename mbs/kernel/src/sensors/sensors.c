/* Values of sensors in the present state: one function for each type of sensor_types.h, called with the integers v and
 * the reals of the sensor. */
#include <math.h>
#include <string.h>

#include "../algebra/elementary.h"
#include "../elements/signal.h"
#include "../flexible/bodies.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../lookup/lookup.h"
#include "../rows/driving_functions.h"
#include "../state/work.h"
#include "../system/sensor_types.h"
#include "sensors.h"

/* Value of signal i (order 0), its rate (1) or its second rate (2). */
static double evaluate_signal(const ali3_instance *in, int32_t i, int32_t order) {
  const double *own = order == 0 ? in->now.q : (order == 1 ? in->now.qd : in->now.qdd);
  const double *x = in->system->n_lookup > 0 ? in->lookup.extended[order] : own;
  return ali3_signal_at(in->system, i, x, order > 0);
}

/* Three signals, or their first or second rates (order 1, 2). */
static void evaluate_vector(const ali3_instance *in, const int32_t *v, int32_t order, double out[3]) {
  for (int i = 0; i < 3; i++) out[i] = evaluate_signal(in, v[i], order);
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Component along a moving axis of a vector (order 0) or of its rates. */
static double moving_component(const ali3_instance *in, const int32_t *points, const int32_t *axis, int32_t order) {
  double p[3], a[3];
  evaluate_vector(in, points, order, p);
  evaluate_vector(in, axis, 0, a);
  return dot(p, a);
}

/* real: scale. */
static double value_signal(const ali3_instance *in, const int32_t *v, const double *real) {
  return real[0] * evaluate_signal(in, v[0], 0);
}

/* real: scale. */
static double value_signal_rate(const ali3_instance *in, const int32_t *v, const double *real) {
  return real[0] * evaluate_signal(in, v[0], 1);
}

/* real: scale. */
static double value_signal_second_rate(const ali3_instance *in, const int32_t *v, const double *real) {
  return real[0] * evaluate_signal(in, v[0], 2);
}

/* v: order, 3 signals of the vector, 3 of the axis. */
static double value_component(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  return moving_component(in, v + 1, v + 4, v[0]);
}

/* Value or rate of a signal of modal coordinates; contiguous coordinates are summed four at a time. */
static double signal_of_modes(const ali3_instance *in, int32_t i, int32_t order) {
  const ali3_system *S = in->system;
  const int32_t first = S->sig_ptr[i], n = S->sig_ptr[i + 1] - first, *col = S->sig_col + first;
  if (!ali3_consecutive(col, n) || S->n_lookup > 0) return evaluate_signal(in, i, order);
  const double *x = order == 0 ? in->now.q : (order == 1 ? in->now.qd : in->now.qdd);
  return (order == 0 ? S->sig_const[i] : 0.0) + ali3_product_backward(S->sig_val + first, x + col[0], n);
}

/* Position of a point of a flexible body or its rates, by Leibniz' rule: r + sum of axis_i times signal_i of its
 * modes. */
void ali3_carried(const ali3_instance *in, const int32_t *v, int32_t order, double out[3]) {
  static const double binomial[3][3] = {{1.0}, {1.0, 1.0}, {1.0, 2.0, 1.0}};
  evaluate_vector(in, v, order, out);
  for (int i = 0; i < 3; i++)
    for (int32_t k = 0; k <= order; k++) {
      double axis[3];
      evaluate_vector(in, v + 3 + 3 * i, order - k, axis);
      const double factor = binomial[order][k] * signal_of_modes(in, v[12 + i], k);
      for (int j = 0; j < 3; j++) out[j] += axis[j] * factor;
    }
}

/* Component of `ali3_carried` along a moving axis; v: order, 15 signals, 3 of the axis. */
static double value_carried(const ali3_instance *in, const int32_t *v, const double *real) {
  double p[3], axis[3];
  (void)real;
  ali3_carried(in, v + 1, v[0], p);
  evaluate_vector(in, v + 16, 0, axis);
  return dot(p, axis);
}

/* atan2 of two signals, rad. */
static double value_angle(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  return ali3_atan2(evaluate_signal(in, v[0], 0), evaluate_signal(in, v[1], 0));
}

/* rad, from the third component of the forward axis in earth axes. */
static double value_pitch(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  return -ali3_asin(fmax(-1.0, fmin(1.0, evaluate_signal(in, v[0], 0))));
}

/* (a' . b - b' . a) / 2 times a scale: angular velocity about a x b, rad/s; a, b orthonormal, 3 signals each. */
static double value_angular_rate(const ali3_instance *in, const int32_t *v, const double *real) {
  double a[3], b[3], ad[3], bd[3];
  evaluate_vector(in, v, 0, a);
  evaluate_vector(in, v + 3, 0, b);
  evaluate_vector(in, v, 1, ad);
  evaluate_vector(in, v + 3, 1, bd);
  return real[0] * (0.5 * (dot(ad, b) - dot(bd, a)));
}

/* Quaternion of a frame, scalar first and >= 0. The largest component follows from the diagonal of the rotation matrix,
 * the others from it, which avoids a small divisor. */
void ali3_quaternion(const ali3_instance *in, const int32_t *v, double n[4]) {
  double R[3][3];
  for (int i = 0; i < 3; i++) {
    double axis[3];
    evaluate_vector(in, v + 3 * i, 0, axis);
    for (int j = 0; j < 3; j++) R[j][i] = axis[j];
  }
  const double trace = R[0][0] + R[1][1] + R[2][2];
  int largest = 0;
  double best = trace;
  for (int i = 0; i < 3; i++)
    if (R[i][i] > best) {
      best = R[i][i];
      largest = i + 1;
    }
  if (largest == 0) {
    n[0] = 1.0 + trace;
    n[1] = R[2][1] - R[1][2];
    n[2] = R[0][2] - R[2][0];
    n[3] = R[1][0] - R[0][1];
  } else {
    const int i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
    n[0] = R[k][j] - R[j][k];
    n[1 + i] = 1.0 + R[i][i] - R[j][j] - R[k][k];
    n[1 + j] = R[j][i] + R[i][j];
    n[1 + k] = R[k][i] + R[i][k];
  }
  const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + n[3] * n[3]);
  const double size = n[0] < 0.0 ? -length : length;
  for (int i = 0; i < 4; i++) n[i] = length > 0.0 ? n[i] / size : (i == 0 ? 1.0 : 0.0);
}

/* v: component, 9 signals of the body axes. */
static double value_quaternion(const ali3_instance *in, const int32_t *v, const double *real) {
  double n[4];
  (void)real;
  ali3_quaternion(in, v + 1, n);
  return n[v[0]];
}

/* v: element, output; real: scale. */
static double value_element_output(const ali3_instance *in, const int32_t *v, const double *real) {
  return real[0] * in->now.out[in->system->el_out_ptr[v[0]] + v[1]];
}

/* Kinetic energy, potential energy of gravity, potential energy of elements and elastic bodies, and their sum, J. */
static void energies(const ali3_instance *in, double kinds[4]) {
  const ali3_system *S = in->system;
  double kinetic = 0.0, gravity = in->mass.gravity_const, elastic = 0.0;
  ali3_bodies_prepare(in, in->now.q);
  ali3_bodies_energy(in, in->now.q, &gravity, &elastic);
  ali3_mass_times(in, in->now.qd, in->step.x);
  for (int32_t i = 0; i < S->size.nq; i++) {
    kinetic += 0.5 * in->step.x[i] * in->now.qd[i];
    gravity -= in->mass.gravity[i] * in->now.q[i];
  }
  for (int32_t e = 0; e < S->size.ne; e++) elastic += in->now.potential[e];
  kinds[0] = kinetic;
  kinds[1] = gravity;
  kinds[2] = elastic;
  kinds[3] = kinetic + gravity + elastic;
}

/* J; v[0]: kind as in `energies`. */
static double value_energy(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  double kinds[4];
  energies(in, kinds);
  return kinds[v[0]];
}

/* kg: the mass of the drawing (real), payloads and changes of masses by parameters. */
static double value_mass(const ali3_instance *in, const int32_t *v, const double *real) {
  double sum = real[0];
  (void)v;
  for (int64_t k = 0; k < in->system->n_payload_mass; k++) sum += in->parameters.payload_mass[k];
  for (int64_t k = 0; k < in->system->n_inertia_parameter; k += ALI3_INERTIA_REALS)
    sum += in->parameters.inertia_parameter[k] - in->system->inertia_parameter[k];
  return sum;
}

/* Weighted sum of multipliers in the units of the user, N or N m; v: number, rows. */
static double value_reaction(const ali3_instance *in, const int32_t *v, const double *weight) {
  double sum = 0.0;
  for (int32_t i = 0; i < v[0]; i++) sum += weight[i] * in->system->row_scale[v[1 + i]] * in->now.lam[v[1 + i]];
  return sum;
}

/* A multiplier times a constant weight, up to three signals and the value of a driving function. */
static double reaction_product(const ali3_instance *in, const int32_t *term, double weight) {
  double value = weight * in->system->row_scale[term[0]] * in->now.lam[term[0]];
  for (int i = 1; i < 4; i++)
    if (term[i] >= 0) value *= evaluate_signal(in, term[i], 0);
  return term[4] >= 0 ? value * in->now.s[term[4]] : value;
}

/* v: number of products, then 5 integers each. */
static double value_reaction_products(const ali3_instance *in, const int32_t *v, const double *weight) {
  double sum = 0.0;
  for (int32_t k = 0; k < v[0]; k++) sum += reaction_product(in, v + 1 + 5 * k, weight[k]);
  return sum;
}

/* Sum of such products, where some are multiplied by the slope of a driving function given by a table. */
static double value_reaction_by_table(const ali3_instance *in, const int32_t *v, const double *weight) {
  double sum = 0.0;
  for (int32_t k = 0; k < v[0]; k++) {
    const int32_t *term = v + 1 + 6 * k;
    const double slope = term[5] >= 0 ? ali3_driving_slope(in, term[5], in->now.s) : 1.0;
    sum += slope * reaction_product(in, term, weight[k]);
  }
  return sum;
}

/* Norm of a vector of v[1] signals, or of its rate. */
static double value_norm(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  double sum = 0.0;
  for (int32_t i = 0; i < v[1]; i++) {
    const double x = evaluate_signal(in, v[2 + i], v[0]);
    sum += x * x;
  }
  return sqrt(sum);
}

/* rad: angle of a vector from axis 1 towards axis 2; v: order, 3 signals each of the vector and both axes. */
static double value_direction(const ali3_instance *in, const int32_t *v, const double *real) {
  const double x = moving_component(in, v + 1, v + 4, v[0]), y = moving_component(in, v + 1, v + 7, v[0]);
  (void)real;
  return v[0] == 1 && x * x + y * y < ALI3_SLOWEST_DIRECTION * ALI3_SLOWEST_DIRECTION ? 0.0 : ali3_atan2(y, x);
}

/* rad: angle from b to a about c, 3 signals each. */
static double value_angle_about(const ali3_instance *in, const int32_t *v, const double *real) {
  double a[3], b[3], c[3];
  (void)real;
  evaluate_vector(in, v, 0, a);
  evaluate_vector(in, v + 3, 0, b);
  evaluate_vector(in, v + 6, 0, c);
  const double cross[3] = {b[1] * a[2] - b[2] * a[1], b[2] * a[0] - b[0] * a[2], b[0] * a[1] - b[1] * a[0]};
  return ali3_atan2(dot(cross, c), dot(a, b));
}

/* Weighted sum of forces at the ports, specific acceleration of the origin and second rates of the axes, in body
 * axes. */
static double value_quasi_static(const ali3_instance *in, const int32_t *v, const double *real) {
  const int32_t n = v[0], *row = v + 13;
  const double *gravity = real, *weight = real + 3;
  double axis[3][3], rdd[3], axis_dd[3], sum = 0.0;
  for (int i = 0; i < 3; i++) evaluate_vector(in, v + 4 + 3 * i, 0, axis[i]);
  evaluate_vector(in, v + 1, 2, rdd);
  for (int k = 0; k < 3; k++) rdd[k] -= gravity[k];
  for (int32_t p = 0; p < n; p++, row += 3, weight += 3) {
    double force[3];
    for (int k = 0; k < 3; k++) force[k] = in->system->row_scale[row[k]] * in->now.lam[row[k]];
    for (int i = 0; i < 3; i++) sum += weight[i] * dot(axis[i], force);
  }
  for (int i = 0; i < 3; i++) sum += weight[i] * dot(axis[i], rdd);
  weight += 3;
  for (int j = 0; j < 3; j++) {
    evaluate_vector(in, v + 4 + 3 * j, 2, axis_dd);
    for (int i = 0; i < 3; i++) sum += weight[3 * i + j] * dot(axis[i], axis_dd);
  }
  return sum;
}

/* As used in the last step. */
static double value_input(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  return in->now.used[v[0]];
}

static double value_scaled_input(const ali3_instance *in, const int32_t *v, const double *real) {
  return real[0] * in->now.used[v[0]];
}

/* v: driving function, order; real: scale. */
static double value_driving(const ali3_instance *in, const int32_t *v, const double *real) {
  const double *of_order[3] = {in->now.s, in->now.sd, in->now.sdd};
  return real[0] * of_order[v[1]][v[0]];
}

/* What the inputs demand of a filtered driving function minus what its limits allow; 0 without a filter. */
static double value_driving_excess(const ali3_instance *in, const int32_t *v, const double *real) {
  if (!ali3_driving_filters(in->system->guide_type[v[0]])) return 0.0;
  const double demand = ali3_driving_demand(in, v[0], in->now.used);
  return real[0] * (demand - ali3_driving_clamped(in, v[0], demand));
}

static double value_solver(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  return ali3_solver_value(in, v[0]);
}

static double value_work(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  return ali3_work_sum(in, v[0], v[1], v + 2);
}

/* J: work of all driving functions and nonconservative work of v[0] elements. */
static double value_driving_work(const ali3_instance *in, const int32_t *v, const double *real) {
  (void)real;
  return ali3_work_sum(in, 1, v[0], v + 1) + in->now.work[in->system->n_work];
}

typedef double sensor_function(const ali3_instance *in, const int32_t *v, const double *real);
static sensor_function *const value_of[ALI3_SENSOR_TYPE_COUNT] = {
#define ALI3_SENSOR_TYPE(number, NAME, name, ...) [number] = value_##name,
    ALI3_SENSOR_TYPES(ALI3_SENSOR_TYPE)
#undef ALI3_SENSOR_TYPE
};

/* Value of sensor i. */
static double evaluate_sensor(const ali3_instance *in, int32_t i) {
  const ali3_system *S = in->system;
  return value_of[S->sen_type[i]](in, S->sen_int + S->sen_int_ptr[i],
                                  in->parameters.sen_parameter + S->sen_parameter_ptr[i]);
}

/* Evaluates lookup-table bodies in the present state, if there are any. */
static void prepare(const ali3_instance *in) {
  if (in->system->n_lookup == 0) return;
  ali3_lookup_prepare(in, in->now.q);
  ali3_lookup_extend(in, in->now.q, in->now.qd, in->now.qdd, true);
}

/* Values of n sensors, by their numbers or, with `number` NULL, of the first n. The energies are computed once for all
 * sensors of energy. */
static void evaluate(const ali3_instance *in, int32_t n, const int32_t *number, double *out) {
  const ali3_system *S = in->system;
  double kinds[4];
  bool have_energies = false;
  prepare(in);
  for (int32_t k = 0; k < n; k++) {
    const int32_t i = number != NULL ? number[k] : k;
    const bool energy = S->sen_type[i] == ALI3_SENSOR_ENERGY;
    if (energy && !have_energies) energies(in, kinds);
    have_energies = have_energies || energy;
    out[k] = energy ? kinds[S->sen_int[S->sen_int_ptr[i]]] : evaluate_sensor(in, i);
  }
}

void ali3_sensors_evaluate(const ali3_instance *in, double *out) { evaluate(in, in->system->size.ns, NULL, out); }

void ali3_sensors_some(const ali3_instance *in, int32_t n, const int32_t *number, double *out) {
  evaluate(in, n, number, out);
}

void ali3_record_row(const ali3_instance *in, int64_t row, double *out, double *positions) {
  const ali3_sizes *size = &in->system->size;
  if (out != NULL) ali3_sensors_evaluate(in, out + row * size->ns);
  if (positions != NULL) memcpy(positions + row * size->nq, in->now.q, (size_t)size->nq * sizeof *positions);
}
