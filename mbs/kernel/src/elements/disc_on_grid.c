/* The point of a grid that is nearest to the centre of a disc, in its plane.
 *
 * Where the surface bends little over the disc, three tangent planes lead to it: under the centre, and twice at the point
 * that the last one gives; their error falls by curvature times radius each time. Where it bends more (BENT) there may be
 * several nearest points, and that under the centre is not the deepest: the profile of the surface in the plane of the
 * disc is searched at half of the spacing of the grid, and the two deepest minima of its distance are refined.
 *
 * The deepest one bears. The depth is a smooth maximum of both, m = d1 + (e - g)^2/(4 e) for g = d1 - d2 < e, so that the
 * force, which is the gradient of k m^2/2, does not jump where the other one becomes the deepest; e is EQUAL. */
#include "disc_on_grid.h"

#include "../algebra/small_vectors.h"
#include "half_space.h"

#define BENT 0.3 /* curvature times radius from which, or from twice of which, the profile is searched */
#define UPRIGHT 0.5 /* least sine between axis and vertical of a disc that is searched */
#define EQUAL 0.001 /* m */
#define EXACT 1e-13 /* m */
enum { MOST_BENDS = 80, LEAST_PARTS = 8, MOST_PARTS = 64, REFINEMENTS = 60 };

typedef struct { /* the profile in the plane of a disc */
  const ali3_grid *grid;
  ali3_cell *cell; /* the last one */
  const double *centre;
  double ahead[3], up[3]; /* unit, in the plane; ahead is level */
} profile;

typedef struct {
  double s, place[3], normal[3], friction; /* of the point ahead by s */
  double distance2, rate; /* from the centre, squared, and half its derivative by s */
} nearby;

static int leans(const profile *p) { return !(fabs(p->up[0]) + fabs(p->up[1]) < EXACT); }

static double up_to(const profile *p, double height) { return (height - p->centre[2]) / p->up[2]; }

/* The place ahead by s. A leaning disc reaches the surface aside of where it is sought. */
static void place_at(const profile *p, double s, double place[2]) {
  double w = 0.0;
  for (int pass = 0, more = leans(p) ? 2 : 0; pass <= more; pass++) {
    for (int i = 0; i < 2; i++) place[i] = p->centre[i] + s * p->ahead[i] + w * p->up[i];
    if (pass < more) w = up_to(p, ali3_grid_height(p->grid, p->cell, place[0], place[1]));
  }
}

static double distance2_at(const profile *p, double s) {
  double place[2];
  place_at(p, s, place);
  const double w = up_to(p, ali3_grid_height(p->grid, p->cell, place[0], place[1]));
  return s * s + w * w;
}

static nearby at(const profile *p, double s) {
  nearby n = {.s = s};
  place_at(p, s, n.place);
  const ali3_surface f = ali3_grid_near(p->grid, p->cell, n.place[0], n.place[1]);
  const double w = up_to(p, f.height);
  const double slope = -ali3_dot(f.normal, p->ahead) / ali3_dot(f.normal, p->up);
  n.place[2] = f.height;
  for (int i = 0; i < 3; i++) n.normal[i] = f.normal[i];
  n.friction = f.friction;
  n.distance2 = s * s + w * w;
  n.rate = s + w * slope;
  return n;
}

/* Between two places where the distance falls and rises: false position with a weight after Anderson and Bjorck (BIT 13,
 * 1973, 253-264), and a half where three places have not halved the bracket. */
static nearby refined(const profile *p, nearby low, nearby high) {
  double a = low.s, b = high.s, fa = low.rate, fb = high.rate, width = b - a;
  nearby best = low.distance2 < high.distance2 ? low : high;
  for (int k = 0, slow = 0; k < REFINEMENTS && fabs(best.rate) > EXACT && b - a > EXACT; k++) {
    best = at(p, slow ? 0.5 * (a + b) : a + (b - a) * (fa / (fa - fb)));
    double *kept = best.rate < 0.0 ? &fb : &fa, *other = best.rate < 0.0 ? &fa : &fb;
    const double left = 1.0 - best.rate / *other;
    *kept *= left > 0.0 ? left : 0.5;
    *other = best.rate;
    *(best.rate < 0.0 ? &a : &b) = best.s;
    slow = k % 3 == 2 && b - a > 0.5 * width;
    if (k % 3 == 2) width = b - a;
  }
  return best;
}

