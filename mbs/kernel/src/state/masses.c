/* Masses of an instance. The points of payloads are signals p = C q + c, so that a payload of mass m adds m C'C to the
 * mass matrix, m C'g to the force of gravity and -m g.c to its energy. A body with inertia set by parameters is in the
 * matrix of the System as drawn; the change of its moments over (1, position) is added in the same way, between
 * signals. An armature that rotates r times as fast as a coordinate adds J r^2, of which the System includes that of
 * the drawn ratio. */
#include <math.h>
#include <string.h>

#include "../system/check.h"
#include "../system/loading.h"
#include "../tree/tree.h"
#include "axes.h"
#include "masses.h"

/* Whether a parameter can change a mass. */
static bool has_changes(const ali3_system *s) {
  return s->n_payload_mass > 0 || s->n_armature_ratio > 0 || s->n_inertia_parameter > 0 || s->n_axis_inertia > 0;
}

void ali3_masses_place(const ali3_system *s, ali3_instance *in, ali3_pool *pool) {
  const bool changing = has_changes(s);
  const size_t nq = changing ? (size_t)s->size.nq : 0;
  in->parameters.payload_mass = ali3_pool_array(pool, (size_t)s->n_payload_mass);
  in->parameters.armature_ratio = ali3_pool_array(pool, (size_t)s->n_armature_ratio);
  in->parameters.inertia_parameter = ali3_pool_array(pool, (size_t)s->n_inertia_parameter);
  in->mass.own.val = ali3_pool_array(pool, changing ? (size_t)s->size.nnz_mass : 0);
  in->mass.own.front = ali3_pool_array(pool, changing ? (size_t)s->size.front_size : 0);
  in->mass.own.floor = ali3_pool_array(pool, nq);
  in->mass.own.floor_inverse = ali3_pool_array(pool, nq);
  in->mass.own.missing = ali3_pool_array(pool, nq);
  in->mass.own.gravity = ali3_pool_array(pool, nq);
}

void ali3_masses_start(ali3_instance *in) {
  const ali3_system *S = in->system;
  const ali3_own_masses *own = &in->mass.own;
  const bool changing = has_changes(S);
  in->mass.val = changing ? own->val : S->mass_val;
  in->mass.isotropic = true;
  in->mass.front = changing ? own->front : S->front_mass;
  in->mass.floor = changing ? own->floor : S->mass_floor;
  in->mass.floor_inverse = changing ? own->floor_inverse : S->mass_floor_inverse;
  in->mass.missing = changing ? own->missing : S->mass_missing;
  in->mass.gravity = changing ? own->gravity : S->gravity_force;
  in->mass.gravity_const = S->gravity_const[0];
}

/* Adds a mass on a signal with component g of gravity. */
static void add_point_mass(ali3_instance *in, int32_t signal, double mass, double g) {
  const ali3_system *S = in->system;
  const int32_t first = S->sig_ptr[signal], end = S->sig_ptr[signal + 1];
  for (int32_t a = first; a < end; a++) {
    const int32_t row = S->sig_col[a], start = S->mass_ptr[row];
    for (int32_t b = first; b < end; b++) {
      const int32_t at = ali3_find(S->mass_col + start, S->mass_ptr[row + 1] - start, S->sig_col[b]);
      in->mass.own.val[start + at] += mass * (S->sig_val[a] * S->sig_val[b]);
    }
    in->mass.own.gravity[row] += mass * g * S->sig_val[a];
  }
  in->mass.gravity_const -= mass * g * S->sig_const[signal];
}

/* Adds a moment of mass between the signals of two vectors. */
static void add_moment(ali3_instance *in, int32_t one, int32_t other, double moment) {
  const ali3_system *S = in->system;
  for (int32_t a = S->sig_ptr[one]; a < S->sig_ptr[one + 1]; a++) {
    const int32_t row = S->sig_col[a], start = S->mass_ptr[row], n = S->mass_ptr[row + 1] - start;
    for (int32_t b = S->sig_ptr[other]; b < S->sig_ptr[other + 1]; b++)
      in->mass.own.val[start + ali3_find(S->mass_col + start, n, S->sig_col[b])] +=
          moment * (S->sig_val[a] * S->sig_val[b]);
  }
}

/* Moments of a body (an item of inertia_parameter) over (1, position from `origin`): mass, first moments, and second
 * moments tr(I)/2 - I of its inertia about the centre of mass, transferred to the origin. */
