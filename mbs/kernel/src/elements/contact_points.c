/* Points of a body that touch a road: normal force with a smooth onset and loss, friction that sticks at rest.
 *
 * The axes of the body need not be orthonormal, so that axes of a flexible body may be averages. The reals are followed
 * by the lowest and highest x, y, z of the points, then x, y, z of each. States per point: deflections z1, z2 of the
 * stick spring in the plane of contact and their rates.
 *
 * Normal force: contact_law.h over the depth, with the stiffness K beginning as a parabola over the onset. Friction as
 * in slider.h: a spring and damper (k, c) in series with a slider, here in two directions. With z = a + h z'/2 and D =
 * c + h k/2 the trial is T = k a + D v; where |T| exceeds mu N it is scaled to it, and z' = (T - k a)/D. Slip power
 * T.(v - z') >= 0, and a sticking point returns to its position: it does not creep.
 *
 * The tangent is without the coupling of normal and tangential force, and without the rotation of the normal. */

#include <string.h>

#include "contact_law.h"
#include "contact_points_fields.h"
#include "element.h"
#include "element_math.h"
#include "road.h"

enum { LOW = CONTACT_POINTS_REALS, HIGH = LOW + 3, HEAD = HIGH + 3 };
enum { SIGNALS = 12, STATES = 4 }; /* states of each point */
enum { STICKS = 1, SLIPS, PIECES };

/* out = o + X p of signals or rates. */
static void transform(const double *u, const double p[3], double out[3]) {
  for (int i = 0; i < 3; i++) out[i] = u[i] + p[0] * u[3 + i] + p[1] * u[6 + i] + p[2] * u[9 + i];
}

/* Row b of the derivatives of g . (o + X p) by the signals. */
static void write_gradient_row(const double g[3], const double p[3], double b[SIGNALS]) {
  for (int i = 0; i < 3; i++) {
    b[i] = g[i];
    for (int k = 0; k < 3; k++) b[3 + 3 * k + i] = p[k] * g[i];
  }
}

/* Whether the box around the points is above the road below it. */
static int is_far_above(const ali3_element_args *a) {
  const double *p = a->real, *u = a->u;
  double centre[3], half[3], lowest = 0.0, reach = p[RADIUS];
  for (int k = 0; k < 3; k++) {
    const double *axis = u + 3 + 3 * k;
    centre[k] = 0.5 * (p[LOW + k] + p[HIGH + k]);
    half[k] = 0.5 * (p[HIGH + k] - p[LOW + k]);
    lowest -= half[k] * fabs(axis[2]);
    reach += half[k] * ali3_hypot(axis[0], axis[1]);
  }
  double middle[3];
  transform(u, centre, middle);
  return middle[2] + lowest - p[RADIUS] > ali3_road_top(&a->roads[a->integer[ROAD]], middle, reach);
}

typedef struct {
  /* sum of the normal forces, load-weighted mean friction, sum of load times normal */
  double load, friction, normal[3];
} normal_contact;

/* Distances and gradient for a step from u - h ud to u + h ud: the gradient g in the middle, corrected along the path
 * so that g . (p1 - p0) is the difference of the distances. */
static void find_discrete_clearance(const ali3_road *road, const double point[3], const double velocity[3], double h,
                                    int k, ali3_clearance *c, double depth[2], double radius) {
  double from[3], to[3], path2 = 0.0, along = 0.0;
  ali3_clearance end[2];
  for (int i = 0; i < 3; i++) {
    from[i] = point[i] - h * velocity[i];
    to[i] = point[i] + h * velocity[i];
    path2 += 4.0 * h * h * velocity[i] * velocity[i];
    along += 2.0 * h * velocity[i] * c->gradient[i];
  }
  ali3_road_clearance(road, from, end);
  const double before = end[k].distance;
  ali3_road_clearance(road, to, end);
  depth[0] = radius - before;
  depth[1] = radius - end[k].distance;
  if (!(path2 > 1e-24)) return;
  const double error = (end[k].distance - before - along) / path2;
  for (int i = 0; i < 3; i++) c->gradient[i] += error * 2.0 * h * velocity[i];
}

