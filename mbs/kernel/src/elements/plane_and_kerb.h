/* Contacts of a disc with a plane or a kerb. */
#ifndef ALI3_PLANE_AND_KERB_H
#define ALI3_PLANE_AND_KERB_H
#include "road.h"

/* Indices into the numbers of a plane and a kerb: lengths in m, grades dz/dx and dz/dy, side 1 or -1, friction and its
 * factor. */
enum { PLANE_HEIGHT, PLANE_GRADE_X, PLANE_GRADE_Y, PLANE_FRICTION, PLANE_FACTOR, PLANE_REALS };
enum { KERB_X, KERB_LOWER, KERB_STEP, KERB_SIDE, KERB_FRICTION, KERB_FACTOR, KERB_REALS };

/* ali3_road_contacts for ALI3_ROAD_PLANE and ALI3_ROAD_KERB: writes one or two contacts and returns their number. */
ALI3_PER_WIDTH int ali3_plane_or_kerb_contacts(int32_t type, const real *p, real friction_factor, const real centre[3],
                                               const real axis[3], real radius, ali3_contact out[2]);

/* Unit normal n of a plane, upwards, and a point q of it, m. */
static inline void ali3_plane_frame(const real *p, real n[3], real q[3]) {
  const real size = ali3_sqrt(1.0 + p[PLANE_GRADE_X] * p[PLANE_GRADE_X] + p[PLANE_GRADE_Y] * p[PLANE_GRADE_Y]);
  n[0] = -p[PLANE_GRADE_X] / size, n[1] = -p[PLANE_GRADE_Y] / size, n[2] = 1.0 / size;
  q[0] = q[1] = ali3_same(0.0), q[2] = p[PLANE_HEIGHT];
}

/* Product of friction and its factor; 0 if negative or NaN. */
static inline real ali3_friction_product(real factor, real friction) {
  const real product = factor * friction;
  return ali3_where(product > 0.0, product, ali3_same(0.0));
}
#endif
