/* Tyre on a road with the Magic Formula: radial spring of a disc, steady forces of magic_formula.h, on the carcass of
 * tyre_carcass.h.
 *
 * Signals, states and axes are as in tyre.c; the formula has the axes of its file, converted by signs. PRESSURE is the
 * pressure divided by the nominal pressure, minus 1; ANGLE_RANGE limits the tangent of the slip angle; the coefficients
 * follow the numbers. The bore torque decreases to 0 at ALI3_TYRE_ROLLS, above which the formula includes the moments
 * about the normal.
 *
 * Slips are velocities divided by the speed of travel; below ALI3_TYRE_ROLLS the sliding speed is included in it, so
 * that the force of a wheel that slides sideways from rest is opposite to its slip velocity. The carcass follows
 * F = F_steady(v) - g x' with the secant slip damping g without shifts:
 *   F = (D F_steady + g c a)/(g + D).
 * Its relaxation length is g w/c. c depends on the load by the file; d is the damping of a standing tyre and
 * decreases with the square of the speed, so that it does not lengthen the relaxation. Shifts, camber thrust and
 * moments about the normal and about the direction of travel increase with the speed of travel up to ALI3_TYRE_ROLLS,
 * as a standing tyre is a spring. The lever of F about the axle is the effective radius, as in tyre.c.
 *
 * The tangent neglects the terms that tyre.c neglects, and the moments. */
#include <stddef.h>

#include "../algebra/elementary.h"
#include "element.h"
#include "element_math.h"
#include "magic_formula.h"
#include "magic_tyre_fields.h"
#include "tyre_bore.h"
#include "tyre_carcass.h"
#include "tyre_contact.h"

enum { COEFFICIENTS = MAGIC_TYRE_REALS };
enum { SLIP, CAMBER, FORCE }; /* indices of the signs that convert ISO axes to axes of the file */

/* The steady force at a slip velocity, ISO axes of the road. */
typedef struct {
  bool grips; /* by load and friction; otherwise the force is 0 */
  ali3_magic_state state; /* of the formula */
  ali3_magic_force at; /* forces, N, with derivatives J by the slip velocity, N s/m */
  double g[2], g_by[2][2]; /* N s/m: secant slip damping without shifts; its derivatives by the velocity */
} steady_force;

/* The force of a patch on its wheel, ISO axes of the road. */
typedef struct {
  double F[2], C[3], Mx, My, Mz; /* N, N s/m, N m; C = -dF/dv as xx, xy, yy */
  double stiffness[2]; /* of the carcass, N/m */
} reaction;

/* Friction of the road relative to the friction of the measured tyre. */
static double find_friction_ratio(const double *p, const ali3_tyre_patch *contact) {
  return contact->friction * p[FRICTION_FACTOR] / p[REFERENCE_FRICTION];
}

/* The operating point of the formula. */
static ali3_magic_state make_state(const ali3_element_args *a, const ali3_tyre_patch *contact,
                                   const ali3_tyre_motion *m, double inclination) {
  const double *p = a->real, max_load = p[LARGEST_LOAD], grip = find_friction_ratio(p, contact);
  return (ali3_magic_state){
      .c = p + COEFFICIENTS,
      .version = a->integer[VERSION],
      .combined = a->integer[COMBINATION],
      .nominal_load = p[NOMINAL_LOAD],
      .radius = p[RADIUS],
      .load = contact->load < max_load ? contact->load : max_load,
      .camber = p[SIGN + CAMBER] * ali3_clamp(inclination, p[CAMBER_RANGE], p[CAMBER_RANGE + 1]),
      .pressure = p[PRESSURE],
      .friction = {grip * p[LMUX], grip * p[LMUY]},
      .stiffness = {p[LKX], p[LKY]},
      .moving = ali3_tyre_moving(fabs(m->travel[0])),
      .direction = m->travel[0] < 0.0 ? -1.0 : 1.0,
      .speed = fabs(m->travel[0]),
      .slide = ali3_hypot(m->v[0], m->v[1]),
  };
}

/* Longitudinal slip (0) or tangent of the slip angle (1) in axes of the file, within its range. */
typedef struct {
  double value, slope; /* slope by the slip velocity, s/m */
  double inside; /* 1, or the fraction of the slip that is in the range: beyond it the force is constant */
} limited_slip;

static limited_slip find_slip(ali3_element_args *a, int direction, double velocity, double w) {
  const double *p = a->real, sign = direction ? p[SIGN + SLIP] : -1.0, raw = sign * velocity / w;
  const double *range = p + (direction ? ANGLE_RANGE : SLIP_RANGE), value = ali3_clamp(raw, range[0], range[1]);
  if (value == raw) return (limited_slip){value, sign / w, 1.0};
  a->piece |= (uint32_t)ALI3_TYRE_AT_RANGE << direction;
  return (limited_slip){value, 0.0, value / raw};
}

