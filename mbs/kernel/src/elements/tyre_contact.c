#include "tyre_contact.h"

#include "../algebra/elementary.h"
#include "element_math.h"
#include "road.h"

#define TOUCH_DEPTH 0.005 /* m, over which the radial damping sets in */
#define CLEAR 1e-6 /* m: a depth that counts as none at a start */
#define RIM_HOLDS 0.8 /* of the bottoming radius: nearer to the centre no wheel is pressed in */

void ali3_tyre_axis(const double axis[3], double e[3]) {
  const double size = ali3_norm(axis);
  for (int i = 0; i < 3; i++) e[i] = size > 1e-6 ? axis[i] / size : (i == 1);
}

ali3_tyre_patch ali3_tyre_radial(ali3_element_args *a, const double e[3], const ali3_tyre_spring *s) {
  ali3_contact contact[2];
  ali3_tyre_patch mean = {0};
  double deepest = -INFINITY, between[7] = {0}, switching = 0.0;
  const int count = ali3_road_contacts(&a->roads[a->integer[0]], a->u, e, s->radius, contact);
  for (int k = 0; k < count; k++) {
    const ali3_contact *c = &contact[k];
    const double depth = c->penetration, radius = s->radius - depth, lean = ali3_dot(e, c->normal);
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
    const double deep = depth - (s->radius - s->bottoming_radius), hard = deep > 0.0 ? s->bottoming_stiffness : 0.0;
    const double ramp = depth < TOUCH_DEPTH ? depth / TOUCH_DEPTH : 1.0;
    const double part = 1.0 - c->yielded;
    const double force =
        part * ((s->stiffness + s->progression * depth) * depth + hard * deep + s->damping * rate * ramp);
    a->potential +=
        part * (0.5 * ((s->stiffness + s->progression * (2.0 / 3.0) * depth) * depth * depth + hard * deep * deep));
    a->piece |= (uint32_t)(ALI3_TYRE_TOUCHES | (deep > 0.0 ? ALI3_TYRE_BOTTOMS : 0) |
                           (ramp < 1.0 ? 0 : ALI3_TYRE_FULLY) | (force > 0.0 ? ALI3_TYRE_PRESSES : 0))
                << ALI3_TYRE_CONTACT_BITS * k;
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
    double stiffness =
        s->stiffness + 2.0 * s->progression * depth + hard + (ramp < 1.0 ? s->damping * rate / TOUCH_DEPTH : 0.0);
    if (stiffness < 0.0) stiffness = 0.0;
    ali3_add_outer(a->S, 7, part * (a->wK * stiffness + a->wC * s->damping * ramp), b);
    for (int i = 0; i < 7; i++) between[i] += k ? -b[i] : b[i];
    switching = a->wK * c->switching * ((s->stiffness + s->progression * depth) * depth + hard * deep);
  }
  if (a->S && switching > 0.0) ali3_add_outer(a->S, 7, switching, between);
  const double size = ali3_norm(mean.normal);
  for (int i = 0; i < 3; i++) mean.normal[i] = size > 0.0 ? mean.normal[i] / size : (i == 2);
  return mean;
}

ali3_tyre_motion ali3_tyre_axes(const ali3_tyre_patch *contact, const double e[3]) {
  ali3_tyre_motion m = {0};
  const double *rho = contact->rho, *n = contact->normal;
  m.loaded = ali3_norm(rho);
  ali3_cross(e, n, m.forward);
  m.upright = ali3_norm(m.forward);
  const double size = m.upright < 1e-9 ? 1.0 : m.upright;
  if (m.upright < 1e-9) m.forward[0] = 1.0, m.forward[1] = m.forward[2] = 0.0;
  for (int i = 0; i < 3; i++) m.forward[i] /= size;
  ali3_cross(n, m.forward, m.left);
  ali3_cross(e, rho, m.push);
  return m;
}

double ali3_tyre_moving(double speed) {
  const double rolls = speed / ALI3_TYRE_ROLLS;
  return rolls < 1.0 ? rolls * rolls * (2.0 - rolls * rolls) : 1.0;
}

