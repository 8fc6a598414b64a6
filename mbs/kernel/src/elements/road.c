/* Plane, kerb and regular grid. A wheel is a disc: its nearest point is sought within the wheel plane. */
#include "road.h"
#include "../algebra/small_vectors.h"

#define FLATTEST 0.05 /* least cosine of an edge used as a divisor */
/* Sine between wheel axis and road normal below which the width of a wheel matters: lying flat it touches with its
 * centre LYING/2 radii high, half as high as it is wide, and is 4/LYING^2 times as stiff as upright. */
#define LYING 0.5

/* What stands for the sine as a divisor, and its slope: the sine itself, and below LYING a parabola of the same slope
 * there. */
static double upright(double sine, double *slope) {
  const double part = sine / LYING;
  *slope = part < 1.0 ? part : 1.0;
  return part < 1.0 ? 0.5 * LYING * (1.0 + part * part) : sine;
}

enum { PLANE_HEIGHT, PLANE_GRADE_X, PLANE_GRADE_Y, PLANE_FRICTION, PLANE_REALS };
enum { KERB_X, KERB_LOWER, KERB_STEP, KERB_SIDE, KERB_FRICTION, KERB_REALS };
enum { GRID_NX, GRID_NY, GRID_X0, GRID_Y0, GRID_DX, GRID_DY, GRID_FRICTION, GRID_DATA };

/* Half-space below the plane through q with outward unit normal n. Returns the centre's distance along the disc. */
static double half_space(const double centre[3], const double axis[3], double radius, const double q[3],
                         const double n[3], ali3_contact *out) {
  double across = ali3_dot(n, axis), inplane[3], height = 0.0;
  for (int i = 0; i < 3; i++) {
    inplane[i] = n[i] - across * axis[i];
    height += n[i] * (centre[i] - q[i]);
  }
  double size = ali3_norm(inplane);
  if (size < 1e-9) { /* the wheel lies flat: any direction in its plane */
    const double other[3] = {fabs(axis[0]) < 0.6 ? 1.0 : 0.0, fabs(axis[0]) < 0.6 ? 0.0 : 1.0, 0.0};
    ali3_cross(axis, other, inplane);
    out->cosine = upright(0.0, &out->leaning);
    size = ali3_norm(inplane);
  } else {
    out->cosine = upright(size, &out->leaning);
  }
  const double distance = height / out->cosine;
  out->penetration = radius - distance;
  for (int i = 0; i < 3; i++) {
    out->normal[i] = n[i];
    out->down[i] = -inplane[i] / size;
    out->point[i] = centre[i] + distance * out->down[i];
  }
  return distance;
}

static int plane(const double *p, const double centre[3], const double axis[3], double radius, ali3_contact *out) {
  const double size = sqrt(1.0 + p[PLANE_GRADE_X] * p[PLANE_GRADE_X] + p[PLANE_GRADE_Y] * p[PLANE_GRADE_Y]);
  const double n[3] = {-p[PLANE_GRADE_X] / size, -p[PLANE_GRADE_Y] / size, 1.0 / size},
               q[3] = {0.0, 0.0, p[PLANE_HEIGHT]};
  half_space(centre, axis, radius, q, n, out);
  out->friction = p[PLANE_FRICTION];
  return 1;
}

/* Line x = edge[0], z = edge[2]. Returns 0 where the wheel plane (nearly) misses it. */
static int edge_line(const double centre[3], const double axis[3], double radius, const double edge[3],
                     ali3_contact *out) {
  if (fabs(axis[1]) < 1e-6) return 0;
  double w[3] = {edge[0] - centre[0], 0.0, edge[2] - centre[2]};
  w[1] = -(w[0] * axis[0] + w[2] * axis[2]) / axis[1];
  const double distance = ali3_norm(w);
  if (distance < 1e-9) return 0;
  /* gradient of the distance with respect to the centre: it has no part along the edge */
  const double g[3] = {(w[1] * axis[0] / axis[1] - w[0]) / distance, 0.0, (w[1] * axis[2] / axis[1] - w[2]) / distance};
  const double size = ali3_norm(g);
  out->penetration = radius - distance;
  out->cosine = 1.0 / size > FLATTEST ? 1.0 / size : FLATTEST;
  out->leaning = 1.0;
  for (int i = 0; i < 3; i++) {
    out->normal[i] = g[i] / size;
    out->down[i] = w[i] / distance;
    out->point[i] = centre[i] + w[i];
  }
  return 1;
}

/* Upper quarter space (plane, edge or face, whichever is nearest: its distance is C1) and, as second contact, the
 * lower plane. */
