/* Roads by type: contacts of a wheel, clearance of points, bounds and checks; m, earth axes, z upwards. A wheel is a
 * disc; its nearest point is searched in the wheel plane. */
#include "road.h"

#include "../algebra/small_vectors.h"
#include "../roads/grid.h"
#include "disc_on_grid.h"
#include "grid_exit.h"
#include "plane_and_kerb.h"
#include "road_port.h"

/* Numbers of a grid in the System; from GRID_DATA on heights, then frictions. */
enum { GRID_NX, GRID_NY, GRID_X0, GRID_Y0, GRID_DX, GRID_DY, GRID_FRICTION, GRID_DATA };
#define NEAR 0.1 /* m: distance from the tangent plane above which it is not evaluated again */
#define INSIDE 0.01 /* m: depth above which the face of a wall is searched: the tangent plane does not include it */
#define STEEP 1.5 /* depths: radius of that search, which finds every nearer face of 42 degrees or more */
static const double MAX_POINTS = 1e6; /* in a direction of a grid */

/* Reads the number of points of a grid; false: its numbers are invalid. */
static bool read_grid_size(const double *p, int32_t nreal, int *nx, int *ny) {
  const double a = p[GRID_NX], b = p[GRID_NY];
  if (!(a >= 2.0 && a <= MAX_POINTS && b >= 2.0 && b <= MAX_POINTS)) return false;
  if (!(GRID_DATA + 2.0 * a * b <= (double)nreal && p[GRID_DX] > 0.0 && p[GRID_DY] > 0.0)) return false;
  *nx = (int)a;
  *ny = (int)b;
  return true;
}

/* Type of a road: from its file, otherwise its own. */
static int32_t find_type(const ali3_road *road) {
  return road->file != NULL ? ali3_road_file_kind(road->file) : road->type;
}

/* Numbers of a road: of its file, otherwise its own. */
static const double *find_reals(const ali3_road *road) {
  return road->file != NULL ? ali3_road_file_reals(road->file) : road->real;
}

/* Factor on the friction; 1 for a plane or kerb without one. */
static double find_factor(const ali3_road *road) {
  if (road->type == ALI3_ROAD_GRID) return road->real[GRID_FRICTION];
  if (road->type == ALI3_ROAD_PORT) return 1.0;
  const int32_t index = road->type == ALI3_ROAD_PLANE ? PLANE_FACTOR : KERB_FACTOR;
  return index < road->nreal ? road->real[index] : 1.0;
}

/* Grid of a road; false if a parameter made its header invalid. */
static bool make_grid(const ali3_road *road, ali3_grid *g) {
  if (road->file != NULL) {
    const double *header = ali3_road_file_reals(road->file);
    *g = (ali3_grid){.x0 = header[0], .y0 = header[1], .dx = header[2], .dy = header[3], .file = road->file};
    ali3_road_file_size(road->file, &g->nx, &g->ny);
    return true;
  }
  const double *p = road->real, *z = p + GRID_DATA;
  int nx, ny;
  if (!read_grid_size(p, road->nreal, &nx, &ny)) return false;
  *g = (ali3_grid){.nx = nx,
                   .ny = ny,
                   .x0 = p[GRID_X0],
                   .y0 = p[GRID_Y0],
                   .dx = p[GRID_DX],
                   .dy = p[GRID_DY],
                   .z = z,
                   .mu = z + (int64_t)nx * ny};
  return true;
}

/* Contacts with a grid in memory or in a file. */
static int find_grid_contacts(const ali3_road *road, const double centre[3], const double axis[3], double radius,
                              ali3_contact out[2]) {
  ali3_grid g;
  if (!make_grid(road, &g)) return 0;
  return ali3_disc_on_grid(&g, centre, axis, radius, out);
}

int ali3_road_contacts(const ali3_road *road, const double centre[3], const double axis[3], double radius,
                       ali3_contact out[2]) {
  const int32_t type = find_type(road);
  const double factor = find_factor(road);
  if (type == ALI3_ROAD_PORT) return ali3_port_contact(road, centre, axis, radius, out);
  if (type != ALI3_ROAD_GRID)
    return ali3_plane_or_kerb_contacts(type, find_reals(road), factor, centre, axis, radius, out);
  const int count = find_grid_contacts(road, centre, axis, radius, out);
  for (int i = 0; i < count; i++) out[i].friction = ali3_friction_product(factor, out[i].friction);
  return count;
}

