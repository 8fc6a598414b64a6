/* Contact of a disc with the half-space below a plane. */
#ifndef ALI3_HALF_SPACE_H
#define ALI3_HALF_SPACE_H
#include "road.h"

/* Below the plane through q with outward unit normal n. Returns the centre's distance along the disc. */
double ali3_half_space(const double centre[3], const double axis[3], double radius, const double q[3],
                       const double n[3], ali3_contact *out);
#endif
