/* Tyre on a road: radial spring of a disc, horizontal forces by TMeasy (G. Rill, Road Vehicle Dynamics, CRC Press,
 * 2011, chapter 3; tmeasy.c) on the carcass of tyre_carcass.h.
 *
 * The spin chi has chi' = Omega, rad/s, the absolute rate about the axis e (> 0 rolling forward). Forces and slip
 * velocities are along `forward` and `left` in the road's plane, with its normal upwards. States are those of the
 * carcass, then those of tyre_bore.h. Of two contacts outputs are the means by load; in the air the contact is the
 * point of the road that is nearest within the wheel plane, with its normal.
 *
 * Two radii are kept apart: the contact patch lies at the loaded radius |rho|; the rolling wheel advances by the
 * larger effective radius (2 R + |rho|)/3 per radian, so that one is used in the slip velocity and, for the same power
 * F v_s, as the lever of F about the axle: the pressure under a driven wheel moves by that difference. With the loaded
 * radius as lever a driven tyre would generate energy, Fx (v - |rho| Omega). At standstill both are the
 * loaded radius, which makes the carcass a true spring.
 *
 * The steady force is -g v_s with the secant slip damping g = |F_steady|/|v_s| of a direction. On the carcass
 * F (v_s + x') = -F^2/g <= 0: sliding only takes energy. A step has
 *   F = g (c a - D v_s)/(g + D),   x' = (F - c a)/D,
 * finite from g = 0 to g = infinity. F is then limited to the largest force of its direction.
 *
 * Camber acts as a lateral slip: v_s = v_y + camber_slip sin(gamma) r |Omega|, nothing at rest. That part of the force
 * has no trail. F acts on Omega by the same factor, so that camber thrust takes its work from the spin.
 *
 * The tangent leaves out the coupling of load and horizontal force and the turning of the frames. */
#include <stddef.h>

#include "../algebra/elementary.h"
#include "element.h"
#include "element_math.h"
#include "tmeasy.h"
#include "tyre_bore.h"
#include "tyre_carcass.h"
#include "tyre_contact.h"
#include "tyre_fields.h"

/* Load relative to the nominal load, limited. */
static real find_load_factor(const real *p, const ali3_tyre_patch *contact) {
  return ali3_clamp(contact->load / p[TYRE_NOMINAL_LOAD], ali3_same(0.0), p[TYRE_MAX_LOAD_FACTOR]);
}

/* Friction of the road relative to the friction of the measured tyre. */
static real find_friction_ratio(const real *p, const ali3_tyre_patch *contact) {
  return contact->friction * p[TYRE_FRICTION_FACTOR] / p[TYRE_REFERENCE_FRICTION];
}

/* Steady force -g v of TMeasy at a slip velocity v. */
typedef struct {
  lane_mask loaded,
      grips; /* by load; by friction: without this limit the initial slope would transmit a force at rest at
                          almost no grip */
  real load_factor, friction_ratio, transport; /* transport speed, m/s */
  real g[2], max_force[2]; /* N s/m; N */
  real per_slip[2], secant_slope[2]; /* N s/m: g = per_slip secant; derivative of the secant by v, s/m */
} steady_force;

/* The steady force at the slip velocity v and the transport speed w, m/s. */
static steady_force find_steady_force(const real *p, const ali3_tyre_patch *contact, const real v[2], real w) {
  const real none = {0};
  steady_force s = {.loaded = contact->load > ALI3_TYRE_NO_LOAD,
                    .load_factor = find_load_factor(p, contact),
                    .friction_ratio = find_friction_ratio(p, contact),
                    .transport = w};
  s.grips = s.friction_ratio > ALI3_TYRE_NO_GRIP;
  const ali3_tmeasy_pair t =
      ali3_tmeasy_pair_at(p + TYRE_LONGITUDINAL, p + TYRE_LATERAL, s.load_factor, s.friction_ratio);
  const real n[2] = {v[0] / (t.scale[0] * w), v[1] / (t.scale[1] * w)};
  real gradient[2];
  const real secant = ali3_where(s.grips, ali3_tmeasy_secant(&t, n, gradient), none);
  for (int i = 0; i < 2; i++) {
    s.per_slip[i] = s.load_factor / (t.scale[i] * w);
    s.g[i] = s.per_slip[i] * secant;
    s.secant_slope[i] = ali3_where(s.grips, gradient[i], none) / (t.scale[i] * w);
    s.max_force[i] = s.load_factor * t.max_force[i];
  }
  return s;
}