/* The steady force at the slip velocity m->v and the speed of travel w, m/s. */
static void find_steady_force(ali3_element_args *a, const ali3_tyre_patch *contact, const ali3_tyre_motion *m, double w,
                              double inclination, steady_force *s) {
  const double *p = a->real, force_sign[2] = {1.0, p[SIGN + FORCE]};
  const limited_slip slip[2] = {find_slip(a, 0, m->v[0], w), find_slip(a, 1, m->v[1], w)};
  ali3_magic_force *f = &s->at;
  s->state = make_state(a, contact, m, inclination);
  if (s->state.load < contact->load) a->piece |= ALI3_TYRE_OVERLOADED;
  if (s->state.camber != p[SIGN + CAMBER] * inclination) a->piece |= ALI3_TYRE_AT_RANGE << 2;
  ali3_magic_forces(&s->state, slip[0].value, slip[1].value, f);
  for (int i = 0; i < 2; i++) {
    s->g[i] = f->secant[i] * slip[i].inside / w;
    f->F[i] *= force_sign[i];
    for (int j = 0; j < 2; j++) {
      f->J[i][j] *= force_sign[i] * slip[j].slope;
      s->g_by[i][j] = f->secant_slope[i][j] * slip[j].slope * slip[i].inside / w;
    }
    if (slip[i].inside < 1.0) s->g_by[i][i] -= s->g[i] / m->v[i];
  }
}

/* Forces of the carcass before they are limited, with derivatives. */
static ali3_tyre_force solve_carcass(const ali3_element_args *a, const steady_force *s, double travel,
                                     ali3_tyre_carcass *carcass) {
  const double fast = travel / ALI3_TYRE_ROLLS;
  ali3_tyre_force f;
  for (int i = 0; i < 2; i++) {
    const double c = s->at.carcass[i], d = c * a->real[SETTLING] / (1.0 + fast * fast), g = s->g[i];
    ali3_tyre_carcass_at(a, i, c, d, g, carcass, &f);
    const double D = carcass->D[i], sum = g + D, offset = carcass->offset[i], steady = s->at.F[i];
    f.F[i] = D / sum * steady + g / sum * offset;
    const double by_g = D / sum * ((offset - steady) / sum);
    for (int j = 0; j < 2; j++) f.J[i][j] = D / sum * s->at.J[i][j] + by_g * s->g_by[i][j];
  }
  return f;
}

/* Scales the force down to the ellipse of the peaks, or to the ellipse through the steady force if it is larger. */
static void limit_force(ali3_element_args *a, const ali3_magic_force *steady, ali3_tyre_force *f) {
  const double *peak = steady->peak, *F = f->F, demand = ali3_hypot(F[0] / peak[0], F[1] / peak[1]),
               bound = fmax(ali3_hypot(steady->F[0] / peak[0], steady->F[1] / peak[1]), 1.0);
  if (!(demand > bound)) return;
  const double factor = bound / demand;
  a->piece |= ALI3_TYRE_AT_LIMIT;
  for (int j = 0; j < 2; j++) {
    double along = 0.0;
    for (int i = 0; i < 2; i++) along += F[i] / (peak[i] * peak[i]) * f->J[i][j] / (demand * demand);
    for (int i = 0; i < 2; i++) f->J[i][j] = factor * (f->J[i][j] - F[i] * along);
    f->safe[j] *= factor;
  }
  for (int i = 0; i < 2; i++) f->F[i] *= factor;
}

/* Steps the bore torque, which shares the friction of the patch with the horizontal force. */
static void step_bore(ali3_element_args *a, const steady_force *s, const ali3_tyre_motion *m, ali3_tyre_bore *bore,
                      ali3_tyre_force *f) {
  const double *peak = s->at.peak;
  const ali3_tyre_horizontal_force by = {.slope = s->at.cornering * (1.0 - ali3_tyre_moving(fabs(m->travel[0]))),
                                         .most = s->grips ? peak[1] : 0.0,
                                         .transport = ali3_hypot(m->travel[0], ALI3_TYRE_SLOW),
                                         .slip = ali3_hypot(m->v[0], m->v[1]),
                                         .force = ali3_hypot(f->F[0], f->F[1]),
                                         .steady = ali3_hypot(s->at.F[0], s->at.F[1]),
                                         .use = fmin(ali3_hypot(f->F[0] / peak[0], f->F[1] / peak[1]), 1.0)};
  ali3_tyre_bore_step(a, bore, &by, f);
}