int32_t ali3_road_numbers(const ali3_road *road, double numbers[ALI3_ROAD_NUMBERS], double *friction_factor) {
  const int32_t type = find_type(road), n = type == ALI3_ROAD_PLANE ? PLANE_FACTOR : KERB_FACTOR;
  *friction_factor = find_factor(road);
  for (int32_t i = 0; i < ALI3_ROAD_NUMBERS; i++)
    numbers[i] = type < ALI3_ROAD_GRID && i < n ? find_reals(road)[i] : 0.0;
  return type;
}

/* Distance of a point from the plane through q with unit normal n, m, and its gradient. */
static void find_plane_clearance(const double n[3], const double q[3], const double point[3], ali3_clearance *out) {
  out->distance = 0.0;
  for (int i = 0; i < 3; i++) {
    out->gradient[i] = n[i];
    out->distance += n[i] * (point[i] - q[i]);
  }
}

/* Step and lower level. Outside the step the distance is exact. Inside, a below its top and b behind its face, it is
 * -(a + b - sqrt(a^2 + b^2)) (Fischer and Burmeister): close to -min(a, b) near either surface, but without a kink
 * between them, so that a point deep inside the edge is not pushed alternately to both sides. */
static int find_kerb_clearance(const double *p, const double point[3], ali3_clearance out[2]) {
  const double side = p[KERB_SIDE] >= 0.0 ? 1.0 : -1.0, up[3] = {0.0, 0.0, 1.0}, low[3] = {0.0, 0.0, p[KERB_LOWER]};
  const double a = p[KERB_LOWER] + p[KERB_STEP] - point[2], b = -side * (point[0] - p[KERB_X]);
  const double corner = ali3_hypot(a, b);
  double by_a = -1.0, by_b = 0.0; /* derivatives of the distance */
  out[0].distance = -a;
  if (a > 0.0 && b <= 0.0) {
    out[0].distance = -b;
    by_a = 0.0, by_b = -1.0;
  } else if (a <= 0.0 && b < 0.0) {
    out[0].distance = corner;
    by_a = a / corner, by_b = b / corner;
  } else if (a > 0.0 && b > 0.0) {
    const double smaller = fmin(a, b); /* = corner - a - b without cancellation far from the edge */
    out[0].distance = smaller * smaller / (corner + fmax(a, b)) - smaller;
    by_a = a / corner - 1.0, by_b = b / corner - 1.0;
  }
  out[0].gradient[0] = -side * by_b;
  out[0].gradient[1] = 0.0;
  out[0].gradient[2] = -by_a;
  find_plane_clearance(up, low, point, &out[1]);
  out[0].friction = out[1].friction = p[KERB_FRICTION];
  return 2;
}

/* Distance to the surface by the tangent plane under the point, evaluated twice more at its foot; inside a wall, the
 * distance to the nearest face if that is less deep. */
static int find_grid_clearance(const ali3_road *road, const double point[3], ali3_clearance *out) {
  ali3_grid g;
  if (!make_grid(road, &g)) return 0;
  double x = point[0], y = point[1];
  ali3_cell cell = {0};
  for (int pass = 0; pass < 3; pass++) {
    const ali3_surface under = ali3_grid_near(&g, &cell, x, y);
    const double q[3] = {x, y, under.height};
    find_plane_clearance(under.normal, q, point, out);
    out->friction = under.friction;
    if (out->distance > NEAR) return 1;
    const double reach = ali3_clamp(out->distance, -NEAR, NEAR);
    x = point[0] - reach * under.normal[0];
    y = point[1] - reach * under.normal[1];
  }
  double nearest[2];
  if (out->distance < -INSIDE && ali3_grid_exit(&g, point, -STEEP * out->distance, nearest)) {
    const ali3_surface face = ali3_grid_at(&g, nearest[0], nearest[1]);
    const double q[3] = {nearest[0], nearest[1], face.height};
    ali3_clearance at_face = {.friction = face.friction};
    find_plane_clearance(face.normal, q, point, &at_face);
    if (at_face.distance > out->distance) *out = at_face;
  }
  return 1;
}

/* Distance to a plane. */
static int find_slope_clearance(const double *p, const double point[3], ali3_clearance *out) {
  double n[3], q[3];
  ali3_plane_frame(p, n, q);
  find_plane_clearance(n, q, point, out);
  out->friction = p[PLANE_FRICTION];
  return 1;
}

