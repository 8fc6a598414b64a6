/* Tyre on a road: radial spring of a disc, TMeasy steady forces, first-order carcass deflections that are the same at
 * standstill, rolling, sliding and in the air.
 *
 * Signals: wheel centre r (3), unit spin axis e pointing left (3), chi with chi' = Omega the absolute rate about e
 * (> 0 rolling forward).
 * Integers: road. States: carcass deflections x, y and their rates. Outputs: Fx, Fy, Fz, Mz, slip, slip angle,
 * deflection, loaded radius, contact point (3), inclination, normal of the road there (3). Of two contacts these are the
 * means by load; in the air they are the point of the road that is nearest within the wheel plane, and its normal.
 *
 * Two radii are kept apart: the contact patch lies at the loaded radius |rho|; the rolling wheel advances by the
 * larger effective radius (2 R + |rho|)/3 per radian, so that one is used in the slip velocity and, for the same power
 * F v_s, as the lever of F about the axle: the pressure under a driven wheel moves by that difference. With the loaded
 * radius as lever a driven tyre would generate energy, Fx (v - |rho| Omega). At standstill both are the
 * loaded radius, which makes the carcass a true spring.
 *
 * Carcass, per direction, with secant slip damping g = |F_steady|/|v_s|: x'(d + g) = -c x - g v_s, F = c x + d x'.
 * Hence F (v_s + x') = -F^2/g <= 0: sliding only takes energy. With x = a + b x' (theta rule, a and b known) and
 * D = d + b c the step is
 *   F = g (c a - D v_s)/(g + D),   x' = (F - c a)/D,
 * closed, finite from g = 0 (air) to g = infinity (standstill). F is then limited to the largest force of its
 * direction.
 *
 * The tangent leaves out the coupling of load and horizontal force and the turning of the frames. */
#include "../algebra/elementary.h"
#include "element.h"
#include "element_math.h"
#include "road.h"
#include "tmeasy.h"

enum {
  RADIUS,
  BOTTOMING_RADIUS,
  STIFFNESS,
  DAMPING,
  BOTTOMING_STIFFNESS,
  NOMINAL_LOAD,
  REFERENCE_FRICTION,
  MAX_LOAD_FACTOR,
  CURVE_X, /* 10: slope, largest force and its slip, sliding force and its slip, each at Pn and 2 Pn */
  CURVE_Y = CURVE_X + 10, /* 10 */
  TRAIL = CURVE_Y + 10, /* 6: relative trail, its first zero, its end */
  CARCASS_STIFFNESS = TRAIL + 6,
  CARCASS_DAMPING = CARCASS_STIFFNESS + 2,
  ROLLING_RESISTANCE = CARCASS_DAMPING + 2,
  FRICTION_FACTOR,
  REALS
};
enum { FX, FY, FZ, MZ, SLIP, SLIP_ANGLE, DEFLECTION, LOADED_RADIUS, CONTACT_X, INCLINATION = CONTACT_X + 3, NORMAL_X };
enum { OUTPUTS = NORMAL_X + 3 };

#define TOUCH_DEPTH 0.005 /* m, over which the radial damping sets in */
#define SLOW_SPEED 1e-5 /* m/s, added to the transport speed; small so that a parked car creeps by micrometres only */
#define ROLL_SPEED 1.0 /* m/s, from which effective radius and trail are those of the rolling tyre */
#define NO_LOAD 1e-9 /* N */
#define CLEAR 1e-6 /* m: a depth that counts as none at a start */
#define NO_GRIP 1e-6 /* of the reference friction */

typedef struct {
  double load, friction; /* sums or load-weighted means of the contacts */
  double normal[3], rho[3]; /* unit normal; contact patch relative to the wheel centre, in the wheel plane */
  double near_normal[3], near_rho[3]; /* of the nearest contact, also in the air */
} patch;