/* Moments of the formula at the forces of the carcass. */
static void write_moments(const double *p, steady_force *s, reaction *r) {
  const double acting[2] = {r->F[0], p[SIGN + FORCE] * r->F[1]}; /* axes of the file */
  s->at.F[1] *= p[SIGN + FORCE];
  ali3_magic_moments(&s->state, acting, &s->at);
  r->Mx = p[SIGN + CAMBER] * s->at.Mx, r->My = s->at.My, r->Mz = p[SIGN + FORCE] * s->at.Mz;
}

/* One step of the carcass: forces, moments, damping matrix and new states; bore: NULL, or the bore torque to step. */
static reaction step_carcass(ali3_element_args *a, const ali3_tyre_patch *contact, const ali3_tyre_motion *m,
                             double inclination, ali3_tyre_bore *bore) {
  const double *p = a->real;
  const double sliding_at_rest = (1.0 - ali3_tyre_moving(fabs(m->travel[0]))) * ali3_hypot(m->v[0], m->v[1]);
  const double w = ali3_hypot(ali3_hypot(m->travel[0], ALI3_TYRE_SLOW), sliding_at_rest);
  steady_force s = {.grips = contact->load > ALI3_TYRE_NO_LOAD && find_friction_ratio(p, contact) > ALI3_TYRE_NO_GRIP,
                    .at = {.peak = {1.0, 1.0}, .carcass = {p[STIFFNESS], p[STIFFNESS]}}};
  ali3_tyre_carcass carcass;
  if (s.grips) find_steady_force(a, contact, m, w, inclination, &s);
  ali3_tyre_force f = solve_carcass(a, &s, m->travel[0], &carcass);
  if (s.grips) limit_force(a, &s.at, &f);
  if (bore) step_bore(a, &s, m, bore, &f);
  reaction r = {.F = {f.F[0], f.F[1]}, .stiffness = {carcass.stiffness[0], carcass.stiffness[1]}};
  if (s.grips) write_moments(p, &s, &r);
  ali3_tyre_deflect(a, &carcass, f.F);
  ali3_tyre_damping(&f, r.C);
  return r;
}

/* Radial spring at the spin omega, rad/s, after Besselink et al. (magic_formula.h): radius and stiffness increase with
 * the speed, the stiffness also by the factor `inflated` of the pressure. */
static ali3_tyre_spring make_spring(const double *p, double omega, double inflated) {
  const double *c = p + COEFFICIENTS, fast = fabs(omega) * p[RADIUS] / c[ALI3_MF_LONGVL];
  const double radius = p[RADIUS] * (c[ALI3_MF_Q_RE0] + c[ALI3_MF_Q_V1] * fast * fast);
  const double harder = (1.0 + c[ALI3_MF_Q_V2] * fast) * inflated;
  return (ali3_tyre_spring){radius,     p[BOTTOMING_RADIUS],   harder * p[STIFFNESS], harder * p[PROGRESSION],
                            p[DAMPING], p[BOTTOMING_STIFFNESS]};
}

/* Effective rolling radius, m, at a deflection, m. */
static double find_effective_radius(const double *p, const ali3_tyre_spring *spring, double inflated,
                                    double deflection) {
  const ali3_magic_state formula = {.c = p + COEFFICIENTS, .nominal_load = p[NOMINAL_LOAD]};
  const double nominal_stiffness =
                   inflated * sqrt(p[STIFFNESS] * p[STIFFNESS] + 4.0 * p[PROGRESSION] * p[NOMINAL_LOAD]),
               stiffness = spring->stiffness + spring->progression * deflection;
  return ali3_magic_rolling_radius(&formula, spring->radius, nominal_stiffness, deflection,
                                   stiffness / nominal_stiffness);
}

/* Adds the moments about the road's normal and forward, and the rolling resistance, which fades with the spin by
 * tanh(omega); bore: NULL, or the bore torque, whose tangent is added. */
static void add_moments(ali3_element_args *a, const double n[3], const double forward[3], const double e[3],
                        const reaction *r, double roll, const ali3_tyre_bore *bore) {
  double moment[3], twist[3];
  for (int i = 0; i < 3; i++) moment[i] = r->Mz * n[i] + r->Mx * forward[i];
  ali3_cross(moment, e, twist);
  for (int i = 0; i < 3; i++) a->f[3 + i] += twist[i];
  a->f[6] += ali3_dot(moment, e) - r->My * roll;
  if (!a->S) return;
  if (bore) ali3_add_outer(a->S, 7, a->wC * bore->C, bore->row);
  a->S[6 * 7 + 6] += a->wC * r->My * (1.0 - roll * roll);
}

