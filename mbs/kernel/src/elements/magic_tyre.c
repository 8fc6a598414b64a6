/* Tyre on a road with the Magic Formula: radial spring of a disc, steady forces of magic_formula.h, first-order carcass
 * deflections by the same equations at standstill, rolling, sliding and in the air.
 *
 * Signals and states are as in tyre.c. PRESSURE is the pressure divided by the nominal pressure, minus 1; ANGLE_RANGE
 * limits the tangent of the slip angle; the coefficients follow the numbers. The bore torque decreases to 0 at
 * ALI3_TYRE_ROLLS, above which the formula includes the moments about the normal.
 *
 * Slips are velocities divided by the speed of travel; below ALI3_TYRE_ROLLS the sliding speed is included in it, so
 * that the force of a wheel that slides sideways from rest is opposite to its slip velocity. The carcass follows, per
 * direction, F = F_steady(v) - g x' = c x + d x' with the secant slip damping g without shifts; in tyre.c F_steady = -g
 * v. Its relaxation length is g w/c. c depends on the load by the file; d is the damping of a standing tyre and
 * decreases with the square of the speed, so that it does not lengthen the relaxation. Shifts, camber thrust and
 * moments about the normal and about the direction of travel increase with the speed of travel up to ALI3_TYRE_ROLLS,
 * as a standing tyre is a spring. The lever of F about the axle is the effective radius, as in tyre.c.
 *
 * The tangent neglects the terms that tyre.c neglects, and the moments. */
#include "../algebra/elementary.h"
#include "element.h"
#include "element_math.h"
#include "magic_formula.h"
#include "magic_tyre_fields.h"
#include "tyre_bore.h"
#include "tyre_contact.h"

enum { COEFFICIENTS = MAGIC_TYRE_REALS };
enum { SLIP, CAMBER, FORCE }; /* indices of the signs that convert ISO axes to axes of the file */
enum { OVERTURNING = ALI3_TYRE_OUTPUTS, RESISTANCE };

typedef struct {
  double F[2], C[3], Mx, My, Mz; /* ISO axes of the road; C = -dF/dv as xx, xy, yy */
  double stiffness[2]; /* of the carcass, N/m */
} reaction;

/* Scales F, its derivatives and the safe part of the secant down to the ellipse of the peaks, or to the ellipse through
 * the steady force if it is larger. */
static uint32_t limit_force(const double peak[2], const double steady[2], double F[2], double J[2][2], double safe[2]) {
  const double demand = ali3_hypot(F[0] / peak[0], F[1] / peak[1]),
               bound = fmax(ali3_hypot(steady[0] / peak[0], steady[1] / peak[1]), 1.0);
  if (!(demand > bound)) return 0u;
  const double factor = bound / demand;
  for (int j = 0; j < 2; j++) {
    double along = 0.0;
    for (int i = 0; i < 2; i++) along += F[i] / (peak[i] * peak[i]) * J[i][j] / (demand * demand);
    for (int i = 0; i < 2; i++) J[i][j] = factor * (J[i][j] - F[i] * along);
    safe[j] *= factor;
  }
  for (int i = 0; i < 2; i++) F[i] *= factor;
  return ALI3_TYRE_AT_LIMIT;
}

/* Steady forces F in ISO axes at a slip velocity with derivatives by the velocity; g: secant damping, N s/m, with
 * derivatives g_by. */
