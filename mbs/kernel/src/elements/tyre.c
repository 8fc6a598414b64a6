/* Tyre on a road: radial spring of a disc, TMeasy steady forces, first-order carcass deflections that are the same at
 * standstill, rolling, sliding and in the air.
 *
 * The spin chi has chi' = Omega, the absolute rate about the axis (> 0 rolling forward).
 * States: carcass deflections x, y and their rates, then those of tyre_bore.h. Of two contacts outputs are the means by
 * load; in the air the contact is the point of the road that is nearest within the wheel plane, with its normal.
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
 * Camber acts as a lateral slip: v_s = v_y + camber_slip sin(gamma) r |Omega|, nothing at rest. That part of the force
 * has no trail. F acts on Omega by the same factor, so that camber thrust takes its work from the spin.
 *
 * The tangent leaves out the coupling of load and horizontal force and the turning of the frames. */
#include "../algebra/elementary.h"
#include "element.h"
#include "element_math.h"
#include "tmeasy.h"
#include "tyre_bore.h"
#include "tyre_contact.h"
#include "tyre_fields.h"

/* Radial return of F to the largest force of its direction, in TMeasy hypot(Fxm cos, Fym sin); adapts J and the safe
 * part of the secant. */
static void limit_force(ali3_element_args *a, truth loaded, const real max_force[2], real F[2], real J[2][2],
                        real safe[2]) {
  const real weight[2] = {max_force[0] * max_force[0], max_force[1] * max_force[1]};
  const real size2 = F[0] * F[0] + F[1] * F[1], bound = ali3_hypot(max_force[0] * F[0], max_force[1] * F[1]);
  const truth exceeds = loaded & (bound > 0.0) & (size2 > bound);
  ALI3_PIECE(&a->piece, exceeds, ALI3_TYRE_AT_LIMIT);
  if (!ali3_any(exceeds)) return;
  const real scale = size2 / bound;
  real e[2]; /* gradient of `scale` by F */
  for (int i = 0; i < 2; i++) e[i] = (2.0 - scale * weight[i] / bound) * (F[i] / bound);
  for (int j = 0; j < 2; j++) {
    const real along = (e[0] * J[0][j] + e[1] * J[1][j]) / scale;
    for (int i = 0; i < 2; i++) J[i][j] = ali3_where(exceeds, (J[i][j] - F[i] * along) / scale, J[i][j]);
    safe[j] = ali3_where(exceeds, safe[j] / scale, safe[j]);
  }
  for (int i = 0; i < 2; i++) F[i] = ali3_where(exceeds, F[i] / scale, F[i]);
}

/* Load relative to the nominal load, limited. */
static real find_load_factor(const real *p, const ali3_tyre_patch *contact) {
  return ali3_clamp(contact->load / p[TYRE_NOMINAL_LOAD], ali3_same(0.0), p[TYRE_MAX_LOAD_FACTOR]);
}

/* Friction of the road relative to the friction of the measured tyre. */
static real find_friction_ratio(const real *p, const ali3_tyre_patch *contact) {
  return contact->friction * p[TYRE_FRICTION_FACTOR] / p[TYRE_REFERENCE_FRICTION];
}

/* One step of the carcass with slip velocity v and transport speed w, m/s: force F, new states, and damping matrix C =
 * -dF/dv (symmetric part, not below the safe part of the secant) as xx, xy, yy. */