static void evaluate(ali3_element_args *a) {
  const double *p = a->real, omega = a->ud[6], inflated = 1.0 + p[COEFFICIENTS + ALI3_MF_PFZ1] * p[PRESSURE];
  const ali3_tyre_spring spring = make_spring(p, omega, inflated);
  double e[3];
  a->potential = 0.0;
  ali3_tyre_axis(a->u + 3, e);
  const ali3_tyre_patch contact = ali3_tyre_radial(a, e, &spring);
  ali3_tyre_motion m = ali3_tyre_axes(&contact, e);
  const double *n = contact.normal, deflection = m.loaded < spring.radius ? spring.radius - m.loaded : 0.0;
  const double effective = find_effective_radius(p, &spring, inflated, deflection);
  const double ratio =
      m.loaded > 1e-6 ? 1.0 + ali3_tyre_moving(effective * fabs(omega)) * (effective / m.loaded - 1.0) : 1.0;
  ali3_tyre_velocities(a, &contact, e, ratio, &m);

  ali3_tyre_bore twist, *bore = NULL;
  if (a->nint > WITH_BORE) {
    twist = ali3_tyre_bore_at(a, p + BORE, n, e, 2.0 * sqrt(spring.radius * deflection));
    bore = &twist;
  }
  reaction r = step_carcass(a, &contact, &m, ali3_atan2(ali3_dot(e, n), m.upright), bore);
  if (bore) {
    r.Mz += bore->moment;
    a->potential += ali3_tyre_bore_energy(a, bore);
  }
  for (int i = 0; i < 2; i++) a->potential += 0.5 * r.stiffness[i] * a->y_new[i] * a->y_new[i];
  ali3_tyre_add_force(a, &m, r.F, r.C);
  const double roll = ali3_tanh(omega);
  add_moments(a, n, m.forward, e, &r, roll, bore);
  ali3_tyre_outputs(a, &contact, e, &m, spring.radius, ratio, r.F, r.Mz, -r.My * roll);
  a->out[MAGIC_TYRE_OUT_OVERTURNING_MOMENT] = r.Mx;
  a->out[MAGIC_TYRE_OUT_RESISTANCE_MOMENT] = -r.My * roll;
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint) {
  (void)nsig, (void)nreal, (void)nint;
  const double *c = real + COEFFICIENTS;
  const int32_t version = integer[VERSION];
  if (version != ALI3_MAGIC_PAC2002 && version != ALI3_MAGIC_61 && version != ALI3_MAGIC_62)
    return "a tyre has an unknown version of the Magic Formula";
  if (!(real[RADIUS] > real[BOTTOMING_RADIUS])) return "the bottoming radius of a tyre must be less than its radius";
  if (!(c[ALI3_MF_LFZO] > 0.0 && c[ALI3_MF_LONGVL] > 0.0)) return "LFZO and LONGVL of a tyre must be positive";
  if (!(c[ALI3_MF_PKX1] > 0.0)) return "PKX1 of a tyre must be positive";
  if (!(real[PRESSURE] > -1.0)) return "the pressure of a tyre must be positive";
  for (int i = 0; i < 3; i++)
    if (fabs(real[SIGN + i]) != 1.0) return "a sign of a tyre is neither 1 nor -1";
  for (int i = SLIP_RANGE; i < LARGEST_LOAD; i += 2)
    if (!(real[i] <= 0.0 && real[i + 1] >= 0.0 && real[i] < real[i + 1]))
      return "a range of slips or camber of a tyre does not contain zero";
  if (c[ALI3_MF_PCX1] * c[ALI3_MF_LCX] * c[ALI3_MF_PDX1] * c[ALI3_MF_PKX1] == 0.0 ||
      c[ALI3_MF_PCY1] * c[ALI3_MF_LCY] * c[ALI3_MF_PDY1] * c[ALI3_MF_PKY1] * c[ALI3_MF_PKY2] == 0.0)
    return "a tyre lacks shape, friction or slip stiffness";
  if (!(c[ALI3_MF_LMUX] > 0.0 && c[ALI3_MF_LMUY] > 0.0 && c[ALI3_MF_LKX] > 0.0 && c[ALI3_MF_LKY] > 0.0))
    return "LMUX, LMUY, LKX and LKY of a tyre must be positive";
  return 0;
}

const ali3_element_type ali3_magic_tyre = {
    ALI3_MAGIC_TYRE,          .evaluate = evaluate,
    .start = ali3_tyre_start, .start_words = ALI3_TYRE_START_WORDS,
    .depth = ali3_tyre_depth, .n_forces = ALI3_TYRE_FORCES,
    .check = check,
};
