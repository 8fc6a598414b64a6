/* Relative angles of a tree: an angle is where it is when its joints are at zero, plus the sum of their coordinates,
 * each with its sign, because all of them turn about the axis of the angle. Nothing has to be wrapped or unwrapped. */
#include "../system.h"
#include "tree.h"

static double sum(const ali3_system *S, int32_t a, const double *x) {
  double value = 0.0;
  for (int32_t k = S->tree_angle_ptr[a]; k < S->tree_angle_ptr[a + 1]; k++)
    value += S->tree_angle_sign[k] * x[S->tree_angle_joint[k] - 1];
  return value;
}

/* w->turned from natural coordinates q and the relative ones in w->state. */
void ali3_angles_read(const ali3_system *S, ali3_tree_work *w, const double *q) {
  for (int32_t a = 0; a < S->tree->n_angle; a++) w->turned[a] = q[S->tree_angle_col[a]] - sum(S, a, w->state);
}

/* A joint's coordinate has lost an angle; those of the System go on. */
void ali3_angles_turn(const ali3_system *S, ali3_tree_work *w, int32_t joint, double angle) {
  for (int32_t a = 0; a < S->tree->n_angle; a++)
    for (int32_t k = S->tree_angle_ptr[a]; k < S->tree_angle_ptr[a + 1]; k++)
      if (S->tree_angle_joint[k] == joint) w->turned[a] += S->tree_angle_sign[k] * angle;
}

/* At w->q, w->qd and w->qdd; qd and qdd may be NULL. */
void ali3_angles_write(const ali3_system *S, const ali3_tree_work *w, double *q, double *qd, double *qdd) {
  for (int32_t a = 0; a < S->tree->n_angle; a++) {
    const int32_t column = S->tree_angle_col[a];
    q[column] = w->turned[a] + sum(S, a, w->q + 1);
    if (qd != NULL) qd[column] = sum(S, a, w->qd + 1);
    if (qdd != NULL) qdd[column] = sum(S, a, w->qdd);
  }
}

/* Generalised forces of the angles on their joints. */
void ali3_angles_load(const ali3_system *S, ali3_tree_work *w, const double *Q) {
  for (int32_t a = 0; a < S->tree->n_angle; a++)
    for (int32_t k = S->tree_angle_ptr[a]; k < S->tree_angle_ptr[a + 1]; k++)
      w->load[S->tree_angle_joint[k]] += S->tree_angle_sign[k] * Q[S->tree_angle_col[a]];
}

/* Inertia that turns with an angle, in the lower triangle of M; its joints are on one path. */
void ali3_angles_mass(const ali3_system *S, ali3_tree_work *w) {
  for (int32_t a = 0; a < S->tree->n_angle; a++) {
    if (S->tree_angle_inertia[a] == 0.0) continue;
    for (int32_t k = S->tree_angle_ptr[a]; k < S->tree_angle_ptr[a + 1]; k++)
      for (int32_t m = S->tree_angle_ptr[a]; m < S->tree_angle_ptr[a + 1]; m++)
        if (S->tree_angle_joint[m] <= S->tree_angle_joint[k])
          w->mass[S->tree_angle_joint[k]][S->tree_angle_joint[m]] +=
              S->tree_angle_inertia[a] * S->tree_angle_sign[k] * S->tree_angle_sign[m];
  }
}
