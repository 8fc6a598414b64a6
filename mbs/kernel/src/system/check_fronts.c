/* Checks fronts and rows of a System: every local index refers to its coordinate. */
#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"

enum { MAX_FRONT = 4096, MAX_FRONT_STORAGE = 1 << 26 };

/* Pivots come first and ascend below nq; the other coordinates are in the parent front at front_map. */
static ali3_status check_front(const ali3_system *s, int32_t f, ali3_message m) {
  const int32_t first = s->front_col[f], n_pivot = s->front_col[f + 1] - first, parent = s->front_parent[f];
  const int32_t *idx = s->front_idx + s->front_ptr[f], *map = s->front_map + s->front_ptr[f];
  const int32_t n = s->front_ptr[f + 1] - s->front_ptr[f];
  if (n_pivot < 1 || n < n_pivot || n > MAX_FRONT)
    return ali3_bad(m, "front %d has %d pivots of %d coordinates", (int)f, (int)n_pivot, (int)n);
  if ((int64_t)s->front_off[f + 1] - s->front_off[f] < (int64_t)n * n)
    return ali3_bad(m, "the storage of front %d is too small for %d coordinates", (int)f, (int)n);
  for (int32_t i = 0; i < n_pivot; i++)
    if (idx[i] != first + i || map[i] != -1)
      return ali3_bad(m, "pivot %d of front %d is not in its place", (int)i, (int)f);
  if (parent == -1 ? n != n_pivot : parent <= f) return ali3_bad(m, "front %d has parent %d", (int)f, (int)parent);
  for (int32_t i = n_pivot; i < n; i++) {
    const int32_t *parent_idx = s->front_idx + s->front_ptr[parent];
    const int32_t parent_n = s->front_ptr[parent + 1] - s->front_ptr[parent];
    if (idx[i] <= idx[i - 1]) return ali3_bad(m, "the coordinates of front %d do not ascend", (int)f);
    if (map[i] < 0 || map[i] >= parent_n || parent_idx[map[i]] != idx[i])
      return ali3_bad(m, "coordinate %d of front %d is not in its parent", (int)i, (int)f);
  }
  return ALI3_OK;
}

ali3_status ali3_check_fronts(ali3_system *s, ali3_message m) {
  const int32_t nf = s->size.nf, nq = s->size.nq;
  if (s->front_off[nf] > MAX_FRONT_STORAGE) return ali3_bad(m, "the fronts need %d numbers", (int)s->front_off[nf]);
  for (int32_t f = 0; f < nf; f++) CHECK(check_front(s, f, m));
  s->size.front_size = s->front_off[nf];
  int32_t f = 0;
  for (int32_t j = 0; j < nq; j++) { /* column j of the lower triangle lies in the front that eliminates j */
    while (j >= s->front_col[f + 1]) f++;
    const int32_t *idx = s->front_idx + s->front_ptr[f], n = s->front_ptr[f + 1] - s->front_ptr[f];
    if (n > s->max_front) s->max_front = n;
    for (int32_t k = s->mass_ptr[j]; k < s->mass_ptr[j + 1]; k++) {
      const int32_t i = s->mass_col[k]; /* entry (i, j) mirrors (j, i) */
      const int32_t mirror =
          s->mass_ptr[i] + ali3_find(s->mass_col + s->mass_ptr[i], s->mass_ptr[i + 1] - s->mass_ptr[i], j);
      if (mirror < s->mass_ptr[i]) return ali3_bad(m, "the mass matrix is not symmetric at (%d, %d)", (int)i, (int)j);
      if (i < j) continue;
      const int32_t local = ali3_find(idx, n, i);
      if (local < 0 || s->mass_pos[mirror] != s->front_off[f] + (j - s->front_col[f]) * n + local)
        return ali3_bad(m, "mass entry (%d, %d) has no place in front %d", (int)i, (int)j, (int)f);
      if (i > j && s->mass_pos[k] != -1)
        return ali3_bad(m, "mass entry (%d, %d) has a place above the diagonal", (int)j, (int)i);
    }
  }
  return ALI3_OK;
}

/* Checks that the coordinates of row k lie in its front. */
static ali3_status check_row_pattern(const ali3_system *s, int32_t k, ali3_message m) {
  const int32_t begin = s->row_ptr[k], end = s->row_ptr[k + 1], f = s->row_front[k];
  if (begin == end) return ali3_bad(m, "row %d has no coordinates", (int)k);
  const int32_t *idx = s->front_idx + s->front_ptr[f], n = s->front_ptr[f + 1] - s->front_ptr[f];
  for (int32_t i = begin; i < end; i++) {
    if (i > begin && s->row_col[i] <= s->row_col[i - 1])
      return ali3_bad(m, "the columns of row %d do not ascend", (int)k);
    if (s->row_loc[i] < 0 || s->row_loc[i] >= n || idx[s->row_loc[i]] != s->row_col[i])
      return ali3_bad(m, "coordinate %d of row %d is not in front %d", (int)s->row_col[i], (int)k, (int)f);
  }
  return ALI3_OK;
}