/* The minimum about a place that is nearer than those on both sides: halves towards it until the slopes enclose it. */
static nearby minimum(const profile *p, nearby low, nearby here, nearby high) {
  for (int k = 0; k < REFINEMENTS; k++) {
    const int right = here.rate < 0.0;
    if (right && high.rate > 0.0) return refined(p, here, high);
    if (!right && low.rate < 0.0) return refined(p, low, here);
    const nearby half = at(p, 0.5 * (here.s + (right ? high.s : low.s)));
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

static double along(const ali3_grid *g, const double ahead[3]) {
  return 1.0 / (fabs(ahead[0]) / g->dx + fabs(ahead[1]) / g->dy);
}

/* Whether the heights under the disc bend by more than BENT over its radius; they are read at the spacing. */
static int bent(const profile *p, double radius) {
  const double step = fmax(along(p->grid, p->ahead), 2.0 * radius / (MOST_BENDS - 4));
  const int half = (int)(radius / step) + 1;
  const double most = BENT * step * step / radius;
  double last = 0.0, before = 0.0;
  for (int k = -half - 1; k <= half + 1; k++) {
    const double s = step * k;
    const double z = ali3_grid_chord(p->grid, p->centre[0] + s * p->ahead[0], p->centre[1] + s * p->ahead[1]);
    if (k > -half && fabs(z - 2.0 * last + before) > most) return 1;
    before = last, last = z;
  }
  return 0;
}

static int tangent_planes(const profile *p, const double axis[3], double radius, ali3_contact *out) {
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

/* Number of contacts; two of nearly the same depth share the smooth maximum of both depths. */
static int shared(ali3_contact out[2]) {
  const double gap = out[0].penetration - out[1].penetration;
  if (!(gap < EQUAL)) return 1;
  const double part = fmax(EQUAL - gap, 0.0) / (2.0 * EQUAL);
  const double depth = out[0].penetration + part * part * EQUAL;
  for (int k = 0; k < 2; k++) {
    out[k].penetration = depth;
    out[k].yielded = k ? 1.0 - part : part;
    out[k].switching = 0.5 / EQUAL;
  }
  return 2;
}

/* The two deepest minima; 0 where the centre is not above the surface. */
static int search(const profile *p, const double axis[3], double radius, ali3_contact out[2]) {
  const int parts = (int)ali3_clamp(2.0 * radius / along(p->grid, p->ahead), LEAST_PARTS, MOST_PARTS);
  nearby found[2];
  if (!(at(p, 0.0).place[2] < p->centre[2])) return 0;
  double last[2] = {distance2_at(p, radius * (-parts - 1) / parts), distance2_at(p, radius * -parts / parts)};
  int count = 0;
  for (int k = -parts + 1; k <= parts + 1; k++) {
    const double next = distance2_at(p, radius * k / parts);
    if (last[1] <= last[0] && last[1] < next) {
      const nearby one =
          minimum(p, at(p, radius * (k - 2) / parts), at(p, radius * (k - 1) / parts), at(p, radius * k / parts));
      const int deeper = count > 0 && one.distance2 < found[0].distance2;
      if (deeper) found[1] = found[0];
      if (count == 0 || deeper)
        found[0] = one;
      else if (count == 1 || one.distance2 < found[1].distance2)
        found[1] = one;
      count = count < 2 ? count + 1 : 2;
    }
    last[0] = last[1], last[1] = next;
  }
  for (int k = 0; k < count; k++) {
    ali3_half_space(p->centre, axis, radius, found[k].place, found[k].normal, &out[k]);
    out[k].friction = found[k].friction;
    out[k].yielded = out[k].switching = 0.0;
  }
  if (count == 2 && out[1].penetration > out[0].penetration) {
    const ali3_contact other = out[0];
    out[0] = out[1], out[1] = other;
  }
  return count < 2 ? count : shared(out);
}

int ali3_disc_on_grid(const ali3_grid *g, const double centre[3], const double axis[3], double radius,
                      ali3_contact out[2]) {
  const double level = ali3_hypot(axis[0], axis[1]);
  ali3_cell cell = {0};
  profile p = {.grid = g, .cell = &cell, .centre = centre};
  if (level > UPRIGHT) {
    p.ahead[0] = axis[1] / level, p.ahead[1] = -axis[0] / level;
    ali3_cross(p.ahead, axis, p.up);
    const int count = bent(&p, radius) ? search(&p, axis, radius, out) : 0;
    if (count > 0) return count;
  }
  return tangent_planes(&p, axis, radius, out);
}