/* Radial forces of all contacts: adds to f, S and potential, returns the mean patch. */
static patch radial(ali3_element_args *a, const double e[3]) {
  const double *p = a->real;
  ali3_contact contact[2];
  patch mean = {0};
  double deepest = -INFINITY, between[7] = {0}, switching = 0.0;
  const int count = ali3_road_contacts(&a->roads[a->integer[0]], a->u, e, p[RADIUS], contact);
  for (int k = 0; k < count; k++) {
    const ali3_contact *c = &contact[k];
    const double depth = c->penetration, radius = p[RADIUS] - depth, lean = ali3_dot(e, c->normal);
    double rho[3], b[7] = {0}, rate = 0.0;
    for (int i = 0; i < 3; i++) {
      rho[i] = radius * c->down[i];
      b[i] = c->normal[i] / c->cosine; /* minus the gradient of the depth */
      b[3 + i] = -lean * rho[i] / c->cosine * c->leaning;
    }
    if (depth > deepest) {
      deepest = depth;
      for (int i = 0; i < 3; i++) mean.near_normal[i] = c->normal[i], mean.near_rho[i] = rho[i];
    }
    if (k == 0) { /* what slips of a wheel in the air refer to */
      mean.friction = c->friction;
      for (int i = 0; i < 3; i++) mean.normal[i] = c->normal[i], mean.rho[i] = rho[i];
    }
    if (!(depth > 0.0)) continue;
    for (int i = 0; i < 6; i++) rate -= b[i] * a->ud[i];
    const double deep = depth - (p[RADIUS] - p[BOTTOMING_RADIUS]), hard = deep > 0.0 ? p[BOTTOMING_STIFFNESS] : 0.0;
    const double ramp = depth < TOUCH_DEPTH ? depth / TOUCH_DEPTH : 1.0;
    const double part = 1.0 - c->yielded;
    const double force = part * (p[STIFFNESS] * depth + hard * deep + p[DAMPING] * rate * ramp);
    a->potential += part * (0.5 * (p[STIFFNESS] * depth * depth + hard * deep * deep));
    if (!(force > 0.0)) continue;
    const double load = force / c->cosine, total = mean.load + load;
    for (int i = 0; i < 6; i++) a->f[i] += force * b[i];
    for (int i = 0; i < 3; i++) { /* load-weighted, so nothing jumps when a contact comes or goes */
      mean.normal[i] = mean.load > 0.0 ? mean.normal[i] + load * c->normal[i] : load * c->normal[i];
      mean.rho[i] = (mean.load > 0.0 ? mean.load / total * mean.rho[i] : 0.0) + load / total * rho[i];
    }
    mean.friction = (mean.load > 0.0 ? mean.load / total * mean.friction : 0.0) + load / total * c->friction;
    mean.load = total;
    if (!a->S) continue;
    double stiffness = p[STIFFNESS] + hard + (ramp < 1.0 ? p[DAMPING] * rate / TOUCH_DEPTH : 0.0);
    if (stiffness < 0.0) stiffness = 0.0;
    ali3_add_outer(a->S, 7, part * (a->wK * stiffness + a->wC * p[DAMPING] * ramp), b);
    for (int i = 0; i < 7; i++) between[i] += k ? -b[i] : b[i];
    switching = a->wK * c->switching * (p[STIFFNESS] * depth + hard * deep);
  }
  if (a->S && switching > 0.0) ali3_add_outer(a->S, 7, switching, between);
  const double size = ali3_norm(mean.normal);
  for (int i = 0; i < 3; i++) mean.normal[i] = size > 0.0 ? mean.normal[i] / size : (i == 2);
  return mean;
}

/* Nearest positive semidefinite matrix; C holds xx, xy, yy. */
static void semidefinite(double C[3]) {
  const double mean = 0.5 * (C[0] + C[2]), half = 0.5 * (C[0] - C[2]), split = ali3_hypot(half, C[1]);
  if (mean >= split) return;
  const double top = mean + split > 0.0 ? mean + split : 0.0;
  const double cosine = split > 0.0 ? half / split : 0.0, sine = split > 0.0 ? C[1] / split : 0.0;
  C[0] = 0.5 * top * (1.0 + cosine);
  C[1] = 0.5 * top * sine;
  C[2] = 0.5 * top * (1.0 - cosine);
}

