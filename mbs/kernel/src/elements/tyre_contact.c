/* Contact of a tyre of any formula: radial spring, axes and velocities of the patch, outputs, depth at a start.
 *
 * At a depth d in the road the wheel has the force (k + p d) d + kb max(d - db, 0) + c d' min(d/TOUCH_DEPTH, 1) against
 * the gradient of d, where this is positive: stiffness k, progression p, rim kb beyond the depth db, damping c. */
#include "tyre_contact.h"

#include "../algebra/elementary.h"
#include "element_math.h"
#include "road.h"
#include "tyre_fields.h"

#define TOUCH_DEPTH 0.005 /* m: deflection over which the radial damping increases to its full value */
#define CLEAR 1e-6 /* m: largest depth at a start that is ignored */
#define MIN_SLIP_SPEED 0.01 /* m/s: speed below which the slips that are reported tend to 0 */
#define RIM_HOLDS 0.8 /* of the bottoming radius: least distance of the wheel's centre from a face */

void ali3_tyre_axis(const real axis[3], real e[3]) {
  const real size = ali3_norm(axis);
  for (int i = 0; i < 3; i++) e[i] = ali3_where(size > 1e-6, axis[i] / size, ali3_same(i == 1));
}

/* Load-weighted mean of `mean` (load `old`) and `new` (load `load`); total: sum of the loads; first: there is no old
 * load. */
static real update_mean(lane_mask first, real mean, real old, real new, real total, real load) {
  return ali3_where(first, ali3_same(0.0), old / total * mean) + load / total * new;
}

/* Radial law of a tyre at one contact. */
typedef struct {
  real depth, effective_depth; /* m; that of a degressive spring ends where its force is largest */
  real bottoming_depth, bottoming; /* m beyond the bottoming radius; N/m, 0 above it */
  real ramp, share; /* 0 to 1: of the damping; of the load, borne by this contact */
  real spring, force; /* N: of the spring alone; against the gradient of the depth */
  lane_mask softened; /* the spring is beyond its largest force */
} radial_law;

/* The law of a contact whose depth changes at `rate`, m/s. */
static radial_law evaluate_radial_law(const ali3_tyre_spring *s, const ali3_contact *c, real rate) {
  radial_law r = {.depth = c->penetration};
  r.bottoming_depth = r.depth - (s->radius - s->bottoming_radius);
  r.bottoming = ali3_where(r.bottoming_depth > 0.0, s->bottoming_stiffness, ali3_same(0.0));
  r.ramp = ali3_where(r.depth < TOUCH_DEPTH, r.depth / TOUCH_DEPTH, ali3_same(1.0));
  r.share = 1.0 - c->yielded;
  r.softened = s->stiffness + 2.0 * s->progression * r.depth < 0.0;
  r.effective_depth = ali3_where(r.softened, -0.5 * s->stiffness / s->progression, r.depth);
  r.spring = (s->stiffness + s->progression * r.effective_depth) * r.effective_depth;
  r.force = r.share * (r.spring + r.bottoming * r.bottoming_depth + s->damping * rate * r.ramp);
  return r;
}

/* Adds the energy of the spring and of the rim where the tyre touches. */
static void add_radial_energy(ali3_element_args *a, const ali3_tyre_spring *s, const radial_law *r, lane_mask touches) {
  a->potential = ali3_add_unless(ali3_not(touches), a->potential,
                                 r->share * (0.5 * ((s->stiffness + s->progression * (2.0 / 3.0) * r->effective_depth) *
                                                        r->effective_depth * r->effective_depth +
                                                    r->bottoming * r->bottoming_depth * r->bottoming_depth)));
  a->potential = ali3_add_unless(ali3_not(touches & r->softened), a->potential,
                                 r->share * r->spring * (r->depth - r->effective_depth));
}