/* Forces of the carcass before they are limited, with derivatives. */
static ali3_tyre_force solve_carcass(const ali3_element_args *a, const steady_force *s, const real v[2],
                                     ali3_tyre_carcass *carcass) {
  const real *c = a->real + TYRE_CARCASS_STIFFNESS, *d = a->real + TYRE_CARCASS_DAMPING, none = {0};
  ali3_tyre_force f;
  for (int i = 0; i < 2; i++) {
    const real g = s->g[i];
    ali3_tyre_carcass_at(a, i, c[i], d[i], g, carcass, &f);
    const real D = carcass->D[i], sum = g + D, driving = carcass->offset[i] - D * v[i];
    f.F[i] = g / sum * driving;
    const real by_g = D / sum * (driving / sum);
    for (int j = 0; j < 2; j++) f.J[i][j] = by_g * s->per_slip[i] * s->secant_slope[j] - (i == j ? g / sum * D : none);
  }
  return f;
}

/* Radial return of F to the largest force of its direction, in TMeasy hypot(Fxm cos, Fym sin). */
static void limit_force(ali3_element_args *a, const steady_force *s, ali3_tyre_force *f) {
  const real *most = s->max_force, *F = f->F, weight[2] = {most[0] * most[0], most[1] * most[1]};
  const real size2 = F[0] * F[0] + F[1] * F[1], bound = ali3_hypot(most[0] * F[0], most[1] * F[1]);
  const lane_mask exceeds = s->loaded & (bound > 0.0) & (size2 > bound);
  ALI3_PIECE(&a->piece, exceeds, ALI3_TYRE_AT_LIMIT);
  if (!ali3_any(exceeds)) return;
  const real scale = size2 / bound;
  real e[2]; /* gradient of `scale` by F */
  for (int i = 0; i < 2; i++) e[i] = (2.0 - scale * weight[i] / bound) * (F[i] / bound);
  for (int j = 0; j < 2; j++) {
    const real along = (e[0] * f->J[0][j] + e[1] * f->J[1][j]) / scale;
    for (int i = 0; i < 2; i++) f->J[i][j] = ali3_where(exceeds, (f->J[i][j] - F[i] * along) / scale, f->J[i][j]);
    f->safe[j] = ali3_where(exceeds, f->safe[j] / scale, f->safe[j]);
  }
  for (int i = 0; i < 2; i++) f->F[i] = ali3_where(exceeds, F[i] / scale, F[i]);
}

/* Steps the bore torque, which shares the friction of the patch with the horizontal force. */
static void step_bore(ali3_element_args *a, const steady_force *s, const real v[2], ali3_tyre_bore *bore,
                      ali3_tyre_force *f) {
  const real *F = f->F, none = {0};
  const real size2 = F[0] * F[0] + F[1] * F[1], bound = ali3_hypot(s->max_force[0] * F[0], s->max_force[1] * F[1]);
  const ali3_tmeasy lateral = ali3_tmeasy_at(a->real + TYRE_LATERAL, s->load_factor, s->friction_ratio);
  const ali3_tyre_horizontal_force by = {.slope = s->load_factor * lateral.slope,
                                         .most = ali3_where(s->loaded & s->grips, s->max_force[1], none),
                                         .transport = s->transport,
                                         .slip = ali3_hypot(v[0], v[1]),
                                         .force = ali3_sqrt(size2),
                                         .steady = ali3_hypot(s->g[0] * v[0], s->g[1] * v[1]),
                                         .use = ali3_where(s->loaded & (bound > 0.0), size2 / bound, none)};
  ali3_tyre_bore_step(a, bore, &by, f);
}

/* One step of the carcass with the steady force s at the slip velocity v, m/s: new states, force F and damping matrix C
 * = -dF/dv as xx, xy, yy; bore: NULL, or the bore torque to step. */
