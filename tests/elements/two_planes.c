/* In place of road.c: two level planes at once, each with a friction of its own. Reals: height and friction of the
 * first, then of the second. */
#include "elements/road.h"

#include <stddef.h>

int ali3_road_contacts(const ali3_road *road, const double centre[3], const double axis[3], double radius,
                       ali3_contact out[2]) {
  (void)axis; /* level */
  for (int k = 0; k < 2; k++) {
    const double height = road->real[2 * k];
    const ali3_contact contact = {.penetration = radius - (centre[2] - height),
                                  .point = {centre[0], centre[1], height},
                                  .normal = {0.0, 0.0, 1.0},
                                  .down = {0.0, 0.0, -1.0},
                                  .cosine = 1.0,
                                  .friction = road->real[2 * k + 1],
                                  .leaning = 1.0};
    out[k] = contact;
  }
  return 2;
}

int ali3_road_clearance(const ali3_road *road, const double point[3], ali3_clearance out[2]) {
  for (int k = 0; k < 2; k++) {
    const ali3_clearance clearance = {point[2] - road->real[2 * k], {0.0, 0.0, 1.0}, road->real[2 * k + 1]};
    out[k] = clearance;
  }
  return 2;
}

double ali3_road_top(const ali3_road *road, const double place[3], double reach) {
  (void)place, (void)reach;
  return road->real[0] > road->real[2] ? road->real[0] : road->real[2];
}

const char *ali3_road_check(int32_t type, const double *real, int32_t nreal) {
  (void)type, (void)real, (void)nreal;
  return NULL;
}