/* Derivative of the force by the depth, not below 0. */
static real find_radial_stiffness(const ali3_tyre_spring *s, const radial_law *r, real rate) {
  const real none = {0};
  const real slope = ali3_where(r->softened, none, s->stiffness + 2.0 * s->progression * r->depth) + r->bottoming +
                     ali3_where(r->ramp < 1.0, s->damping * rate / TOUCH_DEPTH, none);
  return ali3_where(slope < 0.0, none, slope);
}

/* Includes a contact with a load in the mean patch where it presses: load-weighted, so that the mean is continuous when
 * a contact opens or closes. */
static void add_to_patch(ali3_tyre_patch *mean, const ali3_contact *c, const real rho[3], real load,
                         lane_mask presses) {
  const lane_mask first = ali3_not(mean->load > 0.0);
  const real total = mean->load + load;
  for (int i = 0; i < 3; i++) {
    const real weighted = load * c->normal[i], sum = ali3_where(first, weighted, mean->normal[i] + weighted);
    mean->normal[i] = ali3_where(presses, sum, mean->normal[i]);
    mean->rho[i] = ali3_where(presses, update_mean(first, mean->rho[i], mean->load, rho[i], total, load), mean->rho[i]);
  }
  mean->friction =
      ali3_where(presses, update_mean(first, mean->friction, mean->load, c->friction, total, load), mean->friction);
  mean->load = ali3_where(presses, total, mean->load);
}

/* The patch of one contact and minus the gradient of its depth by the signals of the tyre. */
typedef struct {
  real rho[3], b[7]; /* m; m per unit of a signal */
  lane_mask hub_reached; /* the road is nearer to the wheel's centre than the patch may be */
} contact_place;

static contact_place find_place(const ali3_contact *c, const real e[3], real radius) {
  const real hub = ALI3_TYRE_HUB * radius, loaded = radius - c->penetration, lean = ali3_dot(e, c->normal);
  contact_place at = {.hub_reached = loaded < hub};
  for (int i = 0; i < 3; i++) {
    at.rho[i] = loaded * c->down[i];
    at.b[i] = c->normal[i] / c->cosine;
    at.b[3 + i] = -lean * at.rho[i] / c->cosine * c->leaning;
    at.rho[i] = ali3_where(at.hub_reached, hub * c->down[i], at.rho[i]);
  }
  return at;
}

/* Makes a contact the nearest one of the patch if it is deeper than *deepest, m. */
static void update_nearest(ali3_tyre_patch *mean, const ali3_contact *c, const contact_place *at, real *deepest) {
  const real depth = c->penetration;
  const lane_mask deeper = depth > *deepest;
  *deepest = ali3_where(deeper, depth, *deepest);
  mean->beyond = ali3_where(at->hub_reached & (depth > mean->beyond), depth, mean->beyond);
  for (int i = 0; i < 3; i++) {
    mean->near_normal[i] = ali3_where(deeper, c->normal[i], mean->near_normal[i]);
    mean->near_rho[i] = ali3_where(deeper, at->rho[i], mean->near_rho[i]);
  }
}

/* Adds the bits of the smooth piece of the law at contact k. */
static void add_pieces(ali3_element_args *a, int k, const radial_law *law, lane_mask touches, lane_mask presses) {
  const int32_t shift = ALI3_TYRE_CONTACT_BITS * k;
  ALI3_PIECE(&a->piece, touches, ALI3_TYRE_TOUCHES << shift);
  ALI3_PIECE(&a->piece, touches & (law->bottoming_depth > 0.0), ALI3_TYRE_BOTTOMS << shift);
  ALI3_PIECE(&a->piece, touches & ali3_not(law->ramp < 1.0), ALI3_TYRE_FULLY << shift);
  ALI3_PIECE(&a->piece, presses, ALI3_TYRE_PRESSES << shift);
}