static ali3_magic_force find_steady_forces(ali3_element_args *a, const ali3_tyre_patch *contact,
                                           const ali3_tyre_motion *m, double w, double inclination, double g[2],
                                           double g_by[2][2], ali3_magic_state *state) {
  const double *p = a->real, max_load = p[LARGEST_LOAD],
               grip = contact->friction * p[FRICTION_FACTOR] / p[REFERENCE_FRICTION];
  const ali3_magic_state s = *state = (ali3_magic_state){
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
  if (s.load < contact->load) a->piece |= ALI3_TYRE_OVERLOADED;
  if (s.camber != p[SIGN + CAMBER] * inclination) a->piece |= ALI3_TYRE_AT_RANGE << 2;
  const double slip_sign[2] = {-1.0, p[SIGN + SLIP]}, force_sign[2] = {1.0, p[SIGN + FORCE]};
  double slip[2], inside[2], slip_slope[2];
  for (int i = 0; i < 2; i++) {
    const double raw = slip_sign[i] * m->v[i] / w;
    slip[i] = ali3_clamp(raw, p[(i ? ANGLE_RANGE : SLIP_RANGE)], p[(i ? ANGLE_RANGE : SLIP_RANGE) + 1]);
    if (slip[i] != raw) a->piece |= (uint32_t)ALI3_TYRE_AT_RANGE << i;
    inside[i] = slip[i] == raw ? 1.0 : slip[i] / raw; /* outside the range the force is constant */
    slip_slope[i] = slip[i] == raw ? slip_sign[i] / w : 0.0;
  }
  ali3_magic_force f;
  ali3_magic_forces(&s, slip[0], slip[1], &f);
  for (int i = 0; i < 2; i++) {
    g[i] = f.secant[i] * inside[i] / w;
    f.F[i] *= force_sign[i];
    for (int j = 0; j < 2; j++) {
      f.J[i][j] *= force_sign[i] * slip_slope[j];
      g_by[i][j] = f.secant_slope[i][j] * slip_slope[j] * inside[i] / w;
    }
    if (inside[i] < 1.0) g_by[i][i] -= g[i] / m->v[i];
  }
  return f;
}

/* One step of the carcass: forces, new states and damping matrix (symmetric part, not below the safe part of the
 * secant). */
static reaction step_carcass(ali3_element_args *a, const ali3_tyre_patch *contact, const ali3_tyre_motion *m,
                             double inclination, ali3_tyre_bore *bore) {
  const double *p = a->real, fast = m->travel[0] / ALI3_TYRE_ROLLS;
  const double sliding_at_rest = (1.0 - ali3_tyre_moving(fabs(m->travel[0]))) * ali3_hypot(m->v[0], m->v[1]);
  const double w = ali3_hypot(ali3_hypot(m->travel[0], ALI3_TYRE_SLOW), sliding_at_rest);
  const double grip = contact->friction * p[FRICTION_FACTOR] / p[REFERENCE_FRICTION];
  const bool grips = contact->load > ALI3_TYRE_NO_LOAD && grip > ALI3_TYRE_NO_GRIP;
  double g[2] = {0}, g_by[2][2] = {{0}}, J[2][2], safe[2], offset[2], D[2], d[2];
  ali3_magic_force f = {.peak = {1.0, 1.0}, .carcass = {p[STIFFNESS], p[STIFFNESS]}};
  ali3_magic_state s;
  if (grips) f = find_steady_forces(a, contact, m, w, inclination, g, g_by, &s);
  reaction r = {.stiffness = {f.carcass[0], f.carcass[1]}};
  for (int i = 0; i < 2; i++) {
    const double c = f.carcass[i];
    d[i] = c * p[SETTLING] / (1.0 + fast * fast);
    const double theta = ali3_theta(a->h, c / (d[i] + g[i])), b = a->h * theta;
    offset[i] = c * (a->y_old[i] + a->h * (1.0 - theta) * a->y_old[2 + i]);
    D[i] = d[i] + b * c;
    safe[i] = ALI3_SECANT_FRACTION * D[i] * (g[i] / (g[i] + D[i]));
    r.F[i] = D[i] / (g[i] + D[i]) * f.F[i] + g[i] / (g[i] + D[i]) * offset[i];
    const double by_g = D[i] / (g[i] + D[i]) * ((offset[i] - f.F[i]) / (g[i] + D[i]));
    for (int j = 0; j < 2; j++) J[i][j] = D[i] / (g[i] + D[i]) * f.J[i][j] + by_g * g_by[i][j];
  }
  if (grips) a->piece |= limit_force(f.peak, f.F, r.F, J, safe);
  if (bore) {
    const ali3_tyre_horizontal_force friction = {.slope = f.cornering * (1.0 - ali3_tyre_moving(fabs(m->travel[0]))),
                                                 .most = grips ? f.peak[1] : 0.0,
                                                 .transport = ali3_hypot(m->travel[0], ALI3_TYRE_SLOW),
                                                 .slip = ali3_hypot(m->v[0], m->v[1]),
                                                 .force = ali3_hypot(r.F[0], r.F[1]),
                                                 .steady = ali3_hypot(f.F[0], f.F[1]),
                                                 .use = fmin(ali3_hypot(r.F[0] / f.peak[0], r.F[1] / f.peak[1]), 1.0)};
    const double remaining = ali3_tyre_bore_step(a, bore, &friction);
    for (int i = 0; i < 2; i++) {
      r.F[i] *= remaining;
      safe[i] *= remaining;
      for (int j = 0; j < 2; j++) J[i][j] *= remaining;
    }
  }
  if (grips) {
    const double acting[2] = {r.F[0], p[SIGN + FORCE] * r.F[1]};
    f.F[1] *= p[SIGN + FORCE];
    ali3_magic_moments(&s, acting, &f);
    r.Mx = p[SIGN + CAMBER] * f.Mx, r.My = f.My, r.Mz = p[SIGN + FORCE] * f.Mz;
  }
  const ali3_tyre_carcass deflected = {.stiffness = {f.carcass[0], f.carcass[1]},
                                       .damping = {d[0], d[1]},
                                       .offset = {offset[0], offset[1]},
                                       .D = {D[0], D[1]}};
  ali3_tyre_deflect(a, &deflected, r.F);
  ali3_tyre_damping(J, safe, r.C);
  return r;
}

static void evaluate(ali3_element_args *a) {
  const double *p = a->real, *c = p + COEFFICIENTS, omega = a->ud[6];
  const double fast = fabs(omega) * p[RADIUS] / c[ALI3_MF_LONGVL];
  const double radius = p[RADIUS] * (c[ALI3_MF_Q_RE0] + c[ALI3_MF_Q_V1] * fast * fast);
  const double inflated = 1.0 + c[ALI3_MF_PFZ1] * p[PRESSURE], harder = (1.0 + c[ALI3_MF_Q_V2] * fast) * inflated;
  const ali3_tyre_spring spring = {radius,     p[BOTTOMING_RADIUS],   harder * p[STIFFNESS], harder * p[PROGRESSION],
                                   p[DAMPING], p[BOTTOMING_STIFFNESS]};
  double e[3], twist[3];
  a->potential = 0.0;
  ali3_tyre_axis(a->u + 3, e);
  const ali3_tyre_patch contact = ali3_tyre_radial(a, e, &spring);
  ali3_tyre_motion m = ali3_tyre_axes(&contact, e);
  const double *n = contact.normal, deflection = m.loaded < radius ? radius - m.loaded : 0.0;
  const ali3_magic_state formula = {.c = c, .nominal_load = p[NOMINAL_LOAD]};
  const double nominal_stiffness =
                   inflated * sqrt(p[STIFFNESS] * p[STIFFNESS] + 4.0 * p[PROGRESSION] * p[NOMINAL_LOAD]),
               stiffness = spring.stiffness + spring.progression * deflection;
  const double effective =
      ali3_magic_rolling_radius(&formula, radius, nominal_stiffness, deflection, stiffness / nominal_stiffness);
  const double ratio =
      m.loaded > 1e-6 ? 1.0 + ali3_tyre_moving(effective * fabs(omega)) * (effective / m.loaded - 1.0) : 1.0;
  ali3_tyre_velocities(a, &contact, e, ratio, &m);
  const double inclination = ali3_atan2(ali3_dot(e, n), m.upright);
  const bool has_bore = a->nint > WITH_BORE;
  ali3_tyre_bore bore;
  if (has_bore) bore = ali3_tyre_bore_at(a, p + BORE, n, e, 2.0 * sqrt(radius * deflection));
  reaction r = step_carcass(a, &contact, &m, inclination, has_bore ? &bore : 0);
  if (has_bore) {
    r.Mz += bore.moment;
    a->potential += 0.5 * p[BORE + ALI3_BORE_STIFFNESS] * a->y_new[ALI3_BORE_STATES] * a->y_new[ALI3_BORE_STATES];
  }
  for (int i = 0; i < 2; i++) a->potential += 0.5 * r.stiffness[i] * a->y_new[i] * a->y_new[i];
  for (int k = 0; k < 7; k++) a->f[k] += r.F[0] * m.row[0][k] + r.F[1] * m.row[1][k];

  const double roll = ali3_tanh(omega);
  double moment[3];
  for (int i = 0; i < 3; i++) moment[i] = r.Mz * n[i] + r.Mx * m.forward[i];
  ali3_cross(moment, e, twist);
  for (int i = 0; i < 3; i++) a->f[3 + i] += twist[i];
  a->f[6] += ali3_dot(moment, e) - r.My * roll;

  if (a->S) {
    ali3_add_outer(a->S, 7, a->wC * r.C[0], m.row[0]);
    ali3_add_symmetric(a->S, 7, 2.0 * a->wC * r.C[1], m.row[0], m.row[1]);
    ali3_add_outer(a->S, 7, a->wC * r.C[2], m.row[1]);
    if (has_bore) ali3_add_outer(a->S, 7, a->wC * bore.C, bore.row);
    a->S[6 * 7 + 6] += a->wC * r.My * (1.0 - roll * roll);
  }
  ali3_tyre_outputs(a, &contact, e, &m, radius, ratio, r.F, r.Mz, -r.My * roll);
  a->out[OVERTURNING] = r.Mx;
  a->out[RESISTANCE] = -r.My * roll;
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
