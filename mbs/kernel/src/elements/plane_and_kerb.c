/* Contacts of a disc with a plane and with a kerb. */
#include "plane_and_kerb.h"

#include <stddef.h>

#include "../algebra/small_vectors.h"
#include "half_space.h"

#define FLATTEST 0.05 /* least cosine at an edge, as it is a divisor */

/* Contact with a plane. */
static int find_plane_contact(const real *p, const real centre[3], const real axis[3], real radius, ali3_contact *out) {
  real n[3], q[3];
  ali3_plane_frame(p, n, q);
  ali3_half_space(centre, axis, radius, q, n, out);
  out->friction = p[PLANE_FRICTION];
  return 1;
}

/* Contact with the line x = edge[0], z = edge[2]. False if the wheel plane is nearly parallel to it. */
static lane_mask find_edge_contact(const real centre[3], const real axis[3], real radius, const real edge[3],
                                   ali3_contact *out) {
  const real none = {0};
  real offset[3] = {edge[0] - centre[0], none, edge[2] - centre[2]};
  offset[1] = -(offset[0] * axis[0] + offset[2] * axis[2]) / axis[1];
  const real distance = ali3_norm(offset);
  /* gradient of the distance by the centre; its component along the edge is 0 */
  const real g[3] = {(offset[1] * axis[0] / axis[1] - offset[0]) / distance, none,
                     (offset[1] * axis[2] / axis[1] - offset[2]) / distance};
  const real size = ali3_norm(g);
  out->penetration = radius - distance;
  out->cosine = ali3_where(1.0 / size > FLATTEST, 1.0 / size, ali3_same(FLATTEST));
  out->leaning = ali3_same(1.0);
  for (int i = 0; i < 3; i++) {
    out->normal[i] = g[i] / size;
    out->down[i] = offset[i] / distance;
    out->point[i] = centre[i] + offset[i];
  }
  return ali3_not((ali3_abs(axis[1]) < 1e-6) | (distance < 1e-9));
}

/* Copies `from` to *to in the lanes of `mask`. */
static void replace_where(lane_mask mask, const ali3_contact *from, ali3_contact *to) {
  const real *x = (const real *)from;
  real *y = (real *)to;
  for (size_t i = 0; i < sizeof *to / sizeof *y; i++) y[i] = ali3_where(mask, x[i], y[i]);
}

/* First contact: the upper quarter space (the nearest of plane, edge and face, with a C1 distance); second: the lower
 * plane. Where the wheel plane misses the edge, only the lower plane, as the first contact. */
static int find_kerb_contacts(const real *p, const real centre[3], const real axis[3], real radius,
                              ali3_contact out[2]) {
  const real none = {0}, one = ali3_same(1.0), side = ali3_where(p[KERB_SIDE] >= 0.0, one, -one);
  const real edge[3] = {p[KERB_X], none, p[KERB_LOWER] + p[KERB_STEP]}, low[3] = {none, none, p[KERB_LOWER]};
  const real up[3] = {none, none, one}, face[3] = {side, none, none};
  const real above = centre[2] - edge[2], ahead = side * (centre[0] - edge[0]);
  ali3_contact other;
  ali3_half_space(centre, axis, radius, edge, up, &other);
  ali3_half_space(centre, axis, radius, edge, face, &out[0]);
  const lane_mask is_above = above > 0.0, is_ahead = ahead > 0.0;
  const lane_mask top = (is_above & (side * (other.point[0] - edge[0]) <= 0.0)) |
                        (ali3_not(is_above) & (ahead <= 0.0) & (above >= ahead));
  const lane_mask in_front = (is_ahead & (out[0].point[2] <= edge[2])) | (ali3_not(is_ahead) & (above <= 0.0));
  const lane_mask corner = ali3_not(top | in_front);
  replace_where(top, &other, &out[0]);
  ali3_half_space(centre, axis, radius, low, up, &out[1]);
  lane_mask misses = {0};
  if (ali3_any(corner)) {
    misses = corner & ali3_not(find_edge_contact(centre, axis, radius, edge, &other));
    replace_where(corner, &other, &out[0]);
    replace_where(misses, &out[1], &out[0]);
  }
  for (int i = 0; i < 2; i++) out[i].friction = p[KERB_FRICTION];
  if (ali3_any(misses)) {
    const ali3_contact nothing = ali3_no_contact();
    replace_where(misses, &nothing, &out[1]);
  }
  return ali3_any(ali3_not(misses)) ? 2 : 1;
}

int ali3_plane_or_kerb_contacts(int32_t type, const real *p, real friction_factor, const real centre[3],
                                const real axis[3], real radius, ali3_contact out[2]) {
  const int count = type == ALI3_ROAD_PLANE ? find_plane_contact(p, centre, axis, radius, out)
                                            : find_kerb_contacts(p, centre, axis, radius, out);
  for (int i = 0; i < count; i++) {
    out[i].friction = ali3_friction_product(friction_factor, out[i].friction);
    out[i].yielded = out[i].switching = ali3_same(0.0);
  }
  return count;
}