ali3_tyre_patch ali3_tyre_radial(ali3_element_args *a, const real e[3], const ali3_tyre_spring *spring) {
  ali3_contact contact[2];
  const real none = {0};
  ali3_tyre_patch mean = {.load = none, .beyond = none};
  real deepest = ali3_same(-INFINITY), difference[7] = {0}, switching = none; /* of the gradients of both contacts */
  const int count = ali3_road_contacts(&a->roads[a->integer[0]], a->u, e, spring->radius, contact);
  for (int k = 0; k < count; k++) {
    const ali3_contact *c = &contact[k];
    contact_place at = find_place(c, e, spring->radius);
    update_nearest(&mean, c, &at, &deepest);
    if (k == 0) { /* reference of the slips of a wheel in the air */
      mean.friction = c->friction;
      for (int i = 0; i < 3; i++) mean.normal[i] = c->normal[i], mean.rho[i] = at.rho[i];
    }
    const lane_mask touches = c->penetration > 0.0;
    if (!ali3_any(touches)) continue;
    real rate = none;
    for (int i = 0; i < 6; i++) rate -= at.b[i] * a->ud[i];
    const radial_law law = evaluate_radial_law(spring, c, rate);
    add_radial_energy(a, spring, &law, touches);
    const lane_mask presses = touches & (law.force > 0.0);
    add_pieces(a, k, &law, touches, presses);
    if (!ali3_any(presses)) continue;
    for (int i = 0; i < 6; i++) a->f[i] = ali3_add_unless(ali3_not(presses), a->f[i], law.force * at.b[i]);
    add_to_patch(&mean, c, at.rho, law.force / c->cosine, presses);
    if (!a->S) continue;
    for (int i = 0; i < 7; i++) { /* 0 in lanes without contact force */
      at.b[i] = ali3_where(presses, at.b[i], none);
      difference[i] += k ? -at.b[i] : at.b[i];
    }
    const real tangent = a->wK * find_radial_stiffness(spring, &law, rate) + a->wC * spring->damping * law.ramp;
    ali3_add_outer(a->S, 7, ali3_where(presses, law.share * tangent, none), at.b);
    switching =
        ali3_where(presses, a->wK * c->switching * (law.spring + law.bottoming * law.bottoming_depth), switching);
  }
  const lane_mask switches = switching > 0.0;
  if (a->S && ali3_any(switches)) ali3_add_outer(a->S, 7, ali3_where(switches, switching, none), difference);
  const real size = ali3_norm(mean.normal);
  for (int i = 0; i < 3; i++) mean.normal[i] = ali3_where(size > 0.0, mean.normal[i] / size, ali3_same(i == 2));
  return mean;
}

ali3_tyre_motion ali3_tyre_axes(const ali3_tyre_patch *contact, const real e[3]) {
  ali3_tyre_motion m = {0};
  const real *rho = contact->rho, *n = contact->normal;
  m.loaded = ali3_norm(rho);
  ali3_cross(e, n, m.forward);
  m.upright = ali3_norm(m.forward);
  const lane_mask flat = m.upright < 1e-9;
  for (int i = 0; i < 3; i++) m.forward[i] = ali3_where(flat, ali3_same(i == 0), m.forward[i] / m.upright);
  ali3_cross(n, m.forward, m.left);
  ali3_cross(e, rho, m.push);
  return m;
}

real ali3_tyre_moving(real speed) {
  const real rolls = speed / ALI3_TYRE_ROLLS;
  return ali3_where(rolls < 1.0, rolls * rolls * (2.0 - rolls * rolls), ali3_same(1.0));
}

void ali3_tyre_velocities(const ali3_element_args *a, const ali3_tyre_patch *contact, const real e[3], real ratio,
                          ali3_tyre_motion *m) {
  const real *rd = a->ud, *rho = contact->rho, turn = ali3_dot(a->ud + 3, rho);
  for (int i = 0; i < 2; i++) {
    const real *t = i ? m->left : m->forward, spin = ali3_dot(t, m->push), lean = ali3_dot(t, e);
    m->travel[i] = ali3_dot(t, rd) - lean * turn;
    m->v[i] = m->travel[i] + ratio * spin * a->ud[6];
    for (int k = 0; k < 3; k++) m->row[i][k] = t[k], m->row[i][3 + k] = -lean * rho[k];
    m->row[i][6] = ratio * spin;
  }
}