/* Radial return of F to the largest force of its direction, which in TMeasy is hypot(Fxm cos, Fym sin); J follows. */
static void limit(const double full[2], double F[2], double J[2][2], double safe[2]) {
  const double weight[2] = {full[0] * full[0], full[1] * full[1]};
  const double size2 = F[0] * F[0] + F[1] * F[1], bound = ali3_hypot(full[0] * F[0], full[1] * F[1]);
  if (!(bound > 0.0 && size2 > bound)) return;
  const double use = size2 / bound;
  double e[2]; /* gradient of use by F */
  for (int i = 0; i < 2; i++) e[i] = (2.0 - use * weight[i] / bound) * (F[i] / bound);
  for (int j = 0; j < 2; j++) {
    const double along = (e[0] * J[0][j] + e[1] * J[1][j]) / use;
    for (int i = 0; i < 2; i++) J[i][j] = (J[i][j] - F[i] * along) / use;
    safe[j] /= use;
  }
  for (int i = 0; i < 2; i++) F[i] /= use;
}

static double load_factor(const double *p, const patch *contact) {
  return ali3_clamp(contact->load / p[NOMINAL_LOAD], 0.0, p[MAX_LOAD_FACTOR]);
}

static double friction_ratio(const double *p, const patch *contact) {
  return contact->friction * p[FRICTION_FACTOR] / p[REFERENCE_FRICTION];
}

/* One step of the carcass with slip velocity v and transport speed w: force F, new slots, and damping matrix C = -dF/dv
 * (symmetric part, not below the safe share of the secant) as xx, xy, yy. */
static void carcass(const ali3_element_args *a, const patch *contact, const double v[2], double w, double F[2],
                    double C[3]) {
  const double *p = a->real, *c = p + CARCASS_STIFFNESS, *d = p + CARCASS_DAMPING, q = load_factor(p, contact);
  const double grip = friction_ratio(p, contact);
  const ali3_tmeasy_pair t = ali3_tmeasy_pair_at(p + CURVE_X, p + CURVE_Y, q, grip);
  const double n[2] = {v[0] / (t.scale[0] * w), v[1] / (t.scale[1] * w)};
  double gradient[2], J[2][2], safe[2], offset[2], D[2], full[2];
  double secant = ali3_tmeasy_secant(&t, n, gradient);
  if (!(grip > NO_GRIP)) /* else the slope of a grip of next to nothing would hold at rest */
    secant = gradient[0] = gradient[1] = 0.0;
  for (int i = 0; i < 2; i++) {
    const double per_slip = q / (t.scale[i] * w), g = per_slip * secant;
    const double theta = ali3_theta(a->h, c[i] / (d[i] + g)), b = a->h * theta;
    offset[i] = c[i] * (a->y_old[i] + a->h * (1.0 - theta) * a->y_old[2 + i]);
    D[i] = d[i] + b * c[i];
    full[i] = q * t.max_force[i];
    safe[i] = ALI3_SECANT_SHARE * D[i] * (g / (g + D[i]));
    F[i] = g / (g + D[i]) * (offset[i] - D[i] * v[i]);
    const double by_g = D[i] / (g + D[i]) * ((offset[i] - D[i] * v[i]) / (g + D[i]));
    for (int j = 0; j < 2; j++)
      J[i][j] = by_g * per_slip * (gradient[j] / (t.scale[j] * w)) - (i == j ? g / (g + D[i]) * D[i] : 0.0);
  }
  if (contact->load > NO_LOAD) limit(full, F, J, safe);
  for (int i = 0; i < 2; i++) {
    a->y_new[i] = a->y_old[i];
    a->y_new[2 + i] = a->y_old[2 + i];
    if (!(a->h > 0.0)) continue;
    a->y_new[2 + i] = (F[i] - offset[i]) / D[i];
    a->y_new[i] = (F[i] - d[i] * a->y_new[2 + i]) / c[i];
    if (fabs(a->y_new[i]) < 1e-100) a->y_new[i] = a->y_new[2 + i] = 0.0; /* long in the air: no denormals */
  }
  C[0] = -J[0][0] - safe[0], C[1] = -0.5 * (J[0][1] + J[1][0]), C[2] = -J[1][1] - safe[1];
  semidefinite(C);
  C[0] += safe[0];
  C[2] += safe[1];
}

/* Trail over contact length at the lateral slip s. */
static double trail_share(const double *p, const patch *contact, double s) {
  return ali3_tmeasy_trail(p + TRAIL, load_factor(p, contact), friction_ratio(p, contact), s);
}