static void moments(const double *inertia, const double *origin, double out[4][4]) {
  static const int product[3][3] = {{4, 7, 8}, {7, 5, 9}, {8, 9, 6}}; /* indices of the entries of the tensor */
  const double mass = inertia[0], half = 0.5 * (inertia[4] + inertia[5] + inertia[6]);
  out[0][0] = mass;
  for (int i = 0; i < 3; i++) {
    const double arm = inertia[1 + i] - origin[i];
    out[0][1 + i] = out[1 + i][0] = mass * arm;
    for (int j = 0; j < 3; j++)
      out[1 + i][1 + j] = (i == j ? half : 0.0) - inertia[product[i][j]] + mass * arm * (inertia[1 + j] - origin[j]);
  }
}

/* Adds the change of the inertia of body k to the mass matrix, if it differs from the System's. */
static void apply_inertia(ali3_instance *in, int64_t k) {
  const ali3_system *S = in->system;
  const double *old = S->inertia_parameter + k * ALI3_INERTIA_REALS,
               *now = in->parameters.inertia_parameter + k * ALI3_INERTIA_REALS;
  const int32_t *signal = S->inertia_signal + k * ALI3_INERTIA_SIGNALS;
  double before[4][4], after[4][4];
  if (memcmp(old, now, ALI3_INERTIA_REALS * sizeof(double)) == 0) return;
  moments(old, old + 1, before);
  moments(now, old + 1, after);
  for (int v = 0; v < 4; v++)
    for (int x = 0; x < 3; x++) {
      const int32_t own = signal[3 * v + x];
      const double first = (after[0][v] - before[0][v]) * S->inertia_gravity[x];
      for (int w = 0; w < 4; w++) add_moment(in, own, signal[3 * w + x], after[v][w] - before[v][w]);
      for (int32_t a = S->sig_ptr[own]; a < S->sig_ptr[own + 1]; a++)
        in->mass.own.gravity[S->sig_col[a]] += first * S->sig_val[a];
      in->mass.gravity_const -= first * S->sig_const[own];
    }
}

/* Adds the change of an armature's ratio to the mass matrix. */
static void apply_armature(ali3_instance *in, int64_t k) {
  const ali3_system *S = in->system;
  const int32_t row = S->armature_col[k], start = S->mass_ptr[row];
  double *mass = in->mass.own.val + start + ali3_find(S->mass_col + start, S->mass_ptr[row + 1] - start, row);
  const double old = S->armature_ratio[k], now = in->parameters.armature_ratio[k];
  *mass = fmax(*mass + S->armature_inertia[k] * (now * now - old * old), 0.0);
}

/* Adds the change by the axis of wheel k on its carrier to the mass matrix, if it differs from the drawing and the
 * carrier is no lookup-table body. */
static void apply_axis(ali3_instance *in, int64_t k) {
  const ali3_system *S = in->base;
  const int32_t *frame = S->axis_frame + k * ALI3_AXIS_SIGNALS;
  double change[3][3];
  if (S->axis_table[k] >= 0 || ali3_axis_as_drawn(in, k)) return;
  ali3_axis_moments(in, k, change);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int x = 0; x < 3; x++) add_moment(in, frame[3 * i + x], frame[3 * j + x], change[i][j]);
}

/* Mass carried by each joint of the tree, including payloads. */
static void sum_carried_mass(ali3_instance *in) {
  const ali3_tree *T = in->system->tree;
  double *carried = in->tree->composite;
  memcpy(carried, T->composite, sizeof T->composite);
  for (int64_t k = 0; k < in->system->n_tree_payload_body; k++)
    for (int32_t b = in->system->tree_payload_body[k]; b > 0; b = T->parent[b])
      carried[b] += in->parameters.payload_mass[k];
}

void ali3_masses_apply(ali3_instance *in) {
  const ali3_system *S = in->system;
  const ali3_own_masses *own = &in->mass.own;
  if (S->tree != NULL) sum_carried_mass(in);
  if (!has_changes(S)) return;
  memcpy(own->val, S->mass_val, (size_t)S->size.nnz_mass * sizeof(double));
  memcpy(own->gravity, S->gravity_force, (size_t)S->size.nq * sizeof(double));
  in->mass.gravity_const = S->gravity_const[0];
  for (int64_t i = 0; i < 3 * S->n_payload_mass; i++)
    if (in->parameters.payload_mass[i / 3] > 0.0)
      add_point_mass(in, S->payload_signal[i], in->parameters.payload_mass[i / 3], S->payload_gravity[i % 3]);
  for (int64_t k = 0; k < S->n_armature_ratio; k++) apply_armature(in, k);
  for (int64_t k = 0; k < S->n_inertia_parameter / ALI3_INERTIA_REALS; k++) apply_inertia(in, k);
  for (int64_t k = 0; k < S->n_axis_inertia; k++) apply_axis(in, k);
  in->mass.isotropic = ali3_mass_isotropic(S, own->val);
  ali3_mass_in_fronts(S, own->val, own->front, own->floor, own->floor_inverse, own->missing);
}