static void step_carcass(ali3_element_args *a, const steady_force *s, const real v[2], ali3_tyre_bore *bore, real F[2],
                         real C[3]) {
  ali3_tyre_carcass carcass;
  ali3_tyre_force f = solve_carcass(a, s, v, &carcass);
  limit_force(a, s, &f);
  if (bore) step_bore(a, s, v, bore, &f);
  ali3_tyre_deflect(a, &carcass, f.F);
  ali3_tyre_damping(&f, C);
  for (int i = 0; i < 2; i++) F[i] = f.F[i];
}

/* Trail divided by contact length at the lateral slip s, behind the middle of the patch in the direction of rolling:
 * the tread deflects from its leading edge, which in reverse is the other edge. */
static real find_relative_trail(const real *p, const ali3_tyre_patch *contact, real s, real omega) {
  const real trail =
      ali3_tmeasy_trail(p + TYRE_TRAIL, find_load_factor(p, contact), find_friction_ratio(p, contact), s);
  return ali3_where(omega < 0.0, -trail, trail);
}

/* How the wheel rolls on a patch at the loaded radius. */
typedef struct {
  real radius, transport; /* m: effective radius; m/s: circumferential speed with it, not negative */
  real moving, ratio; /* 0 at rest to 1; slip radius over loaded radius */
  real length; /* m, of the patch */
} rolling;

static rolling find_rolling(real radius, real loaded, real omega) {
  const real none = {0};
  const lane_mask deflected = loaded < radius;
  rolling r = {.radius = (2.0 * radius + ali3_where(deflected, loaded, radius)) / 3.0};
  r.transport = r.radius * ali3_abs(omega);
  r.moving = ali3_tyre_moving(r.transport);
  r.ratio = ali3_where(loaded > 1e-6, 1.0 + r.moving * (r.radius / loaded - 1.0), ali3_same(1.0));
  r.length = 2.0 * ali3_sqrt(radius * ali3_where(deflected, radius - loaded, none));
  return r;
}

/* Slip velocity of the camber per spin, m; sine: of the inclination. */
static real find_camber_slip(const real *p, real sine, const rolling *r, real omega) {
  const real per_spin = p[TYRE_CAMBER_SLIP] * sine * r->radius;
  return ali3_where(omega < 0.0, -per_spin, per_spin);
}

/* Adds the energy of the carcass and of the bore torque's spring. */
static void add_carcass_energy(ali3_element_args *a, const ali3_tyre_bore *bore) {
  const real *c = a->real + TYRE_CARCASS_STIFFNESS, *y = a->y_new;
  a->potential += 0.5 * (c[0] * y[0] * y[0] + c[1] * y[1] * y[1]);
  if (bore) a->potential += ali3_tyre_bore_energy(a, bore);
}

/* Adds the moment about the road's normal n, N m, and the rolling resistance `resist`, N m, which fades with the spin
 * by tanh(omega); bore: NULL, or the bore torque, whose tangent is added. */
static void add_moments(ali3_element_args *a, const real n[3], const real e[3], real moment, real resist, real roll,
                        const ali3_tyre_bore *bore) {
  real twist[3];
  ali3_cross(n, e, twist);
  for (int i = 0; i < 3; i++) a->f[3 + i] += moment * twist[i];
  a->f[6] += moment * ali3_dot(n, e) - resist * roll;
  if (!a->S) return;
  if (bore) ali3_add_outer(a->S, 7, a->wC * bore->C, bore->row);
  a->S[6 * 7 + 6] += a->wC * resist * (1.0 - roll * roll);
}

