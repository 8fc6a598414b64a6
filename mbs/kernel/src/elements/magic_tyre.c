/* Tyre on a road by the Magic Formula: radial spring of a disc, steady forces of magic_formula.h, first-order carcass
 * deflections that are the same at standstill, rolling, sliding and in the air.
 *
 * Signals and states are those of tyre.c. Pressure is that over the nominal one, less 1; of the slip angle its tangent
 * has a range; behind the numbers stand the coefficients. The moment of bore torque fades out up to ALI3_TYRE_ROLLS, from
 * where the formula has the moments about the normal.
 *
 * Slips refer to the speed of travel; below ALI3_TYRE_ROLLS to that of the slip too, so that the force of a wheel that
 * slides sideways from rest has the direction of its slip. The carcass, per direction, follows F = F_steady(v) - g x' = c x + d x' with the
 * secant slip damping g without shifts; tyre.c has F_steady = -g v. Its relaxation length is g w/c. c depends on the
 * load as the file says; d is that of a standing tyre and goes with the square of the speed, so that it does not
 * lengthen the relaxation. Shifts, camber thrust and moments about the normal and the heading grow with the speed of
 * travel up to ALI3_TYRE_ROLLS: a standing tyre is a spring.
 * The lever of F about the axle is the effective radius, as in tyre.c.
 *
 * The tangent leaves out what tyre.c leaves out, and the moments. */
#include "../algebra/elementary.h"
#include "element.h"
#include "element_math.h"
#include "magic_formula.h"
#include "magic_tyre_fields.h"
#include "tyre_bore.h"
#include "tyre_contact.h"

enum { COEFFICIENTS = MAGIC_TYRE_REALS };
enum { SLIP, CAMBER, FORCE }; /* parts of the sign: from ISO axes to those of the file */
enum { OVERTURNING = ALI3_TYRE_OUTPUTS, RESISTANCE };

typedef struct {
  double F[2], C[3], Mx, My, Mz; /* ISO axes of the road; C = -dF/dv as xx, xy, yy */
  double stiffness[2]; /* of the carcass */
} reaction;

/* Scales F, its derivative and the safe share down to the larger of the peaks' ellipse and the steady force. */
static uint32_t limit(const double peak[2], const double steady[2], double F[2], double J[2][2], double safe[2]) {
  const double use = ali3_hypot(F[0] / peak[0], F[1] / peak[1]),
               held = fmax(ali3_hypot(steady[0] / peak[0], steady[1] / peak[1]), 1.0);
  if (!(use > held)) return 0u;
  const double part = held / use;
  for (int j = 0; j < 2; j++) {
    double along = 0.0;
    for (int i = 0; i < 2; i++) along += F[i] / (peak[i] * peak[i]) * J[i][j] / (use * use);
    for (int i = 0; i < 2; i++) J[i][j] = part * (J[i][j] - F[i] * along);
    safe[j] *= part;
  }
  for (int i = 0; i < 2; i++) F[i] *= part;
  return ALI3_TYRE_AT_LIMIT;
}

