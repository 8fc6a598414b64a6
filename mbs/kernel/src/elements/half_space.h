/* Contact of a disc with the half-space below a plane. */
#ifndef ALI3_HALF_SPACE_H
#define ALI3_HALF_SPACE_H
#include "road.h"

/* The half-space below the plane through q with outward unit normal n. Returns the distance of the centre in the disc,
 * m. */
ALI3_PER_WIDTH real ali3_half_space(const real centre[3], const real axis[3], real radius, const real q[3],
                                    const real n[3], ali3_contact *out);
#endif
