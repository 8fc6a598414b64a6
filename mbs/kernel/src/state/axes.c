/* Axes of wheels whose direction on their carrier is set by parameters. The vectors f, g and e of a wheel are signals,
 * linear in the three axes of its carrier. An instance with the drawn axes uses the System as loaded; any other has a
 * copy of the System, `turned`, with its own coefficients, so that steps have equal cost. The diametral inertia I (1 -
 * e e') of the wheel, which is part of its carrier's, rotates with the axis. */
#include <string.h>

#include "../algebra/elementary.h"
#include "../lookup/lookup.h"
#include "../system/check.h"
#include "axes.h"

enum { X, Y, Z, AXES, REALS = ALI3_AXIS_REALS, SIGNALS = ALI3_AXIS_SIGNALS };
enum { AZIMUTH, ELEVATION }; /* rad: indices of the numbers of an axis in axis_parameter */
enum { MOMENTS = 4 }; /* first of the second moments xx, yy, zz, yz, zx, xy in ali3_lookup.mass */

void ali3_axes_place(const ali3_system *s, ali3_instance *in, ali3_pool *pool) {
  const ali3_system *T = s->turned;
  const size_t lookup = T != NULL ? (size_t)T->n_lookup : 0;
  in->parameters.axis_parameter = ali3_pool_array(pool, (size_t)s->n_axis_parameter);
  in->axes.system = T != NULL ? ali3_pool_items(pool, 1, sizeof *in->axes.system) : NULL;
  in->axes.val = ali3_pool_array(pool, T != NULL ? (size_t)T->n_sig_val : 0);
  in->axes.constant = ali3_pool_array(pool, T != NULL ? (size_t)T->n_sig_const : 0);
  in->axes.entry = ali3_pool_array(pool, T != NULL ? (size_t)T->el_entry_ptr[T->size.ne] : 0);
  in->axes.speed = ali3_pool_array(pool, T != NULL ? (size_t)T->n_pose_speed : 0);
  in->axes.lookup = ali3_pool_items(pool, lookup, sizeof *in->axes.lookup);
  in->axes.mass = ali3_pool_array(pool, lookup * ALI3_LOOKUP_MOMENTS);
}

/* Rotation matrix; columns: horizontal forward, along the axis, up in the plane of the wheel. */
static void axes_of(const double *angle, double R[AXES][AXES]) {
  const double ca = ali3_cos(angle[AZIMUTH]), sa = ali3_sin(angle[AZIMUTH]);
  const double ce = ali3_cos(angle[ELEVATION]), se = ali3_sin(angle[ELEVATION]);
  const double columns[AXES][AXES] = {{ca, sa, 0.0}, {-sa * ce, ca * ce, se}, {sa * se, -ca * se, ce}};
  for (int i = 0; i < AXES; i++)
    for (int k = 0; k < AXES; k++) R[i][k] = columns[k][i];
}

/* Rotation matrix from the drawn axes of wheel k to those that its parameters give. */
static void rotation_of(const ali3_instance *in, int64_t k, double Q[AXES][AXES]) {
  double now[AXES][AXES], drawn[AXES][AXES];
  axes_of(in->parameters.axis_parameter + REALS * k, now);
  axes_of(in->base->axis_parameter + REALS * k, drawn);
  for (int i = 0; i < AXES; i++)
    for (int j = 0; j < AXES; j++) {
      Q[i][j] = 0.0;
      for (int l = 0; l < AXES; l++) Q[i][j] += now[i][l] * drawn[j][l];
    }
}

/* out = Q v */
static void rotate(const double Q[AXES][AXES], const double *v, double out[AXES]) {
  for (int i = 0; i < AXES; i++) out[i] = Q[i][X] * v[X] + Q[i][Y] * v[Y] + Q[i][Z] * v[Z];
}

/* Compares numbers, not bits, as 0 has two signs. */
static bool equal(const double *one, const double *other, int64_t n) {
  for (int64_t i = 0; i < n; i++)
    if (one[i] != other[i]) return false;
  return true;
}

bool ali3_axis_as_drawn(const ali3_instance *in, int64_t k) {
  return equal(in->parameters.axis_parameter + REALS * k, in->base->axis_parameter + REALS * k, REALS);
}

void ali3_axis_moments(const ali3_instance *in, int64_t k, double change[3][3]) {
  const double inertia = in->base->axis_inertia[k], *drawn = in->base->axis_vector + SIGNALS * k + 2 * AXES;
  double Q[AXES][AXES], e[AXES];
  rotation_of(in, k, Q);
  rotate(Q, drawn, e);
  for (int i = 0; i < AXES; i++)
    for (int j = 0; j < AXES; j++) change[i][j] = inertia * (e[i] * e[j] - drawn[i] * drawn[j]);
}