/* Steady forces at a slip velocity in ISO axes: F, derivatives by the velocities, secant damping g and its derivatives. */
static ali3_magic_force steady(ali3_element_args *a, const ali3_tyre_patch *contact, const ali3_tyre_motion *m,
                               double w, double lean, double g[2], double g_by[2][2], ali3_magic_state *state) {
  const double *p = a->real, most = p[LARGEST_LOAD],
               grip = contact->friction * p[FRICTION_FACTOR] / p[REFERENCE_FRICTION];
  const ali3_magic_state s = *state = (ali3_magic_state){
      .c = p + COEFFICIENTS,
      .version = a->integer[VERSION],
      .combined = a->integer[COMBINATION],
      .nominal_load = p[NOMINAL_LOAD],
      .radius = p[RADIUS],
      .load = contact->load < most ? contact->load : most,
      .camber = p[SIGN + CAMBER] * ali3_clamp(lean, p[CAMBER_RANGE], p[CAMBER_RANGE + 1]),
      .pressure = p[PRESSURE],
      .friction = {grip * p[LMUX], grip * p[LMUY]},
      .stiffness = {p[LKX], p[LKY]},
      .moving = ali3_tyre_moving(fabs(m->travel[0])),
      .direction = m->travel[0] < 0.0 ? -1.0 : 1.0,
      .speed = fabs(m->travel[0]),
      .slide = ali3_hypot(m->v[0], m->v[1]),
  };
  if (s.load < contact->load) a->piece |= ALI3_TYRE_OVERLOADED;
  if (s.camber != p[SIGN + CAMBER] * lean) a->piece |= ALI3_TYRE_AT_RANGE << 2;
  const double ways[2] = {-1.0, p[SIGN + SLIP]}, turn[2] = {1.0, p[SIGN + FORCE]};
  double slip[2], kept[2], by[2];
  for (int i = 0; i < 2; i++) {
    const double raw = ways[i] * m->v[i] / w;
    slip[i] = ali3_clamp(raw, p[(i ? ANGLE_RANGE : SLIP_RANGE)], p[(i ? ANGLE_RANGE : SLIP_RANGE) + 1]);
    if (slip[i] != raw) a->piece |= (uint32_t)ALI3_TYRE_AT_RANGE << i;
    kept[i] = slip[i] == raw ? 1.0 : slip[i] / raw; /* beyond the range the force stays */
    by[i] = slip[i] == raw ? ways[i] / w : 0.0;
  }
  ali3_magic_force f;
  ali3_magic_forces(&s, slip[0], slip[1], &f);
  for (int i = 0; i < 2; i++) {
    g[i] = f.secant[i] * kept[i] / w;
    f.F[i] *= turn[i];
    for (int j = 0; j < 2; j++) {
      f.J[i][j] *= turn[i] * by[j];
      g_by[i][j] = f.secant_slope[i][j] * by[j] * kept[i] / w;
    }
    if (kept[i] < 1.0) g_by[i][i] -= g[i] / m->v[i];
  }
  return f;
}