/* Checks a term h q_a q_b: 0 <= b <= a < n, or b = -1 (linear), or a = b = -1 (constant) where `low` allows them. */
static ali3_status check_term(ali3_message m, const char *name, int32_t a, int32_t b, int32_t n, int32_t low) {
  if (a < low || a >= n || b < low || b > a)
    return ali3_bad(m, "a term of '%s' multiplies entries %d and %d of a row with %d", name, (int)a, (int)b, (int)n);
  return ALI3_OK;
}

/* Terms of angles, which do not contain the angle itself. */
static ali3_status check_angles(const ali3_system *s, ali3_message m) {
  const int64_t na = s->n_angle_row;
  for (int64_t i = 0; i < na; i++) {
    const int32_t k = s->angle_row[i], n = s->row_ptr[k + 1] - s->row_ptr[k], theta = s->angle_theta[i];
    CHECK(ali3_check_indices(m, "angle_theta", &theta, 1, 0, n));
    for (int32_t t = s->angle_ptr[i]; t < s->angle_ptr[i + 1]; t++) {
      CHECK(check_term(m, "angle_a", s->angle_a[t], s->angle_b[t], n, -1));
      if (s->angle_a[t] == theta || s->angle_b[t] == theta)
        return ali3_bad(m, "the angle of row %d is within its own cosine or sine", (int)k);
    }
  }
  return ALI3_OK;
}

/* A switched row has no angle. */
static ali3_status check_switches(const ali3_system *s, ali3_message m) {
  for (int32_t i = 0; i < s->n_switch_start; i++) {
    int32_t k = 0;
    while (k < s->size.nc && s->row_switch[k] != i) k++;
    if (k == s->size.nc) return ali3_bad(m, "switch %d has no rows", (int)i);
  }
  for (int64_t i = 0; i < s->n_angle_row; i++)
    if (s->row_switch[s->angle_row[i]] >= 0) return ali3_bad(m, "the angle row %d has a switch", (int)s->angle_row[i]);
  return ALI3_OK;
}

/* A condition on velocities has no constant, no products of positions, no angle and no driving function. */
static ali3_status check_velocities(const ali3_system *s, ali3_message m) {
  const int64_t n = s->n_velocity_row;
  for (int64_t i = 0; i < n; i++) {
    const int32_t k = s->velocity_row[i], size = s->row_ptr[k + 1] - s->row_ptr[k];
    bool other = s->row_const[k] != 0.0 || s->quad_ptr[k + 1] > s->quad_ptr[k];
    if (i > 0 && k <= s->velocity_row[i - 1]) return ali3_bad(m, "'velocity_row' does not ascend at %d", (int)k);
    for (int64_t j = 0; j < s->n_angle_row; j++) other = other || s->angle_row[j] == k;
    for (int64_t t = 0; t < s->n_gterm_row; t++) other = other || s->gterm_row[t] == k;
    if (other) return ali3_bad(m, "the velocity row %d also has a condition on positions", (int)k);
    for (int32_t t = s->velocity_ptr[i]; t < s->velocity_ptr[i + 1]; t++) {
      CHECK(ali3_check_indices(m, "velocity_a", s->velocity_a + t, 1, 0, size));
      CHECK(ali3_check_indices(m, "velocity_b", s->velocity_b + t, 1, 0, size));
    }
  }
  return ALI3_OK;
}

ali3_status ali3_check_rows(const ali3_system *s, ali3_message m) {
  const int32_t nc = s->size.nc;
  if (s->n_fineness > 0 && !(s->fineness[0] > 0.0 && s->fineness[0] < 1e300))
    return ali3_bad(m, "the fineness is %g", s->fineness[0]);
  for (int32_t k = 0; k < nc; k++) {
    if (!(s->row_measure[k] > 0.0)) return ali3_bad(m, "the measure of row %d is %g", (int)k, s->row_measure[k]);
    CHECK(check_row_pattern(s, k, m));
    for (int32_t t = s->quad_ptr[k]; t < s->quad_ptr[k + 1]; t++)
      CHECK(check_term(m, "quad_a", s->quad_a[t], s->quad_b[t], s->row_ptr[k + 1] - s->row_ptr[k], 0));
  }
  CHECK(check_angles(s, m));
  CHECK(check_switches(s, m));
  const int64_t nt = s->n_gterm_row;
  for (int64_t t = 0; t < nt; t++) {
    const int32_t k = s->gterm_row[t];
    CHECK(check_term(m, "gterm_a", s->gterm_a[t], s->gterm_b[t], s->row_ptr[k + 1] - s->row_ptr[k], -1));
  }
  return check_velocities(s, m);
}
