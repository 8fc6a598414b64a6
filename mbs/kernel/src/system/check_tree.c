/* Checks the tree of a System: parents before children, cut joints, and that nothing but joints constrains its
 * bodies. */
#include "../instance.h"
#include "../tree/tree.h"
#include "check.h"
#include "loading.h"
#include "message.h"

/* Rows and bodies of the cut joints; n: joints. */
static ali3_status check_cuts(const ali3_system *s, int64_t n, ali3_message m) {
  const int64_t cuts = s->n_tree_cut_body / 2;
  int64_t rows = 0;
  for (int64_t c = 0; c < cuts; c++) {
    CHECK(ali3_check_indices(m, "tree_cut_rows", s->tree_cut_rows + 2 * c, 1, 0, 4));
    CHECK(ali3_check_indices(m, "tree_cut_rows", s->tree_cut_rows + 2 * c + 1, 1, 0, 3));
    rows += s->tree_cut_rows[2 * c] + s->tree_cut_rows[2 * c + 1];
    if (rows > ALI3_MAX_CUT_ROWS)
      return ali3_bad(m, "the cut joints of the tree have more than %d rows", ALI3_MAX_CUT_ROWS);
  }
  if (rows + 4 * n + 1 + s->n_tree_angle_col > (1 + ALI3_PAST) * (int64_t)s->size.nq)
    return ali3_bad(m, "a tree of %lld joints for %d coordinates", (long long)n, (int)s->size.nq);
  return ALI3_OK;
}

/* Whether joint j is on the path from joint k to the ground. */
static bool on_path(const ali3_system *s, int32_t j, int32_t k) {
  while (k > j) k = s->tree_parent[k - 1];
  return j == k;
}

/* Relative angles; one with inertia has its joints on one path. */
static ali3_status check_angles(const ali3_system *s, ali3_message m) {
  const int64_t angles = s->n_tree_angle_col;
  if (angles > ALI3_MAX_ANGLES) return ali3_bad(m, "the tree has %lld angles", (long long)angles);
  for (int64_t a = 0; a < angles; a++)
    for (int32_t k = s->tree_angle_ptr[a]; s->tree_angle_inertia[a] != 0.0 && k < s->tree_angle_ptr[a + 1]; k++)
      for (int32_t i = s->tree_angle_ptr[a]; i < k; i++) {
        const int32_t x = s->tree_angle_joint[i], y = s->tree_angle_joint[k];
        if (!on_path(s, x < y ? x : y, x < y ? y : x))
          return ali3_bad(m, "angle %lld of the tree has inertia on two branches", (long long)a);
      }
  return ALI3_OK;
}

/* Checks that the components of points and vectors and the angles are as many as the coordinates. */
static ali3_status check_coordinates(const ali3_system *s, ali3_message m) {
  const int64_t parts = s->n_tree_out_body;
  int64_t referenced = s->n_tree_angle_col;
  for (int64_t i = 0; i < 3 * parts; i++) referenced += s->tree_out_col[i] >= 0;
  if (referenced != s->size.nq)
    return ali3_bad(m, "the bodies of the tree name %lld coordinates of %d", (long long)referenced, (int)s->size.nq);
  return ALI3_OK;
}

ali3_status ali3_check_tree(const ali3_system *s, ali3_message m) {
  const int64_t n = s->n_tree_parent;
  if (n > ALI3_MAX_JOINTS) return ali3_bad(m, "the tree has %lld joints", (long long)n);
  for (int64_t b = 0; b < n; b++) CHECK(ali3_check_indices(m, "tree_parent", s->tree_parent + b, 1, 0, b + 1));
  if (n == 0) return ALI3_OK;
  if (s->size.ng > 0 || s->size.n_switch > 0 || s->n_flex_front > 0 || s->n_velocity_row > 0)
    return ali3_bad(m,
                    "a tree is combined with driving functions, switches, conditions on velocities or flexible bodies");
  CHECK(check_angles(s, m));
  CHECK(check_cuts(s, n, m));
  return check_coordinates(s, m);
}