static int kerb(const double *p, const double centre[3], const double axis[3], double radius, ali3_contact out[2]) {
  const double side = p[KERB_SIDE] >= 0.0 ? 1.0 : -1.0;
  const double edge[3] = {p[KERB_X], 0.0, p[KERB_LOWER] + p[KERB_STEP]}, low[3] = {0.0, 0.0, p[KERB_LOWER]};
  const double up[3] = {0.0, 0.0, 1.0}, face[3] = {side, 0.0, 0.0};
  const double above = centre[2] - edge[2], ahead = side * (centre[0] - edge[0]);
  ali3_contact top;
  half_space(centre, axis, radius, edge, up, &top);
  half_space(centre, axis, radius, edge, face, &out[0]);
  const int top_is_nearest = above > 0.0 ? side * (top.point[0] - edge[0]) <= 0.0 : ahead <= 0.0 && above >= ahead;
  const int face_is_nearest = ahead > 0.0 ? out[0].point[2] <= edge[2] : above <= 0.0;
  int count = 1;
  if (top_is_nearest)
    out[0] = top;
  else if (!face_is_nearest)
    count = edge_line(centre, axis, radius, edge, &out[0]);
  half_space(centre, axis, radius, low, up, &out[count]);
  for (int i = 0; i <= count; i++) out[i].friction = p[KERB_FRICTION];
  return count + 1;
}

/* Cubic Hermite weights (slopes by central differences, one-sided at the border) of values first..first+3 (clamped to
 * 0..n-1). */
static int cubic(double s, int n, double w[4], double dw[4]) {
  int i = s >= (double)(n - 1) ? n - 2 : s > 0.0 ? (int)s : 0;
  const int outside = s < 0.0 || s > (double)(n - 1);
  const double t = ali3_clamp(s - i, 0.0, 1.0), left = i > 0 ? 0.5 : 1.0, right = i + 2 < n ? 0.5 : 1.0;
  const double h10 = t * (1.0 - t) * (1.0 - t) * left, h11 = t * t * (t - 1.0) * right, h01 = t * t * (3.0 - 2.0 * t);
  const double d10 = (1.0 - t) * (1.0 - 3.0 * t) * left, d11 = t * (3.0 * t - 2.0) * right, d01 = 6.0 * t * (1.0 - t);
  w[0] = -h10, w[1] = 1.0 - h01 - h11, w[2] = h01 + h10, w[3] = h11;
  dw[0] = -d10, dw[1] = -d01 - d11, dw[2] = d01 + d10, dw[3] = d11;
  if (outside) dw[0] = dw[1] = dw[2] = dw[3] = 0.0; /* the border value goes on */
  return i - 1;
}

static int grid_size(const double *p, int32_t nreal, int *nx, int *ny) {
  const double a = p[GRID_NX], b = p[GRID_NY];
  if (!(a >= 2.0 && a <= 1e6 && b >= 2.0 && b <= 1e6 && GRID_DATA + 2.0 * a * b <= (double)nreal)) return 0;
  if (!(p[GRID_DX] > 0.0 && p[GRID_DY] > 0.0)) return 0;
  *nx = (int)a;
  *ny = (int)b;
  return 1;
}

typedef struct {
  double height, normal[3], friction;
} surface;

static surface grid_at(const double *p, int nx, int ny, double x, double y) {
  const double *z = p + GRID_DATA, *mu = z + (int64_t)nx * ny;
  double wx[4], dx[4], wy[4], dy[4], height = 0.0, slope[2] = {0.0, 0.0};
  const double sx = ali3_clamp((x - p[GRID_X0]) / p[GRID_DX], -1.0, (double)nx),
               sy = ali3_clamp((y - p[GRID_Y0]) / p[GRID_DY], -1.0, (double)ny);
  const int i0 = cubic(sx, nx, wx, dx), j0 = cubic(sy, ny, wy, dy);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      const int ic = i0 + i < 0     ? 0
                     : i0 + i >= nx ? nx - 1
                                    : i0 + i,
                jc = j0 + j < 0     ? 0
                     : j0 + j >= ny ? ny - 1
                                    : j0 + j;
      const double value = z[(int64_t)ic * ny + jc];
      height += wx[i] * wy[j] * value;
      slope[0] += dx[i] * wy[j] * value / p[GRID_DX];
      slope[1] += wx[i] * dy[j] * value / p[GRID_DY];
    }
  const double tx = ali3_clamp(sx - (i0 + 1), 0.0, 1.0), ty = ali3_clamp(sy - (j0 + 1), 0.0, 1.0);
  const double *m = mu + (int64_t)(i0 + 1) * ny + j0 + 1;
  const double friction = (1.0 - tx) * ((1.0 - ty) * m[0] + ty * m[1]) + tx * ((1.0 - ty) * m[ny] + ty * m[ny + 1]);
  const double size = sqrt(1.0 + slope[0] * slope[0] + slope[1] * slope[1]);
  const surface found = {height, {-slope[0] / size, -slope[1] / size, 1.0 / size}, p[GRID_FRICTION] * friction};
  return found;
}