/* Normal forces of a point on the one or two parts of the road. */
static normal_contact add_normal_forces(ali3_element_args *a, const double local[3], int by_gradients) {
  const double *p = a->real;
  const ali3_road *road = &a->roads[a->integer[ROAD]];
  const ali3_contact_law law = {0.0, 0.0, 0.0, p[STIFFNESS], p[ONSET], p[LOSS], p[RESTITUTION]};
  double point[3], velocity[3];
  ali3_clearance clearance[2];
  normal_contact t = {0};
  transform(a->u, local, point);
  transform(a->ud, local, velocity);
  const int count = ali3_road_clearance(road, point, clearance);
  for (int k = 0; k < count; k++) {
    ali3_clearance *c = &clearance[k];
    double depth[2] = {p[RADIUS] - c->distance, p[RADIUS] - c->distance}, slope = 0.0, loss_slope, b[SIGNALS];
    if (by_gradients) find_discrete_clearance(road, point, velocity, a->h, k, c, depth, p[RADIUS]);
    if (!(depth[0] > 0.0 || depth[1] > 0.0)) continue;
    const double now = ali3_contact_force(&law, depth[1], &slope, &a->potential);
    const double mean = by_gradients ? ali3_contact_mean(&law, depth[0], depth[1]) : now;
    if (by_gradients && fabs(depth[1] - depth[0]) > 1e-9) slope = 2.0 * (now - mean) / (depth[1] - depth[0]);
    const double factor = ali3_contact_loss(&law, -ali3_dot(c->gradient, velocity), &loss_slope);
    const double size = ali3_norm(c->gradient), force = mean * factor, load = force * size;
    if (!(load > 0.0)) continue;
    write_gradient_row(c->gradient, local, b);
    for (int i = 0; i < SIGNALS; i++) a->f[i] += force * b[i];
    for (int i = 0; i < 3; i++) {
      t.normal[i] += force * c->gradient[i];
      a->out[CONTACT_POINTS_OUT_FORCE_X + i] += force * c->gradient[i];
    }
    t.friction = t.load / (t.load + load) * t.friction + load / (t.load + load) * c->friction;
    t.load += load;
    if (depth[1] > a->out[CONTACT_POINTS_OUT_DEPTH]) a->out[CONTACT_POINTS_OUT_DEPTH] = depth[1];
    if (a->S) ali3_add_outer(a->S, SIGNALS, a->wK * slope * factor + a->wC * mean * loss_slope, b);
  }
  return t;
}

/* Orthonormal axes of the plane with the unit normal n; the first is along y x n, as no road has a normal along y. */
static void find_plane(const double n[3], double axis[2][3]) {
  double *first = axis[0];
  first[0] = n[2], first[1] = 0.0, first[2] = -n[0];
  const double length = ali3_norm(first);
  if (length > 1e-6)
    for (int i = 0; i < 3; i++) first[i] /= length;
  else
    first[0] = 1.0, first[2] = 0.0;
  ali3_cross(n, first, axis[1]);
}

/* Adds the tangent of friction with damping D, N s/m, that sticks (scale 1), or slides against the force `trial`, N, of
 * which `scale` is left; row: derivatives of the velocities in the plane. */
static void add_friction_tangent(ali3_element_args *a, double row[2][SIGNALS], const double trial[2], double scale,
                                 double D) {
  if (scale == 1.0) {
    for (int i = 0; i < 2; i++) ali3_add_outer(a->S, SIGNALS, a->wC * D, row[i]);
    return;
  }
  const double size = ali3_hypot(trial[0], trial[1]);
  double along[SIGNALS], across[SIGNALS]; /* along and across the sliding: fraction of the secant, and the secant */
  for (int j = 0; j < SIGNALS; j++) {
    along[j] = (trial[0] * row[0][j] + trial[1] * row[1][j]) / size;
    across[j] = (trial[0] * row[1][j] - trial[1] * row[0][j]) / size;
  }
  ali3_add_outer(a->S, SIGNALS, a->wC * ALI3_SECANT_FRACTION * D * scale, along);
  ali3_add_outer(a->S, SIGNALS, a->wC * D * scale, across);
}