void ali3_tyre_velocities(const ali3_element_args *a, const ali3_tyre_patch *contact, const double e[3], double ratio,
                          ali3_tyre_motion *m) {
  const double *rd = a->ud, *rho = contact->rho, turn = ali3_dot(a->ud + 3, rho);
  for (int i = 0; i < 2; i++) {
    const double *t = i ? m->left : m->forward, spin = ali3_dot(t, m->push), lean = ali3_dot(t, e);
    m->travel[i] = ali3_dot(t, rd) - lean * turn;
    m->v[i] = m->travel[i] + ratio * spin * a->ud[6];
    for (int k = 0; k < 3; k++) m->row[i][k] = t[k], m->row[i][3 + k] = -lean * rho[k];
    m->row[i][6] = ratio * spin;
  }
}

enum { FX, FY, FZ, MZ, SLIP, SLIP_ANGLE, DEFLECTION, LOADED_RADIUS, CONTACT_X, INCLINATION = CONTACT_X + 3, NORMAL_X };
enum { ROLLING_MOMENT = NORMAL_X + 3 };

void ali3_tyre_outputs(ali3_element_args *a, const ali3_tyre_patch *contact, const double e[3],
                       const ali3_tyre_motion *m, double radius, double ratio, const double force[2], double moment,
                       double resisting) {
  const double deflection = m->loaded < radius ? radius - m->loaded : 0.0;
  const double drive = -ratio * ali3_dot(m->forward, m->push) * a->ud[6]; /* circumferential speed */
  const double fastest = ali3_hypot(fabs(drive) > fabs(m->travel[0]) ? drive : m->travel[0], 0.01);
  const double slip = -m->v[0] / fastest, slip_angle = ali3_atan2(m->v[1], ali3_hypot(m->travel[0], 0.01));
  const double out[] = {force[0], force[1], contact->load, moment, slip, slip_angle, deflection, radius - deflection};
  for (int i = 0; i < CONTACT_X; i++) a->out[i] = out[i];
  const double *at = contact->load > 0.0 ? contact->rho : contact->near_rho;
  const double *up = contact->load > 0.0 ? contact->normal : contact->near_normal;
  for (int i = 0; i < 3; i++) a->out[CONTACT_X + i] = a->u[i] + at[i], a->out[NORMAL_X + i] = up[i];
  /* what turns the wheel beside the force at the contact point */
  const double about_axis = force[0] * (ratio - 1.0) * ali3_dot(m->forward, m->push) + resisting;
  a->out[ROLLING_MOMENT] = about_axis * ali3_dot(e, m->left);
  a->out[INCLINATION] = ali3_atan2(ali3_dot(e, contact->normal), m->upright);
}

void ali3_tyre_semidefinite(double C[3]) {
  const double mean = 0.5 * (C[0] + C[2]), half = 0.5 * (C[0] - C[2]), split = ali3_hypot(half, C[1]);
  if (mean >= split) return;
  const double top = mean + split > 0.0 ? mean + split : 0.0;
  const double cosine = split > 0.0 ? half / split : 0.0, sine = split > 0.0 ? C[1] / split : 0.0;
  C[0] = 0.5 * top * (1.0 + cosine);
  C[1] = 0.5 * top * sine;
  C[2] = 0.5 * top * (1.0 - cosine);
}

double ali3_tyre_depth(const ali3_element_args *a, double raised, double *part) {
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
      *part = contact[k].cosine;
    }
  return deepest;
}

/* A start with the wheel's centre below the surface: the spring of a tyre is not meant for that and would throw the
 * scene up. The rise is the depth along the road's normal; walls are climbed a depth at a time. */
ali3_start_verdict ali3_tyre_start(const ali3_element_args *a, double raised) {
  double part = 0.0;
  const double deepest = fmax(ali3_tyre_depth(a, raised, &part), 0.0);
  return (ali3_start_verdict){.excess = deepest - a->real[0],
                              .rise = deepest > CLEAR ? deepest * part : 0.0,
                              .pressed = deepest - a->real[0] + RIM_HOLDS * a->real[1]};
}