static int grid(const double *p, int32_t nreal, const double centre[3], const double axis[3], double radius,
                ali3_contact *out) {
  int nx, ny;
  if (!grid_size(p, nreal, &nx, &ny)) return 0; /* a parameter may have spoilt the header */
  double x = centre[0], y = centre[1];
  for (int pass = 0; pass < 3; pass++) { /* tangent plane under the centre, then twice at the point it gives */
    const surface under = grid_at(p, nx, ny, x, y);
    const double q[3] = {x, y, under.height};
    const double reach = ali3_clamp(half_space(centre, axis, radius, q, under.normal, out), -radius, radius);
    out->friction = under.friction;
    x = centre[0] + reach * out->down[0];
    y = centre[1] + reach * out->down[1];
  }
  return 1;
}

int ali3_road_contacts(const ali3_road *road, const double centre[3], const double axis[3], double radius,
                       ali3_contact out[2]) {
  int count = 0;
  if (road->type == ALI3_ROAD_PLANE) count = plane(road->real, centre, axis, radius, out);
  if (road->type == ALI3_ROAD_KERB) count = kerb(road->real, centre, axis, radius, out);
  if (road->type == ALI3_ROAD_GRID) count = grid(road->real, road->nreal, centre, axis, radius, out);
  for (int i = 0; i < count; i++)
    if (!(out[i].friction > 0.0)) out[i].friction = 0.0;
  return count;
}

static void plane_clearance(const double n[3], const double q[3], const double point[3], ali3_clearance *out) {
  out->distance = 0.0;
  for (int i = 0; i < 3; i++) {
    out->gradient[i] = n[i];
    out->distance += n[i] * (point[i] - q[i]);
  }
}

/* Step and lower level. Outside the step the distance is the true one. Inside, a below its top and b behind its face,
 * it is -(a + b - sqrt(a^2 + b^2)) (Fischer and Burmeister): min(a, b) near both, without its kink between them, so a
 * point that is deep in the edge is not thrown from one side to the other. */
static int kerb_clearance(const double *p, const double point[3], ali3_clearance out[2]) {
  const double side = p[KERB_SIDE] >= 0.0 ? 1.0 : -1.0, up[3] = {0.0, 0.0, 1.0}, low[3] = {0.0, 0.0, p[KERB_LOWER]};
  const double a = p[KERB_LOWER] + p[KERB_STEP] - point[2], b = -side * (point[0] - p[KERB_X]);
  const double corner = ali3_hypot(a, b);
  double by_a = -1.0, by_b = 0.0; /* of the distance */
  out[0].distance = -a;
  if (a > 0.0 && b <= 0.0) {
    out[0].distance = -b;
    by_a = 0.0, by_b = -1.0;
  } else if (a <= 0.0 && b < 0.0) {
    out[0].distance = corner;
    by_a = a / corner, by_b = b / corner;
  } else if (a > 0.0 && b > 0.0) {
    out[0].distance = corner - a - b;
    by_a = a / corner - 1.0, by_b = b / corner - 1.0;
  }
  out[0].gradient[0] = -side * by_b;
  out[0].gradient[1] = 0.0;
  out[0].gradient[2] = -by_a;
  plane_clearance(up, low, point, &out[1]);
  out[0].friction = out[1].friction = p[KERB_FRICTION];
  return 2;
}

#define NEAR 0.1 /* m: farther from the tangent plane under it a point is not evaluated again */

/* Distance to the nearest point of the surface: tangent plane under the point, then twice at the foot it gives. */
static int grid_clearance(const double *p, int32_t nreal, const double point[3], ali3_clearance *out) {
  int nx, ny;
  if (!grid_size(p, nreal, &nx, &ny)) return 0;
  double x = point[0], y = point[1];
  for (int pass = 0; pass < 3; pass++) {
    const surface under = grid_at(p, nx, ny, x, y);
    const double q[3] = {x, y, under.height};
    plane_clearance(under.normal, q, point, out);
    out->friction = under.friction;
    if (out->distance > NEAR) return 1;
    const double reach = ali3_clamp(out->distance, -NEAR, NEAR);
    x = point[0] - reach * under.normal[0];
    y = point[1] - reach * under.normal[1];
  }
  return 1;
}

