/* Contacts of several discs, one after the other, with roads without a vector law. */
#include "lane_road.h"

#include <stddef.h>

#include "../algebra/finite.h"
#include "road.h"

void ali3_lane_contacts(const ali3_lane_road *road, int32_t width, const real *centre, const real *axis,
                        const real *radius, real *contacts) {
  enum { NUMBERS = sizeof(ali3_contact) / sizeof(double) };
  for (int32_t l = 0; l < width; l++) {
    ali3_contact contact[2];
    double disc[7]; /* centre, axis, radius */
    for (int32_t i = 0; i < 3; i++) disc[i] = centre[i * width + l], disc[3 + i] = axis[i * width + l];
    disc[6] = radius[l];
    const bool valid = road->lane[l] != NULL && ali3_finite(disc, 7); /* a failed lane has no position */
    const int count = valid ? ali3_road_contacts(road->lane[l], disc, disc + 3, disc[6], contact) : 0;
    for (int k = 0; k < 2; k++) {
      if (k >= count) contact[k] = ali3_no_contact();
      for (int32_t i = 0; i < NUMBERS; i++) contacts[(k * NUMBERS + i) * width + l] = ((const double *)&contact[k])[i];
    }
  }
}