static void evaluate(ali3_element_args *a) {
  const real *p = a->real, omega = a->ud[6], none = {0};
  const ali3_tyre_spring spring = {p[TYRE_RADIUS], p[TYRE_BOTTOMING_RADIUS], p[TYRE_STIFFNESS],
                                   none,           p[TYRE_DAMPING],          p[TYRE_BOTTOMING_STIFFNESS]};
  real e[3], F[2], C[3];
  a->potential = none;
  ali3_tyre_axis(a->u + 3, e);
  const ali3_tyre_patch contact = ali3_tyre_radial(a, e, &spring);
  const real *n = contact.normal;
  ALI3_PIECE(&a->piece,
             (contact.load > ALI3_TYRE_NO_LOAD) & (contact.load > p[TYRE_MAX_LOAD_FACTOR] * p[TYRE_NOMINAL_LOAD]),
             ALI3_TYRE_OVERLOADED);
  ali3_tyre_motion m = ali3_tyre_axes(&contact, e);
  const rolling r = find_rolling(p[TYRE_RADIUS], m.loaded, omega);
  ali3_tyre_velocities(a, &contact, e, r.ratio, &m);

  const bool has_camber_slip = ali3_any(p[TYRE_CAMBER_SLIP] != 0.0), has_bore = a->nint > TYRE_WITH_BORE;
  real v[2] = {m.v[0], m.v[1]}, camber_velocity = none, by_spin = none;
  if (has_camber_slip) {
    by_spin = find_camber_slip(p, ali3_dot(e, n), &r, omega);
    camber_velocity = by_spin * omega;
    v[1] += camber_velocity;
    m.row[1][6] += by_spin;
  }
  ali3_tyre_bore twist, *bore = NULL;
  if (has_bore) {
    twist = ali3_tyre_bore_at(a, p + TYRE_BORE, n, e, r.length);
    bore = &twist;
  }
  const real w = r.transport + ALI3_TYRE_SLOW;
  const steady_force steady = find_steady_force(p, &contact, v, w);
  step_carcass(a, &steady, v, bore, F, C);
  add_carcass_energy(a, bore);
  ali3_tyre_add_force(a, &m, F, C);

  const real trail_force = has_camber_slip ? F[1] + steady.g[1] * camber_velocity : F[1];
  real moment = -r.moving * r.length * find_relative_trail(p, &contact, ali3_abs(m.v[1]) / w, omega) * trail_force;
  if (bore) moment += bore->moment;
  const real resist = p[TYRE_ROLLING_RESISTANCE] * contact.load * p[TYRE_RADIUS], roll = ali3_tanh(omega);
  add_moments(a, n, e, moment, resist, roll, bore);
  ali3_tyre_outputs(a, &contact, e, &m, p[TYRE_RADIUS], r.ratio, F, moment,
                    has_camber_slip ? F[1] * by_spin - resist * roll : -resist * roll);
}

#ifndef ALI3_WIDTH
/* NULL, or what is wrong with the curves at a load factor q. */
static const char *check_curves(const double *real, double q) {
  for (int direction = 0; direction < 2; direction++) {
    const ali3_tmeasy t = ali3_tmeasy_at(real + (direction ? TYRE_LATERAL : TYRE_LONGITUDINAL), q, 1.0);
    if (!(t.slope > 0.0 && t.max_force > 0.0 && t.slide_force > 0.0))
      return "a tyre force becomes zero or negative within its range of loads";
    if (!(t.max_slip > 0.0 && t.slide_slip > t.max_slip))
      return "the slips of a tyre must be positive and sliding must come after the maximum";
  }
  const double *z = real + TYRE_TRAIL_ZERO;
  const double zero = z[0] + (z[1] - z[0]) * (q - 1.0), end = z[2] + (z[3] - z[2]) * (q - 1.0);
  return zero > 0.0 && end > zero ? NULL : "the slips of a tyre's trail must be positive and increasing";
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint) {
  (void)nsig, (void)nreal, (void)integer, (void)nint;
  if (!(real[TYRE_RADIUS] > real[TYRE_BOTTOMING_RADIUS]))
    return "the bottoming radius of a tyre must be less than its radius";
  /* at both ends of the load range; between them the curves are linear in the load */
  const char *at_no_load = check_curves(real, 0.0);
  return at_no_load != NULL ? at_no_load : check_curves(real, real[TYRE_MAX_LOAD_FACTOR]);
}

const ali3_element_type ali3_tyre = {
    ALI3_TYRE,
    .evaluate = evaluate,
    .start = ali3_tyre_start,
    .start_words = ALI3_TYRE_START_WORDS,
    .depth = ali3_tyre_depth,
    .n_forces = ALI3_TYRE_FORCES,
    .check = check,
};
#endif