static void step_carcass(ali3_element_args *a, const ali3_tyre_patch *contact, const real v[2], real w, real F[2],
                         real C[3], real g[2], ali3_tyre_bore *bore) {
  const real *p = a->real, *c = p + TYRE_CARCASS_STIFFNESS, *d = p + TYRE_CARCASS_DAMPING,
             q = find_load_factor(p, contact);
  const real grip = find_friction_ratio(p, contact);
  const ali3_tmeasy_pair t = ali3_tmeasy_pair_at(p + TYRE_LONGITUDINAL, p + TYRE_LATERAL, q, grip);
  const real n[2] = {v[0] / (t.scale[0] * w), v[1] / (t.scale[1] * w)};
  real gradient[2], J[2][2], safe[2], offset[2], D[2], max_force[2];
  /* without this limit the initial slope would transmit a force at rest at almost no grip */
  const truth grips = grip > ALI3_TYRE_NO_GRIP;
  const real none = {0}, secant = ali3_where(grips, ali3_tmeasy_secant(&t, n, gradient), none);
  for (int i = 0; i < 2; i++) gradient[i] = ali3_where(grips, gradient[i], none);
  for (int i = 0; i < 2; i++) {
    const real per_slip = q / (t.scale[i] * w);
    g[i] = per_slip * secant;
    const real theta = ali3_theta(a->h, c[i] / (d[i] + g[i])), b = a->h * theta;
    offset[i] = c[i] * (a->y_old[i] + a->h * (1.0 - theta) * a->y_old[2 + i]);
    D[i] = d[i] + b * c[i];
    max_force[i] = q * t.max_force[i];
    safe[i] = ALI3_SECANT_FRACTION * D[i] * (g[i] / (g[i] + D[i]));
    F[i] = g[i] / (g[i] + D[i]) * (offset[i] - D[i] * v[i]);
    const real by_g = D[i] / (g[i] + D[i]) * ((offset[i] - D[i] * v[i]) / (g[i] + D[i]));
    for (int j = 0; j < 2; j++)
      J[i][j] = by_g * per_slip * (gradient[j] / (t.scale[j] * w)) - (i == j ? g[i] / (g[i] + D[i]) * D[i] : none);
  }
  const truth loaded = contact->load > ALI3_TYRE_NO_LOAD;
  limit_force(a, loaded, max_force, F, J, safe);
  if (bore) {
    const real size2 = F[0] * F[0] + F[1] * F[1], bound = ali3_hypot(max_force[0] * F[0], max_force[1] * F[1]);
    const ali3_tyre_horizontal_force by = {.slope = q * ali3_tmeasy_at(p + TYRE_LATERAL, q, grip).slope,
                                           .most = ali3_where(loaded & grips, max_force[1], none),
                                           .transport = w,
                                           .slip = ali3_hypot(v[0], v[1]),
                                           .force = ali3_sqrt(size2),
                                           .steady = ali3_hypot(g[0] * v[0], g[1] * v[1]),
                                           .use = ali3_where(loaded & (bound > 0.0), size2 / bound, none)};
    const real remaining = ali3_tyre_bore_step(a, bore, &by);
    for (int i = 0; i < 2; i++) {
      F[i] *= remaining;
      safe[i] *= remaining;
      for (int j = 0; j < 2; j++) J[i][j] *= remaining;
    }
  }
  ALI3_PIECE(&a->piece, loaded & (contact->load > p[TYRE_MAX_LOAD_FACTOR] * p[TYRE_NOMINAL_LOAD]),
             ALI3_TYRE_OVERLOADED);
  const ali3_tyre_carcass deflected = {
      .stiffness = {c[0], c[1]}, .damping = {d[0], d[1]}, .offset = {offset[0], offset[1]}, .D = {D[0], D[1]}};
  ali3_tyre_deflect(a, &deflected, F);
  ali3_tyre_damping(J, safe, C);
}

/* Trail divided by contact length at the lateral slip s, behind the middle of the patch in the direction of rolling:
 * the tread deflects from its leading edge, which in reverse is the other edge. */
static real find_relative_trail(const real *p, const ali3_tyre_patch *contact, real s, real omega) {
  const real trail =
      ali3_tmeasy_trail(p + TYRE_TRAIL, find_load_factor(p, contact), find_friction_ratio(p, contact), s);
  return ali3_where(omega < 0.0, -trail, trail);
}

