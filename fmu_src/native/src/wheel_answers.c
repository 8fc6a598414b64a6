/* What other programs answer for a wheel: a normal of the road that is none holds the last one, an answer on a place far
 * from the wheel is told, and so is a tyre whose step is long for it. */
#include <math.h>
#include <stdio.h>

#include "slave.h"

static const double FAR_AWAY = 10.0; /* m */
static const double CALM = 0.85; /* of the step from which on a wheel shakes; measured, see docs/decisions/0225 */
enum { HUB = 6 }; /* force and moment */

/* Before a step or a start. The last normal is that of the kernel, at a start that of the table. */
void slave_hold_normals(slave *s) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i + 2 < t->n_known; i++) {
    double *n = &s->value[i], held[3];
    if (t->variable[i].role != SLAVE_NORMAL || ali3_is_road_normal(n)) continue;
    for (size_t k = 0; k < 3; k++) {
      held[k] = t->variable[i + k].start;
      if (s->calls.initialised) ali3_get_input(s->fidelity.kernel, t->variable[i + k].index, &held[k]);
    }
    if (!(s->said[i] & SLAVE_HELD_NORMAL))
      slave_say(s, SLAVE_WARNING,
                "The normal of the road '%s' and its neighbours was set to (%g, %g, %g); it must be a unit vector that "
                "points up, and the last one, (%g, %g, %g), is held. This is reported once.",
                t->variable[i].name, n[0], n[1], n[2], held[0], held[1], held[2]);
    s->said[i] |= SLAVE_HELD_NORMAL;
    for (size_t k = 0; k < 3; k++) {
      n[k] = held[k];
      for (size_t order = 0; order < SLAVE_TERMS; order++) s->slope[(i + k) * SLAVE_TERMS + order] = 0.0;
    }
  }
}

/* After ALI3_BAD_NORMAL: the port whose normal derivatives led astray, by the inputs of the inner step in s->direction. */
void slave_bad_normal(const slave *s, char *text, size_t size) {
  const slave_table *t = &slave_the_table;
  text[0] = 0;
  for (size_t i = 0; i + 2 < t->n_known; i++) {
    if (t->variable[i].role != SLAVE_NORMAL || t->variable[i].source != SLAVE_INPUT) continue;
    double n[3];
    for (size_t k = 0; k < 3; k++) {
      const slave_variable *v = &t->variable[i + k];
      n[k] = fmax(v->min, fmin(v->max, s->direction[v->index]));
    }
    if (ali3_is_road_normal(n)) continue;
    snprintf(text, size, " With its derivatives '%s' and its neighbours became (%g, %g, %g).", t->variable[i].name,
             n[0], n[1], n[2]);
    return;
  }
}

static void watch_answer(slave *s, size_t i) {
  const slave_variable *v = &slave_the_table.variable[i];
  double square = 0.0;
  for (size_t k = 0; k < 3; k++) {
    const double gap = s->value[i + k] - s->value[(size_t)v->other + k];
    square += gap * gap;
  }
  if (!(square > FAR_AWAY * FAR_AWAY)) return;
  s->said[i] |= SLAVE_FAR;
  slave_say(s, SLAVE_WARNING,
            "At %.6g s the last answer on the road at '%s' holds for the point (%.6g, %.6g, %.6g), %.3g m from its "
            "wheel; the road is taken to go on as a plane from there. This is reported once.",
            ali3_time(s->fidelity.kernel), v->name, s->value[i], s->value[i + 1], s->value[i + 2], sqrt(square));
}

/* Whether a derivative of the force or moment on a hub was set for the step that was made. */
static bool follows(const slave *s, size_t hub) {
  const double *slope = &s->made_slope[hub * SLAVE_TERMS];
  for (size_t k = 0; s->made.sloped && k < HUB * SLAVE_TERMS; k++)
    if (slope[k] != 0.0) return true;
  return false;
}

