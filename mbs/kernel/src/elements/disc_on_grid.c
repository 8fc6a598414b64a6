/* The point of a grid that is nearest to the centre of a disc, in its plane.
 *
 * Where the surface has little curvature over the disc, three tangent planes lead to it: below the centre, and twice at
 * the last point found; the error decreases by curvature times radius each time. Where it has more (BEND_LIMIT) there
 * may be several nearest points, and the one below the centre is not the deepest: the profile of the surface in the
 * plane of the disc is sampled at half of the grid spacing, and the two deepest minima of the distance are refined.
 *
 * The deepest one carries the load. The depth is a smooth maximum of both, m = d1 + (e - g)^2/(4 e) for g = d1 - d2 <
 * e, so that the force, the gradient of k m^2/2, is continuous where the other one becomes the deepest; e is
 * BLEND_DEPTH. */
#include "disc_on_grid.h"

#include "../algebra/small_vectors.h"
#include "half_space.h"

#define BEND_LIMIT 0.3 /* curvature times radius above which, or above twice which, the profile is searched */
#define MIN_SINE 0.5 /* least sine between axis and vertical for which the profile is searched */
#define BLEND_DEPTH 0.001 /* m */
#define TOLERANCE 1e-13 /* m */
enum { MAX_SAMPLES = 80, MIN_PARTS = 8, MAX_PARTS = 64, REFINEMENTS = 60 };

typedef struct { /* the profile in the plane of a disc */
  const ali3_grid *grid;
  ali3_cell *cell; /* the last cell */
  const double *centre;
  double ahead[3], up[3]; /* unit vectors in the plane; ahead is horizontal */
} profile;

typedef struct {
  double s, position[3], normal[3], friction; /* point at the distance s ahead */
  double distance2, rate; /* squared distance from the centre, and half its derivative by s */
} surface_point;

static int is_inclined(const profile *p) { return !(fabs(p->up[0]) + fabs(p->up[1]) < TOLERANCE); }

/* Distance along `up` from the centre to a height, m. */
static double find_distance_up(const profile *p, double height) { return (height - p->centre[2]) / p->up[2]; }

/* Position at the distance s ahead. The plane of an inclined disc meets the surface beside it, so that it is
 * refined. */
static void find_position(const profile *p, double s, double position[2]) {
  double w = 0.0;
  for (int pass = 0, refinements = is_inclined(p) ? 2 : 0; pass <= refinements; pass++) {
    for (int i = 0; i < 2; i++) position[i] = p->centre[i] + s * p->ahead[i] + w * p->up[i];
    if (pass < refinements) w = find_distance_up(p, ali3_grid_height(p->grid, p->cell, position[0], position[1]));
  }
}

/* Squared distance of the centre to the surface at the distance s ahead, m^2. */
static double find_distance2(const profile *p, double s) {
  double position[2];
  find_position(p, s, position);
  const double w = find_distance_up(p, ali3_grid_height(p->grid, p->cell, position[0], position[1]));
  return s * s + w * w;
}

/* Surface at the distance s ahead, with the derivative of the squared distance. */
static surface_point evaluate_at(const profile *p, double s) {
  surface_point n = {.s = s};
  find_position(p, s, n.position);
  const ali3_surface f = ali3_grid_near(p->grid, p->cell, n.position[0], n.position[1]);
  const double w = find_distance_up(p, f.height);
  const double slope = -ali3_dot(f.normal, p->ahead) / ali3_dot(f.normal, p->up);
  n.position[2] = f.height;
  for (int i = 0; i < 3; i++) n.normal[i] = f.normal[i];
  n.friction = f.friction;
  n.distance2 = s * s + w * w;
  n.rate = s + w * slope;
  return n;
}

/* Minimum between two points where the distance decreases and increases: false position with a weight after Anderson
 * and Bjorck (BIT 13, 1973, 253-264), and bisection where three points have not halved the bracket. */
static surface_point refine(const profile *p, surface_point low, surface_point high) {
  double a = low.s, b = high.s, fa = low.rate, fb = high.rate, width = b - a;
  surface_point best = low.distance2 < high.distance2 ? low : high;
  for (int k = 0, slow = 0; k < REFINEMENTS && fabs(best.rate) > TOLERANCE && b - a > TOLERANCE; k++) {
    best = evaluate_at(p, slow ? 0.5 * (a + b) : a + (b - a) * (fa / (fa - fb)));
    double *opposite = best.rate < 0.0 ? &fb : &fa, *other = best.rate < 0.0 ? &fa : &fb;
    const double factor = 1.0 - best.rate / *other;
    *opposite *= factor > 0.0 ? factor : 0.5;
    *other = best.rate;
    *(best.rate < 0.0 ? &a : &b) = best.s;
    slow = k % 3 == 2 && b - a > 0.5 * width;
    if (k % 3 == 2) width = b - a;
  }
  return best;
}

/* Minimum near a point that is nearer than those on both sides: bisects towards it until the slopes bracket it. */
static surface_point find_minimum(const profile *p, surface_point low, surface_point here, surface_point high) {
  for (int k = 0; k < REFINEMENTS; k++) {
    const int right = here.rate < 0.0;
    if (right && high.rate > 0.0) return refine(p, here, high);
    if (!right && low.rate < 0.0) return refine(p, low, here);
    const surface_point half = evaluate_at(p, 0.5 * (here.s + (right ? high.s : low.s)));
    const int nearer = half.distance2 < here.distance2;
    if (nearer && right)
      low = here;
    else if (nearer)
      high = here;
    else if (right)
      high = half;
    else
      low = half;
    if (nearer) here = half;
  }
  return here;
}