/* An iterate of the solver need not be a unit vector. */
static void unit_axis(const double axis[3], double e[3]) {
  const double size = ali3_norm(axis);
  for (int i = 0; i < 3; i++) e[i] = size > 1e-6 ? axis[i] / size : (i == 1);
}

static void evaluate(ali3_element_args *a) {
  const double *p = a->real, *rd = a->ud, *ed = a->ud + 3, omega = a->ud[6];
  double e[3], forward[3], left[3], F[2], C[3], v[2], push[3];
  a->potential = 0.0;
  unit_axis(a->u + 3, e);
  const patch contact = radial(a, e);
  const double *rho = contact.rho, *n = contact.normal, loaded = ali3_norm(rho), turn = ali3_dot(ed, rho);

  ali3_cross(e, n, forward);
  const double upright = ali3_norm(forward), size = upright < 1e-9 ? 1.0 : upright;
  if (upright < 1e-9) forward[0] = 1.0, forward[1] = forward[2] = 0.0;
  for (int i = 0; i < 3; i++) forward[i] /= size;
  ali3_cross(n, forward, left);

  ali3_cross(e, rho, push); /* velocity of the patch per Omega */
  const double rolling = (2.0 * p[RADIUS] + (loaded < p[RADIUS] ? loaded : p[RADIUS])) / 3.0,
               transport = rolling * fabs(omega), w = transport + SLOW_SPEED;
  const double rolls = transport / ROLL_SPEED, moving = rolls < 1.0 ? rolls * rolls * (2.0 - rolls * rolls) : 1.0;
  const double ratio =
      loaded > 1e-6 ? 1.0 + moving * (rolling / loaded - 1.0) : 1.0; /* slip radius over loaded radius */
  const double *along[2] = {forward, left};
  double row[2][7], travel[2];
  for (int i = 0; i < 2; i++) {
    const double *t = along[i], spin = ali3_dot(t, push), lean = ali3_dot(t, e);
    travel[i] = ali3_dot(t, rd) - lean * turn;
    v[i] = travel[i] + ratio * spin * omega;
    for (int k = 0; k < 3; k++) row[i][k] = t[k], row[i][3 + k] = -lean * rho[k];
    row[i][6] = ratio * spin;
  }
  carcass(a, &contact, v, w, F, C);
  a->potential +=
      0.5 * (p[CARCASS_STIFFNESS] * a->y_new[0] * a->y_new[0] + p[CARCASS_STIFFNESS + 1] * a->y_new[1] * a->y_new[1]);
  for (int k = 0; k < 7; k++) a->f[k] += F[0] * row[0][k] + F[1] * row[1][k];

  const double deflection = loaded < p[RADIUS] ? p[RADIUS] - loaded : 0.0, length = 2.0 * sqrt(p[RADIUS] * deflection);
  const double moment = -moving * length * trail_share(p, &contact, fabs(v[1]) / w) * F[1],
               resist = p[ROLLING_RESISTANCE] * contact.load * p[RADIUS], roll = ali3_tanh(omega);
  double twist[3];
  ali3_cross(n, e, twist);
  for (int i = 0; i < 3; i++) a->f[3 + i] += moment * twist[i];
  a->f[6] += moment * ali3_dot(n, e) - resist * roll;

  if (a->S) {
    ali3_add_outer(a->S, 7, a->wC * C[0], row[0]);
    ali3_add_symmetric(a->S, 7, 2.0 * a->wC * C[1], row[0], row[1]);
    ali3_add_outer(a->S, 7, a->wC * C[2], row[1]);
    a->S[48] += a->wC * resist * (1.0 - roll * roll);
  }
  const double drive = -ratio * ali3_dot(forward, push) * omega; /* circumferential speed */
  const double fastest = ali3_hypot(fabs(drive) > fabs(travel[0]) ? drive : travel[0], 0.01);
  const double slip = -v[0] / fastest, slip_angle = ali3_atan2(v[1], ali3_hypot(travel[0], 0.01));
  const double out[] = {F[0], F[1], contact.load, moment, slip, slip_angle, deflection, p[RADIUS] - deflection};
  for (int i = 0; i < CONTACT_X; i++) a->out[i] = out[i];
  const double *at = contact.load > 0.0 ? rho : contact.near_rho, *up = contact.load > 0.0 ? n : contact.near_normal;
  for (int i = 0; i < 3; i++) a->out[CONTACT_X + i] = a->u[i] + at[i], a->out[NORMAL_X + i] = up[i];
  a->out[INCLINATION] = ali3_atan2(ali3_dot(e, n), upright);
}