static void evaluate(ali3_element_args *a) {
  const real *p = a->real, omega = a->ud[6];
  const real none = {0};
  const ali3_tyre_spring spring = {p[TYRE_RADIUS], p[TYRE_BOTTOMING_RADIUS], p[TYRE_STIFFNESS],
                                   none,           p[TYRE_DAMPING],          p[TYRE_BOTTOMING_STIFFNESS]};
  real e[3], F[2], C[3], g[2];
  a->potential = none;
  ali3_tyre_axis(a->u + 3, e);
  const ali3_tyre_patch contact = ali3_tyre_radial(a, e, &spring);
  ali3_tyre_motion m = ali3_tyre_axes(&contact, e);
  const real *n = contact.normal, loaded = m.loaded;

  const truth deflected = loaded < p[TYRE_RADIUS];
  const real rolling = (2.0 * p[TYRE_RADIUS] + ali3_where(deflected, loaded, p[TYRE_RADIUS])) / 3.0,
             transport = rolling * ali3_abs(omega), w = transport + ALI3_TYRE_SLOW;
  const real moving = ali3_tyre_moving(transport);
  const real ratio = ali3_where(loaded > 1e-6, 1.0 + moving * (rolling / loaded - 1.0),
                                ali3_same(1.0)); /* slip radius over loaded radius */
  ali3_tyre_velocities(a, &contact, e, ratio, &m);
  const real deflection = ali3_where(deflected, p[TYRE_RADIUS] - loaded, none),
             length = 2.0 * ali3_sqrt(p[TYRE_RADIUS] * deflection);
  const bool has_camber_slip = ali3_any(p[TYRE_CAMBER_SLIP] != 0.0), has_bore = a->nint > TYRE_WITH_BORE;
  ali3_tyre_bore bore;
  real v[2] = {m.v[0], m.v[1]}, camber_velocity = none, by_spin = none;
  if (has_camber_slip) {
    const real per_spin = p[TYRE_CAMBER_SLIP] * ali3_dot(e, n) * rolling;
    by_spin = ali3_where(omega < 0.0, -per_spin, per_spin);
    camber_velocity = by_spin * omega;
    v[1] += camber_velocity;
    m.row[1][6] += by_spin;
  }
  if (has_bore) bore = ali3_tyre_bore_at(a, p + TYRE_BORE, n, e, length);
  step_carcass(a, &contact, v, w, F, C, g, has_bore ? &bore : 0);
  a->potential += 0.5 * (p[TYRE_CARCASS_STIFFNESS] * a->y_new[0] * a->y_new[0] +
                         p[TYRE_CARCASS_STIFFNESS + 1] * a->y_new[1] * a->y_new[1]);
  if (has_bore)
    a->potential += 0.5 * p[TYRE_BORE + ALI3_BORE_STIFFNESS] * a->y_new[ALI3_BORE_STATES] * a->y_new[ALI3_BORE_STATES];
  for (int k = 0; k < 7; k++) a->f[k] += F[0] * m.row[0][k] + F[1] * m.row[1][k];

  const real trail_force = has_camber_slip ? F[1] + g[1] * camber_velocity : F[1];
  real moment = -moving * length * find_relative_trail(p, &contact, ali3_abs(m.v[1]) / w, omega) * trail_force;
  if (has_bore) moment += bore.moment;
  const real resist = p[TYRE_ROLLING_RESISTANCE] * contact.load * p[TYRE_RADIUS], roll = ali3_tanh(omega);
  real twist[3];
  ali3_cross(n, e, twist);
  for (int i = 0; i < 3; i++) a->f[3 + i] += moment * twist[i];
  a->f[6] += moment * ali3_dot(n, e) - resist * roll;

  if (a->S) {
    ali3_add_outer(a->S, 7, a->wC * C[0], m.row[0]);
    ali3_add_symmetric(a->S, 7, 2.0 * a->wC * C[1], m.row[0], m.row[1]);
    ali3_add_outer(a->S, 7, a->wC * C[2], m.row[1]);
    if (has_bore) ali3_add_outer(a->S, 7, a->wC * bore.C, bore.row);
    a->S[6 * 7 + 6] += a->wC * resist * (1.0 - roll * roll);
  }
  ali3_tyre_outputs(a, &contact, e, &m, p[TYRE_RADIUS], ratio, F, moment,
                    has_camber_slip ? F[1] * by_spin - resist * roll : -resist * roll);
}

#ifndef ALI3_WIDTH
static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint) {
  (void)nsig, (void)nreal, (void)integer, (void)nint;
  if (!(real[TYRE_RADIUS] > real[TYRE_BOTTOMING_RADIUS]))
    return "the bottoming radius of a tyre must be less than its radius";
  /* at both ends of the load range; between them the curves are linear in the load */
  for (int end = 0; end < 2; end++) {
    const double q = end ? real[TYRE_MAX_LOAD_FACTOR] : 0.0;
    for (int direction = 0; direction < 2; direction++) {
      const ali3_tmeasy t = ali3_tmeasy_at(real + (direction ? TYRE_LATERAL : TYRE_LONGITUDINAL), q, 1.0);
      if (!(t.slope > 0.0 && t.max_force > 0.0 && t.slide_force > 0.0))
        return "a tyre force becomes zero or negative within its range of loads";
      if (!(t.max_slip > 0.0 && t.slide_slip > t.max_slip))
        return "the slips of a tyre must be positive and sliding must come after the maximum";
    }
    const double *z = real + TYRE_TRAIL_ZERO;
    const double zero = z[0] + (z[1] - z[0]) * (q - 1.0), end = z[2] + (z[3] - z[2]) * (q - 1.0);
    if (!(zero > 0.0 && end > zero)) return "the slips of a tyre's trail must be positive and increasing";
  }
  return 0;
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
