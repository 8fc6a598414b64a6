/* Relative angles of a tree: an angle is its value at zero joint coordinates plus their sum with signs, as all joints
 * rotate about the axis of the angle. So no angle has to be unwrapped. */
#include "../system.h"
#include "tree.h"

/* Sum of the joint coordinates (or rates) x of angle a, with their signs. */
static double joint_sum(const ali3_system *S, int32_t a, const double *x) {
  double value = 0.0;
  for (int32_t k = S->tree_angle_ptr[a]; k < S->tree_angle_ptr[a + 1]; k++)
    value += S->tree_angle_sign[k] * x[S->tree_angle_joint[k] - 1];
  return value;
}

void ali3_angles_read(const ali3_system *S, ali3_tree_work *w, const double *q) {
  for (int32_t a = 0; a < S->tree->n_angle; a++) w->turned[a] = q[S->tree_angle_col[a]] - joint_sum(S, a, w->state);
}

void ali3_angles_turn(const ali3_system *S, ali3_tree_work *w, int32_t joint, double angle) {
  for (int32_t a = 0; a < S->tree->n_angle; a++)
    for (int32_t k = S->tree_angle_ptr[a]; k < S->tree_angle_ptr[a + 1]; k++)
      if (S->tree_angle_joint[k] == joint) w->turned[a] += S->tree_angle_sign[k] * angle;
}

void ali3_angles_write(const ali3_system *S, const ali3_tree_work *w, double *q, double *qd, double *qdd) {
  for (int32_t a = 0; a < S->tree->n_angle; a++) {
    const int32_t column = S->tree_angle_col[a];
    q[column] = w->turned[a] + joint_sum(S, a, w->q + 1);
    if (qd != NULL) qd[column] = joint_sum(S, a, w->qd + 1);
    if (qdd != NULL) qdd[column] = joint_sum(S, a, w->qdd);
  }
}

void ali3_angles_load(const ali3_system *S, ali3_tree_work *w, const double *Q) {
  for (int32_t a = 0; a < S->tree->n_angle; a++)
    for (int32_t k = S->tree_angle_ptr[a]; k < S->tree_angle_ptr[a + 1]; k++)
      w->load[S->tree_angle_joint[k]] += S->tree_angle_sign[k] * Q[S->tree_angle_col[a]];
}

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