static double depth(const ali3_element_args *a, double raised, double *part) {
  const double *axis = a->u + 3, length = ali3_norm(axis), radius = a->real[RADIUS];
  double centre[3], e[3], deepest = -INFINITY;
  for (int i = 0; i < 3; i++) {
    centre[i] = a->u[i] + (i == 2 ? raised : 0.0);
    e[i] = length > 1e-6 ? axis[i] / length : (i == 1);
  }
  ali3_contact contact[2];
  const int count = ali3_road_contacts(&a->roads[a->integer[0]], centre, e, radius, contact);
  for (int k = 0; k < count; k++)
    if (contact[k].penetration > deepest) {
      deepest = contact[k].penetration;
      *part = contact[k].cosine;
    }
  return deepest;
}

/* A start with the wheel's centre below the surface: the spring of a tyre is not meant for that and would throw the
 * scene up. The rise is the depth along the road's normal; walls are climbed a depth at a time. */
static ali3_start_verdict start(const ali3_element_args *a, double raised) {
  double part = 0.0;
  const double deepest = fmax(depth(a, raised, &part), 0.0);
  return (ali3_start_verdict){.excess = deepest - a->real[RADIUS], .rise = deepest > CLEAR ? deepest * part : 0.0};
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)nsig, (void)nreal, (void)nint, (void)n_inputs;
  if (integer[0] < 0 || integer[0] >= n_roads) return "a tyre names a road that does not exist";
  if (!(real[RADIUS] > real[BOTTOMING_RADIUS] && real[BOTTOMING_RADIUS] > 0.0))
    return "the bottoming radius of a tyre must lie between 0 and its radius";
  if (!(real[STIFFNESS] > 0.0) || real[DAMPING] < 0.0 || real[BOTTOMING_STIFFNESS] < 0.0)
    return "the vertical stiffness of a tyre must be positive, damping and bottoming stiffness not negative";
  if (!(real[NOMINAL_LOAD] > 0.0 && real[REFERENCE_FRICTION] > 0.0 && real[MAX_LOAD_FACTOR] > 0.0))
    return "nominal load, reference friction and largest load factor of a tyre must be positive";
  for (int i = 0; i < 2; i++)
    if (!(real[CARCASS_STIFFNESS + i] > 0.0 && real[CARCASS_DAMPING + i] > 0.0))
      return "carcass stiffness and damping of a tyre must be positive";
  for (int end = 0; end < 2; end++) { /* both ends of the load range; between them the curves are linear per load */
    const double q = end ? real[MAX_LOAD_FACTOR] : 0.0;
    for (int direction = 0; direction < 2; direction++) {
      const ali3_tmeasy t = ali3_tmeasy_at(real + (direction ? CURVE_Y : CURVE_X), q, 1.0);
      if (!(t.slope > 0.0 && t.max_force > 0.0 && t.slide_force > 0.0))
        return "a tyre force becomes zero or negative within its range of loads";
      if (!(t.max_slip > 0.0 && t.slide_slip > t.max_slip))
        return "the slips of a tyre must be positive and sliding must come after the maximum";
    }
    const double *z = real + TRAIL + 2;
    const double zero = z[0] + (z[1] - z[0]) * (q - 1.0), last = z[2] + (z[3] - z[2]) * (q - 1.0);
    if (!(zero > 0.0 && last > zero)) return "the slips of a tyre's trail must be positive and increasing";
  }
  if (real[ROLLING_RESISTANCE] < 0.0 || real[FRICTION_FACTOR] < 0.0)
    return "rolling resistance and friction factor of a tyre must not be negative";
  return 0;
}

const ali3_element_type ali3_tyre = {
    .evaluate = evaluate,
    .start = start,
    .start_words = "lies deeper in the road than its radius",
    .depth = depth,
    .nsig = 7,
    .nreal = REALS,
    .nint = 1,
    .nstate = 4,
    .nout = OUTPUTS,
    .check = check,
};
