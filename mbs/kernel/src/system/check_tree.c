/* Tree of a System: lengths, parents before children, places, and that nothing else moves the bodies. */
#include "../instance.h"
#include "../tree/tree.h"
#include "check.h"
#include "loading.h"
#include "message.h"

static ali3_status check_cuts(const ali3_system *s, int64_t n, ali3_message m) {
  const int64_t cuts = s->n_tree_cut_body / 2;
  int64_t rows = 0;
  CHECK(ali3_check_length(m, "tree_cut_body", s->n_tree_cut_body, 2 * cuts));
  CHECK(ali3_check_length(m, "tree_cut_rows", s->n_tree_cut_rows, 2 * cuts));
  CHECK(ali3_check_length(m, "tree_cut_place", s->n_tree_cut_place, 15 * cuts));
  CHECK(ali3_check_indices(m, "tree_cut_body", s->tree_cut_body, 2 * cuts, 0, n + 1));
  for (int64_t c = 0; c < cuts; c++) {
    CHECK(ali3_check_indices(m, "tree_cut_rows", s->tree_cut_rows + 2 * c, 1, 0, 4));
    CHECK(ali3_check_indices(m, "tree_cut_rows", s->tree_cut_rows + 2 * c + 1, 1, 0, 3));
    rows += s->tree_cut_rows[2 * c] + s->tree_cut_rows[2 * c + 1];
    if (rows > ALI3_MOST_CUT_ROWS)
      return ali3_bad(m, "the cut joints of the tree have more than %d rows", ALI3_MOST_CUT_ROWS);
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

static ali3_status check_angles(const ali3_system *s, int64_t n, ali3_message m) {
  const int64_t angles = s->n_tree_angle_col;
  if (angles > ALI3_MOST_ANGLES) return ali3_bad(m, "the tree has %lld angles", (long long)angles);
  CHECK(ali3_check_length(m, "tree_angle_inertia", s->n_tree_angle_inertia, angles));
  CHECK(ali3_check_length(m, "tree_angle_sign", s->n_tree_angle_sign, s->n_tree_angle_joint));
  CHECK(
      ali3_check_pointers(m, "tree_angle_ptr", s->tree_angle_ptr, s->n_tree_angle_ptr, angles, s->n_tree_angle_joint));
  CHECK(ali3_check_indices(m, "tree_angle_col", s->tree_angle_col, angles, 0, s->size.nq));
  CHECK(ali3_check_indices(m, "tree_angle_joint", s->tree_angle_joint, s->n_tree_angle_joint, 1, n + 1));
  for (int64_t a = 0; a < angles; a++)
    for (int32_t k = s->tree_angle_ptr[a]; s->tree_angle_inertia[a] != 0.0 && k < s->tree_angle_ptr[a + 1]; k++)
      for (int32_t i = s->tree_angle_ptr[a]; i < k; i++) {
        const int32_t x = s->tree_angle_joint[i], y = s->tree_angle_joint[k];
        if (!on_path(s, x < y ? x : y, x < y ? y : x))
          return ali3_bad(m, "angle %lld of the tree has inertia on two branches", (long long)a);
      }
  return ALI3_OK;
}

/* As many components of points and vectors, and angles, as there are coordinates. */
static ali3_status check_coordinates(const ali3_system *s, int64_t n, ali3_message m) {
  const int64_t parts = s->n_tree_out_body;
  CHECK(ali3_check_length(m, "tree_out_local", s->n_tree_out_local, 4 * parts));
  CHECK(ali3_check_length(m, "tree_out_col", s->n_tree_out_col, 3 * parts));
  CHECK(ali3_check_indices(m, "tree_out_body", s->tree_out_body, parts, 1, n + 1));
  CHECK(ali3_check_indices(m, "tree_out_col", s->tree_out_col, 3 * parts, -1, s->size.nq));
  int64_t named = s->n_tree_angle_col;
  for (int64_t i = 0; i < 3 * parts; i++) named += s->tree_out_col[i] >= 0;
  if (named != s->size.nq)
    return ali3_bad(m, "the bodies of the tree name %lld coordinates of %d", (long long)named, (int)s->size.nq);
  return ALI3_OK;
}

ali3_status ali3_check_tree(const ali3_system *s, ali3_message m) {
  const int64_t n = s->n_tree_parent;
  if (n > ALI3_MOST_JOINTS) return ali3_bad(m, "the tree has %lld joints", (long long)n);
  CHECK(ali3_check_length(m, "tree_slides", s->n_tree_slides, n));
  CHECK(ali3_check_length(m, "tree_base", s->n_tree_base, 12 * n));
  CHECK(ali3_check_length(m, "tree_mass", s->n_tree_mass, n));
  CHECK(ali3_check_length(m, "tree_centre", s->n_tree_centre, 3 * n));
  CHECK(ali3_check_length(m, "tree_inertia", s->n_tree_inertia, 9 * n));
  CHECK(ali3_check_length(m, "tree_frame", s->n_tree_frame, 12 * n));
  CHECK(ali3_check_length(m, "tree_gravity", s->n_tree_gravity, n > 0 ? 3 : 0));
  CHECK(ali3_check_indices(m, "tree_slides", s->tree_slides, n, 0, 2));
  CHECK(ali3_check_indices(m, "tree_frame", s->tree_frame, 12 * n, 0, s->size.nsig));
  const int64_t payloads = n > 0 ? s->n_payload_mass : 0;
  CHECK(ali3_check_length(m, "tree_payload_body", s->n_tree_payload_body, payloads));
  CHECK(ali3_check_length(m, "tree_payload_place", s->n_tree_payload_place, 3 * payloads));
  CHECK(ali3_check_indices(m, "tree_payload_body", s->tree_payload_body, payloads, 1, n + 1));
  for (int64_t b = 0; b < n; b++) CHECK(ali3_check_indices(m, "tree_parent", s->tree_parent + b, 1, 0, b + 1));
  if (n == 0) {
    CHECK(ali3_check_length(m, "tree_out_body", s->n_tree_out_body, 0));
    CHECK(ali3_check_length(m, "tree_out_local", s->n_tree_out_local, 0));
    CHECK(ali3_check_length(m, "tree_out_col", s->n_tree_out_col, 0));
    CHECK(ali3_check_length(m, "tree_cut_body", s->n_tree_cut_body, 0));
    CHECK(ali3_check_length(m, "tree_cut_rows", s->n_tree_cut_rows, 0));
    CHECK(ali3_check_length(m, "tree_angle_col", s->n_tree_angle_col, 0));
    CHECK(ali3_check_length(m, "tree_angle_ptr", s->n_tree_angle_ptr, 0));
    CHECK(ali3_check_length(m, "tree_angle_joint", s->n_tree_angle_joint, 0));
    CHECK(ali3_check_length(m, "tree_angle_sign", s->n_tree_angle_sign, 0));
    CHECK(ali3_check_length(m, "tree_angle_inertia", s->n_tree_angle_inertia, 0));
    return ali3_check_length(m, "tree_cut_place", s->n_tree_cut_place, 0);
  }
  if (s->size.ng > 0 || s->size.n_switch > 0 || s->n_flex_front > 0 || s->n_velocity_row > 0)
    return ali3_bad(m, "a tree beside guides, switches, conditions on velocities or flexible bodies");
  CHECK(check_angles(s, n, m));
  CHECK(check_cuts(s, n, m));
  return check_coordinates(s, n, m);
}
