/* A road that another program gives through inputs. Each of its answers is a plane: the point that was asked for, the
 * height and normal there, so that an answer that comes later still holds. Within a step a wheel moves over that plane.
 * Of several answers, as for a body between the wheels, the road is their mean, weighted by the inverse squares of the
 * distances to their points; see docs/decisions/0091. */
#include "road_port.h"

#include "../../include/ali3.h"
#include "../algebra/small_vectors.h"
#include "half_space.h"

static const double NEAR = 0.01; /* m: shortest distance in the weights */
/* An answer that is steeper against the plane of all answers holds at its wheel only. */
static const double STEEP = 0.2;
static const double UPRIGHT = 0.02; /* least upward component of a normal */
static const double OFF_UNIT = 0.1; /* of the length of a unit vector */

int ali3_is_road_normal(const double n[3]) {
  const double size = ali3_norm(n);
  return fabs(size - 1.0) <= OFF_UNIT && n[2] >= UPRIGHT * size;
}

/* Inputs of answer k of a road at a port. */
static const double *find_answer(const ali3_road *road, int32_t k) {
  return *road->input + (int64_t)road->real[PORT_FIRST + k];
}

/* Number of answers. */
static int32_t count_answers(const ali3_road *road) { return (int32_t)road->real[PORT_ANSWERS]; }

/* A unit normal; upwards if the inputs give none, which no step accepts. */
static void read_normal(const double *given, double n[3]) {
  const bool good = ali3_is_road_normal(given) != 0;
  const double size = good ? ali3_norm(given) : 1.0;
  for (int i = 0; i < 3; i++) n[i] = good ? given[i] / size : (i == 2);
}

/* Slopes dz/dx, dz/dy of the plane of an answer. */
static void find_slope(const double *given, double by[2]) {
  double n[3];
  read_normal(given + PORT_NORMAL, n);
  for (int i = 0; i < 2; i++) by[i] = -n[i] / n[2];
}

/* Slope of the plane that fits the heights of all answers best; of a single answer its own, of several at one point
 * 0. */
static void fit_slope(const ali3_road *road, double by[2]) {
  if (count_answers(road) == 1) {
    find_slope(find_answer(road, 0), by);
    return;
  }
  double mean[3] = {0.0, 0.0, 0.0}, xx = NEAR * NEAR, xy = 0.0, yy = NEAR * NEAR, xz = 0.0, yz = 0.0;
  for (int32_t k = 0; k < count_answers(road); k++)
    for (int i = 0; i < 3; i++) mean[i] += find_answer(road, k)[PORT_X + i] / count_answers(road);
  for (int32_t k = 0; k < count_answers(road); k++) {
    const double *a = find_answer(road, k), x = a[PORT_X] - mean[0], y = a[PORT_Y] - mean[1],
                 z = a[PORT_HEIGHT] - mean[2];
    xx += x * x, xy += x * y, yy += y * y, xz += x * z, yz += y * z;
  }
  const double size = xx * yy - xy * xy;
  by[0] = (yy * xz - xy * yz) / size;
  by[1] = (xx * yz - xy * xz) / size;
}

/* Slope of an answer beside its wheel: its own, which fades to the slope of the plane of all answers the steeper it is
 * against this plane, since an edge under a wheel ends beside it. */
static void find_slope_beside(const double *given, const double all[2], double by[2]) {
  find_slope(given, by);
  const double away[2] = {by[0] - all[0], by[1] - all[1]};
  const double left = fmax(1.0 - (away[0] * away[0] + away[1] * away[1]) / (STEEP * STEEP), 0.0);
  for (int i = 0; i < 2; i++) by[i] = all[i] + left * left * away[i];
}

ali3_surface ali3_port_surface(const ali3_road *road, const double place[3], double foot[3]) {
  ali3_surface s = {0};
  if (count_answers(road) == 1) {
    const double *a = find_answer(road, 0);
    read_normal(a + PORT_NORMAL, s.normal);
    for (int i = 0; i < 3; i++) foot[i] = a[PORT_X + i];
    s.height = a[PORT_HEIGHT];
    s.friction = a[PORT_FRICTION];
    return s;
  }
  double all[2], sum = 0.0, slope[2] = {0.0, 0.0};
  fit_slope(road, all);
  for (int32_t k = 0; k < count_answers(road); k++) {
    const double *a = find_answer(road, k), dx = place[0] - a[PORT_X], dy = place[1] - a[PORT_Y];
    double by[2];
    find_slope_beside(a, all, by);
    const double weight = 1.0 / (dx * dx + dy * dy + NEAR * NEAR);
    s.height += weight * (a[PORT_HEIGHT] + by[0] * dx + by[1] * dy);
    s.friction += weight * a[PORT_FRICTION];
    slope[0] += weight * by[0], slope[1] += weight * by[1];
    sum += weight;
  }
  s.height /= sum;
  s.friction /= sum;
  const double up[3] = {-slope[0] / sum, -slope[1] / sum, 1.0}, size = ali3_norm(up);
  for (int i = 0; i < 3; i++) s.normal[i] = up[i] / size;
  foot[0] = place[0], foot[1] = place[1], foot[2] = s.height;
  return s;
}

int ali3_port_contact(const ali3_road *road, const double centre[3], const double axis[3], double radius,
                      ali3_contact *out) {
  double foot[3];
  const ali3_surface under = ali3_port_surface(road, centre, foot);
  ali3_half_space(centre, axis, radius, foot, under.normal, out);
  out->friction = under.friction;
  out->yielded = out->switching = 0.0;
  return 1;
}

double ali3_port_top(const ali3_road *road, const double place[3], double reach) {
  double all[2], top = -INFINITY;
  fit_slope(road, all);
  for (int32_t k = 0; k < count_answers(road); k++) {
    const double *a = find_answer(road, k);
    double by[2];
    find_slope_beside(a, all, by);
    top = fmax(top, a[PORT_HEIGHT] + by[0] * (place[0] - a[PORT_X]) + by[1] * (place[1] - a[PORT_Y]) +
                        ali3_hypot(by[0], by[1]) * reach);
  }
  return top;
}

bool ali3_port_normals(const ali3_road *road) {
  if (road->type != ALI3_ROAD_PORT || road->file != NULL) return true;
  for (int32_t k = 0; k < count_answers(road); k++)
    if (!ali3_is_road_normal(find_answer(road, k) + PORT_NORMAL)) return false;
  return true;
}