/* Writes signal `to` as the sum of w times the signals of the carrier's axes, on whose coordinates it depends. */
static void write_signal(ali3_instance *in, int32_t to, const int32_t *frame, const double w[AXES]) {
  const ali3_system *T = in->base->turned;
  const int32_t first = T->sig_ptr[to], n = T->sig_ptr[to + 1] - first;
  memset(in->axes.val + first, 0, (size_t)n * sizeof(double));
  in->axes.constant[to] = 0.0;
  for (int j = 0; j < AXES; j++) {
    const int32_t from = frame[AXES * j];
    for (int32_t a = T->sig_ptr[from]; a < T->sig_ptr[from + 1]; a++)
      in->axes.val[first + ali3_find(T->sig_col + first, n, T->sig_col[a])] += w[j] * T->sig_val[a];
    in->axes.constant[to] += w[j] * T->sig_const[from];
  }
}

/* Writes the rotated signals of wheel k. */
static void write_signals(ali3_instance *in, int64_t k) {
  const ali3_system *T = in->base->turned;
  double Q[AXES][AXES], w[AXES];
  rotation_of(in, k, Q);
  for (int v = 0; v < 3; v++) {
    rotate(Q, T->axis_vector + SIGNALS * k + AXES * v, w);
    for (int x = 0; x < AXES; x++)
      write_signal(in, T->axis_signal[SIGNALS * k + AXES * v + x], T->axis_frame + SIGNALS * k + x, w);
  }
}

/* Copies the coefficients of the signals of all elements, one element after the other. */
static void write_entries(ali3_instance *in) {
  const ali3_system *T = in->base->turned;
  double *to = in->axes.entry;
  for (int64_t i = 0; i < T->n_el_sig; i++)
    for (int32_t k = T->sig_ptr[T->el_sig[i]]; k < T->sig_ptr[T->el_sig[i] + 1]; k++) *to++ = in->axes.val[k];
}

/* Adds the change of the moments of inertia of wheel k. */
static void write_moments(ali3_instance *in, int64_t k) {
  static const int entry[6][2] = {{X, X}, {Y, Y}, {Z, Z}, {Y, Z}, {Z, X}, {X, Y}};
  const int32_t table = in->base->axis_table[k];
  double change[AXES][AXES];
  if (table < 0) return;
  ali3_axis_moments(in, k, change);
  for (int i = 0; i < 6; i++)
    in->axes.mass[ALI3_LOOKUP_MOMENTS * table + MOMENTS + i] += change[entry[i][0]][entry[i][1]];
}

/* Writes the spin of wheel k for a start with a speed: it rolls, and its loaded radius increases with its
 * inclination. */
static void write_speed(ali3_instance *in, int64_t k) {
  const ali3_system *S = in->base;
  const double *radius = S->axis_rolling + 2 * k, *drawn = S->axis_parameter + REALS * k,
               *now = in->parameters.axis_parameter + REALS * k;
  if (!S->size.has_pose || !(radius[0] > 0.0)) return;
  const double loaded_radius =
      radius[0] + radius[1] * (1.0 / ali3_cos(now[ELEVATION]) - 1.0 / ali3_cos(drawn[ELEVATION]));
  in->axes.speed[S->axis_spin[k]] = ali3_cos(now[AZIMUTH]) * ali3_cos(now[ELEVATION]) / loaded_radius;
}

void ali3_axes_apply(ali3_instance *in) {
  const ali3_system *S = in->base, *T = S->turned;
  in->system = S;
  if (T == NULL || equal(in->parameters.axis_parameter, S->axis_parameter, S->n_axis_parameter)) return;
  memcpy(in->axes.val, T->sig_val, (size_t)T->n_sig_val * sizeof(double));
  memcpy(in->axes.constant, T->sig_const, (size_t)T->n_sig_const * sizeof(double));
  if (T->n_pose_speed > 0) memcpy(in->axes.speed, T->pose_speed, (size_t)T->n_pose_speed * sizeof(double));
  for (int32_t i = 0; i < T->n_lookup; i++) {
    double *mass = in->axes.mass + ALI3_LOOKUP_MOMENTS * i;
    memcpy(mass, T->lookup[i].mass, ALI3_LOOKUP_MOMENTS * sizeof(double));
    in->axes.lookup[i] = T->lookup[i];
    in->axes.lookup[i].mass = mass;
  }
  for (int64_t k = 0; k < S->n_axis_inertia; k++) {
    if (ali3_axis_as_drawn(in, k)) continue;
    write_signals(in, k);
    write_moments(in, k);
    write_speed(in, k);
  }
  write_entries(in);
  *in->axes.system = *T;
  in->axes.system->sig_val = in->axes.val;
  in->axes.system->sig_const = in->axes.constant;
  in->axes.system->el_entry_value = in->axes.entry;
  in->axes.system->lookup = in->axes.lookup;
  in->axes.system->pose_speed = in->axes.speed;
  in->system = in->axes.system;
}

bool ali3_axes_same(const ali3_instance *one, const ali3_instance *other) {
  return equal(one->parameters.axis_parameter, other->parameters.axis_parameter, one->base->n_axis_parameter);
}
