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

/* Product of friction and its factor; 0 if negative or NaN. */
static inline real ali3_friction_product(real factor, real friction) {
  const real product = factor * friction;
  return ali3_where(product > 0.0, product, ali3_same(0.0));
}
#endif