/* Distance between grid lines in the direction `ahead`, m. */
static double find_spacing(const ali3_grid *g, const double ahead[3]) {
  return 1.0 / (fabs(ahead[0]) / g->dx + fabs(ahead[1]) / g->dy);
}

/* Whether second differences of heights under the disc exceed BEND_LIMIT / radius. */
static int is_bent(const profile *p, double radius) {
  const double step = fmax(find_spacing(p->grid, p->ahead), 2.0 * radius / (MAX_SAMPLES - 4));
  const int half = (int)(radius / step) + 1;
  const double most = BEND_LIMIT * step * step / radius;
  double last = 0.0, before = 0.0;
  for (int k = -half - 1; k <= half + 1; k++) {
    const double s = step * k;
    const double z = ali3_grid_chord(p->grid, p->centre[0] + s * p->ahead[0], p->centre[1] + s * p->ahead[1]);
    if (k > -half && fabs(z - 2.0 * last + before) > most) return 1;
    before = last, last = z;
  }
  return 0;
}

/* Contact with the tangent plane of the surface, found in three passes. */
static int find_tangent_contact(const profile *p, const double axis[3], double radius, ali3_contact *out) {
  double x = p->centre[0], y = p->centre[1];
  for (int pass = 0; pass < 3; pass++) {
    const ali3_surface under = ali3_grid_near(p->grid, p->cell, x, y);
    const double q[3] = {x, y, under.height};
    const double reach = ali3_clamp(ali3_half_space(p->centre, axis, radius, q, under.normal, out), -radius, radius);
    out->friction = under.friction;
    x = p->centre[0] + reach * out->down[0];
    y = p->centre[1] + reach * out->down[1];
  }
  out->yielded = out->switching = 0.0;
  return 1;
}

/* Number of contacts; two of nearly equal depth share the smooth maximum of both depths. */
static int blend_contacts(ali3_contact out[2]) {
  const double gap = out[0].penetration - out[1].penetration;
  if (!(gap < BLEND_DEPTH)) return 1;
  const double part = fmax(BLEND_DEPTH - gap, 0.0) / (2.0 * BLEND_DEPTH);
  const double depth = out[0].penetration + part * part * BLEND_DEPTH;
  for (int k = 0; k < 2; k++) {
    out[k].penetration = depth;
    out[k].yielded = k ? 1.0 - part : part;
    out[k].switching = 0.5 / BLEND_DEPTH;
  }
  return 2;
}

/* Writes contacts at the two deepest minima; 0: the centre is not above the surface. */
static int search_profile(const profile *p, const double axis[3], double radius, ali3_contact out[2]) {
  const int parts = (int)ali3_clamp(2.0 * radius / find_spacing(p->grid, p->ahead), MIN_PARTS, MAX_PARTS);
  surface_point deepest[2];
  if (!(evaluate_at(p, 0.0).position[2] < p->centre[2])) return 0;
  double last[2] = {find_distance2(p, radius * (-parts - 1) / parts), find_distance2(p, radius * -parts / parts)};
  int count = 0;
  for (int k = -parts + 1; k <= parts + 1; k++) {
    const double next = find_distance2(p, radius * k / parts);
    if (last[1] <= last[0] && last[1] < next) {
      const surface_point one =
          find_minimum(p, evaluate_at(p, radius * (k - 2) / parts), evaluate_at(p, radius * (k - 1) / parts),
                       evaluate_at(p, radius * k / parts));
      const int deeper = count > 0 && one.distance2 < deepest[0].distance2;
      if (deeper) deepest[1] = deepest[0];
      if (count == 0 || deeper)
        deepest[0] = one;
      else if (count == 1 || one.distance2 < deepest[1].distance2)
        deepest[1] = one;
      count = count < 2 ? count + 1 : 2;
    }
    last[0] = last[1], last[1] = next;
  }
  for (int k = 0; k < count; k++) {
    ali3_half_space(p->centre, axis, radius, deepest[k].position, deepest[k].normal, &out[k]);
    out[k].friction = deepest[k].friction;
    out[k].yielded = out[k].switching = 0.0;
  }
  if (count == 2 && out[1].penetration > out[0].penetration) {
    const ali3_contact other = out[0];
    out[0] = out[1], out[1] = other;
  }
  return count < 2 ? count : blend_contacts(out);
}

int ali3_disc_on_grid(const ali3_grid *g, const double centre[3], const double axis[3], double radius,
                      ali3_contact out[2]) {
  const double horizontal = ali3_hypot(axis[0], axis[1]);
  ali3_cell cell = {0};
  profile p = {.grid = g, .cell = &cell, .centre = centre};
  if (horizontal > MIN_SINE) {
    p.ahead[0] = axis[1] / horizontal, p.ahead[1] = -axis[0] / horizontal;
    ali3_cross(p.ahead, axis, p.up);
    const int count = is_bent(&p, radius) ? search_profile(&p, axis, radius, out) : 0;
    if (count > 0) return count;
  }
  return find_tangent_contact(&p, axis, radius, out);
}