/* Distance to the plane of the nearest answer of a port. */
static int find_port_clearance(const ali3_road *road, const double point[3], ali3_clearance *out) {
  double nearest[3];
  const ali3_surface under = ali3_port_surface(road, point, nearest);
  find_plane_clearance(under.normal, nearest, point, out);
  out->friction = under.friction;
  return 1;
}

int ali3_road_clearance(const ali3_road *road, const double point[3], ali3_clearance out[2]) {
  const int32_t type = find_type(road);
  int count = 0;
  if (type == ALI3_ROAD_PLANE) count = find_slope_clearance(find_reals(road), point, out);
  if (type == ALI3_ROAD_KERB) count = find_kerb_clearance(find_reals(road), point, out);
  if (type == ALI3_ROAD_GRID) count = find_grid_clearance(road, point, out);
  if (type == ALI3_ROAD_PORT) count = find_port_clearance(road, point, out);
  for (int i = 0; i < count; i++) out[i].friction = ali3_friction_product(find_factor(road), out[i].friction);
  return count;
}

int ali3_road_spacing(const ali3_road *road, double spacing[2]) {
  ali3_grid g;
  if (find_type(road) != ALI3_ROAD_GRID || !make_grid(road, &g)) return 0;
  spacing[0] = g.dx, spacing[1] = g.dy;
  return 1;
}

double ali3_road_top(const ali3_road *road, const double place[3], double reach) {
  const int32_t type = find_type(road);
  const double *p = find_reals(road);
  ali3_grid g;
  if (type == ALI3_ROAD_PLANE)
    return p[PLANE_HEIGHT] + p[PLANE_GRADE_X] * place[0] + p[PLANE_GRADE_Y] * place[1] +
           ali3_hypot(p[PLANE_GRADE_X], p[PLANE_GRADE_Y]) * reach;
  if (type == ALI3_ROAD_KERB)
    return p[KERB_LOWER] + (p[KERB_SIDE] * (place[0] - p[KERB_X]) > reach ? 0.0 : p[KERB_STEP]);
  if (type == ALI3_ROAD_PORT) return ali3_port_top(road, place, reach);
  return make_grid(road, &g) ? ali3_grid_top(&g, place, reach) : -INFINITY;
}

static const char NEGATIVE[] = "the friction of a road must not be negative";

static const char *check_plane(const double *real, int32_t nreal) {
  if (nreal != PLANE_FACTOR && nreal != PLANE_REALS)
    return "a plane road has 4 numbers: height, grade in x, grade in y, friction; and a factor on the friction";
  return real[PLANE_FRICTION] < 0.0 || (nreal == PLANE_REALS && real[PLANE_FACTOR] < 0.0) ? NEGATIVE : NULL;
}

static const char *check_kerb(const double *real, int32_t nreal) {
  if (nreal != KERB_FACTOR && nreal != KERB_REALS)
    return "a kerb has 5 numbers: x of the edge, lower height, step, side, friction; and a factor on the friction";
  if (!(real[KERB_STEP] > 0.0)) return "the step of a kerb must be positive";
  if (real[KERB_SIDE] != 1.0 && real[KERB_SIDE] != -1.0) return "the side of a kerb must be 1 or -1";
  return real[KERB_FRICTION] < 0.0 || (nreal == KERB_REALS && real[KERB_FACTOR] < 0.0) ? NEGATIVE : NULL;
}

static const char *check_grid(const double *real, int32_t nreal) {
  int nx, ny;
  if (nreal < GRID_DATA || !read_grid_size(real, nreal, &nx, &ny))
    return "a grid road needs at least 2 x 2 points at positive spacing";
  if (nx != real[GRID_NX] || ny != real[GRID_NY] || GRID_DATA + 2 * (int64_t)nx * ny != nreal)
    return "a grid road needs one height and one friction per point";
  if (real[GRID_FRICTION] < 0.0) return NEGATIVE;
  for (int64_t i = GRID_DATA + (int64_t)nx * ny; i < nreal; i++)
    if (real[i] < 0.0) return NEGATIVE;
  return NULL;
}

const char *ali3_road_check(int32_t type, const double *real, int32_t nreal) {
  switch (type) {
  case ALI3_ROAD_PLANE:
    return check_plane(real, nreal);
  case ALI3_ROAD_KERB:
    return check_kerb(real, nreal);
  case ALI3_ROAD_GRID:
    return check_grid(real, nreal);
  case ALI3_ROAD_PORT:
    if (nreal < 2 || real[0] != nreal - 1)
      return "a road at a port needs the number of its answers and an input of each";
    return NULL;
  default:
    return "unknown type of road";
  }
}