/* One step of the carcass: forces, new slots, damping matrix (symmetric part, not below the safe share of the secant). */
static reaction carcass(ali3_element_args *a, const ali3_tyre_patch *contact, const ali3_tyre_motion *m, double lean,
                        ali3_tyre_bore *bore) {
  const double *p = a->real, fast = m->travel[0] / ALI3_TYRE_ROLLS;
  const double stands = (1.0 - ali3_tyre_moving(fabs(m->travel[0]))) * ali3_hypot(m->v[0], m->v[1]);
  const double w = ali3_hypot(ali3_hypot(m->travel[0], ALI3_TYRE_SLOW), stands);
  const double grip = contact->friction * p[FRICTION_FACTOR] / p[REFERENCE_FRICTION];
  const bool holds = contact->load > ALI3_TYRE_NO_LOAD && grip > ALI3_TYRE_NO_GRIP;
  double g[2] = {0}, g_by[2][2] = {{0}}, J[2][2], safe[2], offset[2], D[2], d[2];
  ali3_magic_force f = {.peak = {1.0, 1.0}, .carcass = {p[STIFFNESS], p[STIFFNESS]}};
  ali3_magic_state s;
  if (holds) f = steady(a, contact, m, w, lean, g, g_by, &s);
  reaction r = {.stiffness = {f.carcass[0], f.carcass[1]}};
  for (int i = 0; i < 2; i++) {
    const double c = f.carcass[i];
    d[i] = c * p[SETTLING] / (1.0 + fast * fast);
    const double theta = ali3_theta(a->h, c / (d[i] + g[i])), b = a->h * theta;
    offset[i] = c * (a->y_old[i] + a->h * (1.0 - theta) * a->y_old[2 + i]);
    D[i] = d[i] + b * c;
    safe[i] = ALI3_SECANT_SHARE * D[i] * (g[i] / (g[i] + D[i]));
    r.F[i] = D[i] / (g[i] + D[i]) * f.F[i] + g[i] / (g[i] + D[i]) * offset[i];
    const double by_g = D[i] / (g[i] + D[i]) * ((offset[i] - f.F[i]) / (g[i] + D[i]));
    for (int j = 0; j < 2; j++) J[i][j] = D[i] / (g[i] + D[i]) * f.J[i][j] + by_g * g_by[i][j];
  }
  if (holds) { a->piece |= limit(f.peak, f.F, r.F, J, safe); }
  if (bore) {
    const ali3_tyre_held by = {.slope = f.cornering * (1.0 - ali3_tyre_moving(fabs(m->travel[0]))),
                               .most = holds ? f.peak[1] : 0.0,
                               .transport = ali3_hypot(m->travel[0], ALI3_TYRE_SLOW),
                               .slip = ali3_hypot(m->v[0], m->v[1]),
                               .force = ali3_hypot(r.F[0], r.F[1]),
                               .steady = ali3_hypot(f.F[0], f.F[1]),
                               .use = fmin(ali3_hypot(r.F[0] / f.peak[0], r.F[1] / f.peak[1]), 1.0)};
    const double left = ali3_tyre_bore_step(a, bore, &by);
    for (int i = 0; i < 2; i++) {
      r.F[i] *= left;
      safe[i] *= left;
      for (int j = 0; j < 2; j++) J[i][j] *= left;
    }
  }
  if (holds) {
    const double acting[2] = {r.F[0], p[SIGN + FORCE] * r.F[1]};
    f.F[1] *= p[SIGN + FORCE];
    ali3_magic_moments(&s, acting, &f);
    r.Mx = p[SIGN + CAMBER] * f.Mx, r.My = f.My, r.Mz = p[SIGN + FORCE] * f.Mz;
  }
  for (int i = 0; i < 2; i++) {
    a->y_new[i] = a->y_old[i];
    a->y_new[2 + i] = (r.F[i] - offset[i]) / D[i];
    if (!(a->h > 0.0)) continue;
    a->y_new[i] = (r.F[i] - d[i] * a->y_new[2 + i]) / f.carcass[i];
    if (fabs(a->y_new[i]) < 1e-100) a->y_new[i] = a->y_new[2 + i] = 0.0; /* long in the air: no denormals */
  }
  r.C[0] = -J[0][0] - safe[0], r.C[1] = -0.5 * (J[0][1] + J[1][0]), r.C[2] = -J[1][1] - safe[1];
  ali3_tyre_semidefinite(r.C);
  r.C[0] += safe[0];
  r.C[2] += safe[1];
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
  const ali3_magic_state size = {.c = c, .nominal_load = p[NOMINAL_LOAD]};
  const double nominal = inflated * sqrt(p[STIFFNESS] * p[STIFFNESS] + 4.0 * p[PROGRESSION] * p[NOMINAL_LOAD]),
               per_depth = spring.stiffness + spring.progression * deflection;
  const double effective = ali3_magic_rolling_radius(&size, radius, nominal, deflection, per_depth / nominal);
  const double ratio =
      m.loaded > 1e-6 ? 1.0 + ali3_tyre_moving(effective * fabs(omega)) * (effective / m.loaded - 1.0) : 1.0;
  ali3_tyre_velocities(a, &contact, e, ratio, &m);
  const double lean = ali3_atan2(ali3_dot(e, n), m.upright);
  const bool bores = a->nint > WITH_BORE;
  ali3_tyre_bore bore;
  if (bores) bore = ali3_tyre_bore_at(a, p + BORE, n, e, 2.0 * sqrt(radius * deflection));
  reaction r = carcass(a, &contact, &m, lean, bores ? &bore : 0);
  if (bores) {
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
    if (bores) ali3_add_outer(a->S, 7, a->wC * bore.C, bore.row);
    a->S[48] += a->wC * r.My * (1.0 - roll * roll);
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
    ALI3_MAGIC_TYRE,          .evaluate = evaluate, .start = ali3_tyre_start, .start_words = ALI3_TYRE_START_WORDS,
    .depth = ali3_tyre_depth, .check = check,
};