/* Friction of a point under its load, in the plane of contact: a spring-damper k, c per direction, limited. */
static void add_friction(ali3_element_args *a, const double local[3], const normal_contact *t, const double *y_old,
                         double *y_new) {
  const double *p = a->real, k = p[STICK_STIFFNESS], c = p[STICK_DAMPING], half = 0.5 * a->h, D = c + half * k;
  const double bound = t->friction * p[FRICTION_FACTOR] * t->load, size = ali3_norm(t->normal);
  double n[3] = {0.0, 0.0, 1.0}, plane[2][3], foot[3], velocity[3], row[2][SIGNALS], elastic[2], trial[2];
  for (int i = 0; i < 3 && size > 0.0; i++) n[i] = t->normal[i] / size;
  for (int i = 0; i < 3; i++) foot[i] = local[i] - p[RADIUS] * ali3_dot(a->u + 3 + 3 * i, n);
  find_plane(n, plane);
  transform(a->ud, foot, velocity);
  for (int i = 0; i < 2; i++) {
    elastic[i] = k * (y_old[i] + half * y_old[2 + i]);
    trial[i] = elastic[i] + D * ali3_dot(plane[i], velocity);
    write_gradient_row(plane[i], foot, row[i]);
  }
  const double trial_size = ali3_hypot(trial[0], trial[1]), scale = trial_size > bound ? bound / trial_size : 1.0;
  a->piece += scale < 1.0 ? SLIPS : STICKS;
  for (int i = 0; i < 2; i++) {
    const double force = scale * trial[i];
    for (int j = 0; j < SIGNALS; j++) a->f[j] -= force * row[i][j];
    for (int j = 0; j < 3; j++) a->out[CONTACT_POINTS_OUT_FORCE_X + j] -= force * plane[i][j];
    y_new[i] = y_old[i];
    y_new[2 + i] = y_old[2 + i];
    if (a->h > 0.0) {
      y_new[2 + i] = (force - elastic[i]) / D;
      y_new[i] = (force - c * y_new[2 + i]) / k;
    }
    a->potential += 0.5 * k * y_new[i] * y_new[i];
  }
  if (a->S) add_friction_tangent(a, row, trial, scale, D);
}

/* by_gradients: discrete gradients over a step. */
static void evaluate_points(ali3_element_args *a, int by_gradients) {
  memset(a->y_new, 0, (size_t)a->nstate * sizeof(double));
  memset(a->out, 0, CONTACT_POINTS_OUTPUTS * sizeof(double));
  a->potential = 0.0;
  /* a step by gradients may start in contact and have its middle above the road */
  if (!by_gradients && is_far_above(a)) {
    a->idle = 1;
    return;
  }
  for (int32_t i = 0; i < a->integer[POINTS]; i++) {
    const double *local = a->real + HEAD + 3 * i;
    const normal_contact t = add_normal_forces(a, local, by_gradients);
    a->piece *= PIECES; /* one digit for each point; with many points a checksum */
    /* a point that leaves the road loses its deflection, which has decreased with the load */
    if (!(t.load > 0.0)) continue;
    add_friction(a, local, &t, a->y_old + STATES * i, a->y_new + STATES * i);
    a->out[CONTACT_POINTS_OUT_NORMAL_FORCE] += t.load;
    a->out[CONTACT_POINTS_OUT_TOUCHING] += 1.0;
  }
}

static double find_depth(const ali3_element_args *a, double raised, double *part) {
  const double *p = a->real;
  double deepest = -INFINITY, point[3];
  ali3_clearance clearance[2];
  *part = 1.0;
  for (int32_t i = 0; i < a->integer[POINTS]; i++) {
    transform(a->u, p + HEAD + 3 * i, point);
    point[2] += raised;
    const int count = ali3_road_clearance(&a->roads[a->integer[ROAD]], point, clearance);
    for (int k = 0; k < count; k++) deepest = fmax(deepest, p[RADIUS] - clearance[k].distance);
  }
  return deepest;
}

static void evaluate(ali3_element_args *a) { evaluate_points(a, 0); }

static void evaluate_discrete(ali3_element_args *a) { evaluate_points(a, 1); }

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint) {
  (void)nsig, (void)nreal, (void)nint;
  for (int32_t i = 0; i < integer[POINTS]; i++)
    for (int k = 0; k < 3; k++) {
      const double x = real[HEAD + 3 * i + k];
      if (!(x >= real[LOW + k] && x <= real[HIGH + k])) return "a contact point lies outside the box given for all";
    }
  return 0;
}

const ali3_element_type ali3_contact_points = {
    ALI3_CONTACT_POINTS,
    .evaluate = evaluate,
    .discrete = evaluate_discrete,
    .depth = find_depth,
    .first_force = CONTACT_POINTS_OUT_FORCE_X,
    .n_forces = 3,
    .check = check,
};
