/* Laws of elements compiled for vectors: a law evaluates one element of several instances (../lanes/kernels.h) or
 * several elements of one instance (element_batches.c). A converged lane is evaluated again with its last signals. */
#ifndef ALI3_LAWS_H
#define ALI3_LAWS_H

/* Elements with vector laws; those of the first list read no inputs, so that four of an instance can be evaluated
 * together. */
#define ALI3_LAWS_OF_SIGNALS(X) X(spring_damper) X(gyroscopic_spin) X(drag) X(tyre) X(spin_angle)
#define ALI3_LAWS(X) ALI3_LAWS_OF_SIGNALS(X) X(brake)

#ifdef ALI3_WIDTH
#include <string.h>

#include "../algebra/elementary.h"
#include "../instance.h"
#include "lane_road.h"

/* ali3_tanh in each lane. */
static inline real lane_tanh(real x) {
  for (int l = 0; l < ALI3_WIDTH; l++) x[l] = ali3_tanh(x[l]);
  return x;
}

#define ali3_road ali3_lane_road
static real lane_atan2(real y, real x);

#define ali3_tanh lane_tanh
#define ali3_atan2 lane_atan2

#include "../algebra/inverse_tangent.c"
#include "contact_law.c"
#include "end_stops.c"
#include "half_space.c"
#include "plane_and_kerb.c"
#include "tmeasy.c"
#include "tyre_bore.c"
#include "tyre_carcass.c"
#include "tyre_contact.c"

#define evaluate spring_damper_law
#include "spring_damper.c"
#undef evaluate
#define evaluate gyroscopic_spin_law
#include "gyroscopic_spin.c"
#undef evaluate
#define evaluate drag_law
#include "drag.c"
#undef evaluate
#define evaluate tyre_law
#include "tyre.c"
#undef evaluate
#define evaluate brake_law
#include "brake.c"
#undef evaluate
#define evaluate spin_angle_law
#include "spin_angle.c"
#undef evaluate

int ali3_road_contacts(const ali3_road *road, const real centre[3], const real axis[3], real radius,
                       ali3_contact out[2]) {
  if (road->type == ALI3_ROAD_PLANE || road->type == ALI3_ROAD_KERB)
    return ali3_plane_or_kerb_contacts(road->type, road->numbers, *road->friction_factor, centre, axis, radius, out);
  ali3_lane_contacts(road, ALI3_WIDTH, centre, axis, &radius, (real *)out);
  return 2;
}

/* The vector law of a type of elements; NULL: none. */
static ali3_element_function *law_of(const ali3_element_type *type) {
#define ALI3_LAW(name)                                                                                                 \
  if (type == &ali3_##name) return name##_law;
  ALI3_LAWS(ALI3_LAW)
#undef ALI3_LAW
  return NULL;
}

#undef ali3_road
#endif
#endif