void ali3_tyre_add_force(ali3_element_args *a, const ali3_tyre_motion *m, const real F[2], const real C[3]) {
  for (int k = 0; k < 7; k++) a->f[k] += F[0] * m->row[0][k] + F[1] * m->row[1][k];
  if (!a->S) return;
  ali3_add_outer(a->S, 7, a->wC * C[0], m->row[0]);
  ali3_add_symmetric(a->S, 7, 2.0 * a->wC * C[1], m->row[0], m->row[1]);
  ali3_add_outer(a->S, 7, a->wC * C[2], m->row[1]);
}

void ali3_tyre_outputs(ali3_element_args *a, const ali3_tyre_patch *contact, const real e[3], const ali3_tyre_motion *m,
                       real radius, real ratio, const real force[2], real moment, real resisting) {
  const real none = {0}, hub_reached = contact->beyond;
  const real deflection =
      ali3_where(hub_reached > 0.0, hub_reached, ali3_where(m->loaded < radius, radius - m->loaded, none));
  const real min_speed = ali3_same(MIN_SLIP_SPEED);
  const real drive = -ratio * ali3_dot(m->forward, m->push) * a->ud[6]; /* circumferential speed */
  const real reference_speed =
      ali3_hypot(ali3_where(ali3_abs(drive) > ali3_abs(m->travel[0]), drive, m->travel[0]), min_speed);
  a->out[TYRE_OUT_LONGITUDINAL_FORCE] = force[0];
  a->out[TYRE_OUT_LATERAL_FORCE] = force[1];
  a->out[TYRE_OUT_VERTICAL_FORCE] = contact->load;
  a->out[TYRE_OUT_ALIGNING_MOMENT] = moment;
  a->out[TYRE_OUT_SLIP] = -m->v[0] / reference_speed;
  a->out[TYRE_OUT_SLIP_ANGLE] = ali3_atan2(m->v[1], ali3_hypot(m->travel[0], min_speed));
  a->out[TYRE_OUT_DEFLECTION] = deflection;
  a->out[TYRE_OUT_LOADED_RADIUS] = radius - deflection;
  const lane_mask bears = contact->load > 0.0;
  for (int i = 0; i < 3; i++) {
    a->out[TYRE_OUT_CONTACT_X + i] = a->u[i] + ali3_where(bears, contact->rho[i], contact->near_rho[i]);
    a->out[TYRE_OUT_NORMAL_X + i] = ali3_where(bears, contact->normal[i], contact->near_normal[i]);
  }
  /* moment about the axis beyond that of the force at the contact point */
  const real about_axis = force[0] * (ratio - 1.0) * ali3_dot(m->forward, m->push) + resisting;
  a->out[TYRE_OUT_ROLLING_MOMENT] = about_axis * ali3_dot(e, m->left);
  a->out[TYRE_OUT_INCLINATION] = ali3_atan2(ali3_dot(e, contact->normal), m->upright);
}

#ifndef ALI3_WIDTH
double ali3_tyre_depth(const ali3_element_args *a, double raised, double *share) {
  const double *axis = a->u + 3, length = ali3_norm(axis), radius = a->real[0];
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
      *share = contact[k].cosine;
    }
  return deepest;
}

ali3_start_verdict ali3_tyre_start(const ali3_element_args *a, double raised) {
  double share = 0.0;
  const double deepest = fmax(ali3_tyre_depth(a, raised, &share), 0.0);
  return (ali3_start_verdict){.excess = deepest - a->real[0],
                              .rise = deepest > CLEAR ? deepest * share : 0.0,
                              .pressed = deepest - a->real[0] + RIM_HOLDS * a->real[1]};
}
#endif