/* The step up to which a wheel with a tyre like its own is calm. The spin turns on the spring of the carcass, whose force
 * comes late; settling times are the damping, which a delay takes away: held forces, used in the step that follows or
 * one later, have that of 1/2 or 3/2 of a step, lines of the last two, used at once, the delay of its cube. */
static double calm_step(const slave_variable *v, double speed, bool followed, bool late) {
  const double settling = v->figure[0] / (1.0 + v->figure[1] * speed * speed) + v->figure[2] * speed;
  if (late) return CALM * 2.0 / 3.0 * settling;
  return CALM * (followed ? cbrt(4.0 * settling / v->figure[3]) : 2.0 * settling);
}

/* Of force and moment on a hub: when one changed last, and for how long they are held, at least a step. */
static double last_change(const slave *s, size_t hub, double step, double *held) {
  double changed = s->calls.start_time, least = HUGE_VAL;
  for (size_t k = 0; k < HUB; k++) {
    const slave_rhythm *r = &s->rhythm[hub + k];
    changed = fmax(changed, r->changed);
    if (r->held > 0.0) least = fmin(least, r->held);
  }
  *held = least < HUGE_VAL ? fmax(step, least) : step;
  return changed;
}

/* How far the wheel of a hub went under forces that stay what they are since they `changed`, m; none while it is in the
 * air, where no tyre has any. */
static double way_under(slave *s, size_t hub, double speed, double changed, double time) {
  slave_rhythm *r = &s->rhythm[hub];
  bool pressed = false;
  for (size_t k = 0; k < HUB; k++) pressed = pressed || s->value[hub + k] != 0.0;
  r->way = pressed ? (changed >= r->seen ? 0.0 : r->way) + speed * (time - fmax(r->seen, changed)) : 0.0;
  r->seen = time;
  return r->way;
}

/* A tyre that answers once in a long step, or in several steps, shakes its wheel. The first step knows no derivative. */
static void watch_hub(slave *s, size_t i) {
  const slave_variable *v = &slave_the_table.variable[i];
  const double step = (double)s->made.n * s->made.h, *velocity = &s->value[v->other];
  const double speed = sqrt(velocity[0] * velocity[0] + velocity[1] * velocity[1]);
  const bool followed = follows(s, i);
  const double late = calm_step(v, speed, followed, true), time = ali3_time(s->fidelity.kernel);
  double held;
  const double changed = last_change(s, i, step, &held), way = way_under(s, i, speed, changed, time);
  if (!followed && way > FAR_AWAY && !(s->said[i] & SLAVE_JUMPED)) {
    s->said[i] |= SLAVE_JUMPED;
    slave_say(s, SLAVE_WARNING,
              "At %.6g s force and moment on the hub at '%s' are those of %.6g s, and its wheel went %.3g m since, on "
              "which those of a tyre change; another program must set them at every step. This is reported once.",
              time, v->name, changed, way);
  }
  if (s->said[i] & SLAVE_FAR || !(held > 1.001 * late) || time - s->calls.start_time < 1.5 * step) return;
  s->said[i] |= SLAVE_FAR;
  slave_say(s, SLAVE_WARNING,
            "At %.6g s the wheel at '%s' moves at %.3g m/s and its forces come every %g s: those of a tyre like the "
            "one left out that %s for longer than %.2g ms may shake it, where all programs step at once for longer "
            "than %.2g ms. Take shorter communication steps%s. This is reported once.",
            time, v->name, speed, held, followed ? "follow derivatives" : "are held",
            1e3 * calm_step(v, speed, followed, false), 1e3 * late,
            held > 1.5 * step ? ", also in the program of the tyre" : "");
}

/* After the outputs are known. */
void slave_watch_answers(slave *s) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i + 2 < t->n_known && s->made.n > 0; i++) {
    const slave_variable *v = &t->variable[i];
    if (v->other < 0) continue;
    if (v->role == SLAVE_ANSWER && !(s->said[i] & SLAVE_FAR)) watch_answer(s, i);
    if (v->role == SLAVE_HUB) watch_hub(s, i);
  }
}