int ali3_road_clearance(const ali3_road *road, const double point[3], ali3_clearance out[2]) {
  const double *p = road->real;
  int count = 0;
  if (road->type == ALI3_ROAD_PLANE) {
    const double size = sqrt(1.0 + p[PLANE_GRADE_X] * p[PLANE_GRADE_X] + p[PLANE_GRADE_Y] * p[PLANE_GRADE_Y]);
    const double n[3] = {-p[PLANE_GRADE_X] / size, -p[PLANE_GRADE_Y] / size, 1.0 / size},
                 q[3] = {0.0, 0.0, p[PLANE_HEIGHT]};
    plane_clearance(n, q, point, out);
    out->friction = p[PLANE_FRICTION];
    count = 1;
  }
  if (road->type == ALI3_ROAD_KERB) count = kerb_clearance(p, point, out);
  if (road->type == ALI3_ROAD_GRID) count = grid_clearance(p, road->nreal, point, out);
  for (int i = 0; i < count; i++)
    if (!(out[i].friction > 0.0)) out[i].friction = 0.0;
  return count;
}

enum { MOST_CELLS = 400 };     /* looked at for a top */
#define OVERSHOOT 0.35         /* a bicubic patch leaves the range of its values by less than this part of it */

/* Indices low..high of the values that cells within reach of a place take. */
static void cells(double place, double reach, double first, double spacing, int n, int *low, int *high) {
  const double last = (double)(n - 1), a = (place - reach - first) / spacing, b = (place + reach - first) / spacing;
  *low = (int)ali3_clamp(a - 1.0, 0.0, last);
  *high = (int)ali3_clamp(b + 3.0, 0.0, last);
}

static double grid_top(const double *p, int32_t nreal, const double place[3], double reach) {
  int nx, ny, low[2], high[2];
  if (!grid_size(p, nreal, &nx, &ny)) return -INFINITY;
  cells(place[0], reach, p[GRID_X0], p[GRID_DX], nx, &low[0], &high[0]);
  cells(place[1], reach, p[GRID_Y0], p[GRID_DY], ny, &low[1], &high[1]);
  if ((int64_t)(high[0] - low[0] + 1) * (high[1] - low[1] + 1) > MOST_CELLS) return INFINITY;
  double top = -INFINITY, bottom = INFINITY;
  for (int i = low[0]; i <= high[0]; i++)
    for (int j = low[1]; j <= high[1]; j++) {
      const double z = p[GRID_DATA + (int64_t)i * ny + j];
      top = z > top ? z : top;
      bottom = z < bottom ? z : bottom;
    }
  return top + OVERSHOOT * (top - bottom);
}

double ali3_road_top(const ali3_road *road, const double place[3], double reach) {
  const double *p = road->real;
  if (road->type == ALI3_ROAD_PLANE)
    return p[PLANE_HEIGHT] + p[PLANE_GRADE_X] * place[0] + p[PLANE_GRADE_Y] * place[1] +
           ali3_hypot(p[PLANE_GRADE_X], p[PLANE_GRADE_Y]) * reach;
  if (road->type == ALI3_ROAD_KERB)
    return p[KERB_LOWER] + (p[KERB_SIDE] * (place[0] - p[KERB_X]) > reach ? 0.0 : p[KERB_STEP]);
  return grid_top(p, road->nreal, place, reach);
}

const char *ali3_road_check(int32_t type, const double *real, int32_t nreal) {
  int nx, ny;
  switch (type) {
  case ALI3_ROAD_PLANE:
    if (nreal != PLANE_REALS) return "a plane road has 4 numbers: height, grade in x, grade in y, friction";
    return real[PLANE_FRICTION] < 0.0 ? "the friction of a road must not be negative" : 0;
  case ALI3_ROAD_KERB:
    if (nreal != KERB_REALS) return "a kerb has 5 numbers: x of the edge, lower height, step, side, friction";
    if (!(real[KERB_STEP] > 0.0)) return "the step of a kerb must be positive";
    if (real[KERB_SIDE] != 1.0 && real[KERB_SIDE] != -1.0) return "the side of a kerb must be 1 or -1";
    return real[KERB_FRICTION] < 0.0 ? "the friction of a road must not be negative" : 0;
  case ALI3_ROAD_GRID:
    if (nreal < GRID_DATA || !grid_size(real, nreal, &nx, &ny))
      return "a grid road needs at least 2 x 2 points at positive spacing";
    if (nx != real[GRID_NX] || ny != real[GRID_NY] || GRID_DATA + 2 * (int64_t)nx * ny != nreal)
      return "a grid road needs one height and one friction per point";
    if (real[GRID_FRICTION] < 0.0) return "the friction of a road must not be negative";
    for (int64_t i = GRID_DATA + (int64_t)nx * ny; i < nreal; i++)
      if (real[i] < 0.0) return "the friction of a road must not be negative";
    return 0;
  default:
    return "unknown type of road";
  }
}
