/* Checks of inputs that other programs compute for a wheel: invalid normals of the road are replaced by the last ones;
 * warnings of answers for a point far from the wheel and of steps that are too long for a tyre. */
#include <math.h>
#include <stdio.h>

#include "slave.h"

static const double FAR_AWAY = 10.0; /* m */
static const double STABLE =
    0.85; /* of the step at which a wheel becomes unstable; measured, see docs/decisions/0225 */
enum { HUB_SIZE = 6 }; /* force and moment */

void slave_hold_normals(slave *s) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i + 2 < t->n_known; i++) {
    double *n = &s->value[i], held[3];
    if (t->variable[i].role != SLAVE_NORMAL || ali3_is_road_normal(n)) continue;
    for (size_t k = 0; k < 3; k++) {
      held[k] = t->variable[i + k].start;
      if (s->calls.initialised) ali3_get_input(s->fidelity.kernel, t->variable[i + k].index, &held[k]);
    }
    if (!(s->input_flags[i] & SLAVE_HELD_NORMAL))
      slave_log(s, SLAVE_WARNING,
                "The normal of the road '%s' and its neighbours was set to (%g, %g, %g); it must be a unit vector that "
                "points up, and the last one, (%g, %g, %g), is held. This is reported once.",
                t->variable[i].name, n[0], n[1], n[2], held[0], held[1], held[2]);
    s->input_flags[i] |= SLAVE_HELD_NORMAL;
    for (size_t k = 0; k < 3; k++) {
      n[k] = held[k];
      for (size_t order = 0; order < SLAVE_TERMS; order++) s->slope[(i + k) * SLAVE_TERMS + order] = 0.0;
    }
  }
}

void slave_bad_normal_text(const slave *s, char *text, size_t size) {
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

/* Warns of an answer for a point far from its wheel. */
static void check_answer(slave *s, size_t i) {
  const slave_variable *v = &slave_the_table.variable[i];
  double square = 0.0;
  for (size_t k = 0; k < 3; k++) {
    const double gap = s->value[i + k] - s->value[(size_t)v->other + k];
    square += gap * gap;
  }
  if (!(square > FAR_AWAY * FAR_AWAY)) return;
  s->input_flags[i] |= SLAVE_FAR;
  slave_log(s, SLAVE_WARNING,
            "At %.6g s the last answer on the road at '%s' holds for the point (%.6g, %.6g, %.6g), %.3g m from its "
            "wheel; the road is taken to go on as a plane from there. This is reported once.",
            ali3_time(s->fidelity.kernel), v->name, s->value[i], s->value[i + 1], s->value[i + 2], sqrt(square));
}

/* Whether a derivative of the force or moment on a hub was set for the last step. */
static bool has_derivative(const slave *s, size_t hub) {
  const double *slope = &s->completed_slope[hub * SLAVE_TERMS];
  for (size_t k = 0; s->completed.sloped && k < HUB_SIZE * SLAVE_TERMS; k++)
    if (slope[k] != 0.0) return true;
  return false;
}

/* Longest step, s, with which a wheel with a tyre like its own is stable. The spin oscillates on the spring of the
 * carcass, whose force is delayed; its settling time is the damping, which a delay reduces: constant forces, used in
 * the next step or the one after it, are delayed by 1/2 or 3/2 of a step; lines through the last two forces, used at
 * once, by its cube. */
static double stable_step(const slave_variable *v, double speed, bool has_slopes, bool delayed) {
  const double settling = v->figure[0] / (1.0 + v->figure[1] * speed * speed) + v->figure[2] * speed;
  if (delayed) return STABLE * 2.0 / 3.0 * settling;
  return STABLE * (has_slopes ? cbrt(4.0 * settling / v->figure[3]) : 2.0 * settling);
}

/* Time of the last change of the force and moment on a hub, s; *held: for how long they are constant, s, at least a
 * step. */
static double last_change(const slave *s, size_t hub, double step, double *held) {
  double changed = s->calls.start_time, shortest = HUGE_VAL;
  for (size_t k = 0; k < HUB_SIZE; k++) {
    const slave_port_times *r = &s->port_times[hub + k];
    changed = fmax(changed, r->changed);
    if (r->held > 0.0) shortest = fmin(shortest, r->held);
  }
  *held = shortest < HUGE_VAL ? fmax(step, shortest) : step;
  return changed;
}

/* Path of the wheel of a hub under forces that are constant since `changed`, m; 0 while it is in the air, where a tyre
 * has no forces. */
static double path_under(slave *s, size_t hub, double speed, double changed, double time) {
  slave_port_times *r = &s->port_times[hub];
  bool loaded = false;
  for (size_t k = 0; k < HUB_SIZE; k++) loaded = loaded || s->value[hub + k] != 0.0;
  r->path = loaded ? (changed >= r->seen ? 0.0 : r->path) + speed * (time - fmax(r->seen, changed)) : 0.0;
  r->seen = time;
  return r->path;
}

/* Warns of forces on a hub that are constant for too long, which make its wheel unstable. The first step has no
 * derivative yet. */
static void check_hub(slave *s, size_t i) {
  const slave_variable *v = &slave_the_table.variable[i];
  const double step = (double)s->completed.n * s->completed.h, *velocity = &s->value[v->other];
  const double speed = sqrt(velocity[0] * velocity[0] + velocity[1] * velocity[1]);
  const bool has_slopes = has_derivative(s, i);
  const double delayed = stable_step(v, speed, has_slopes, true), time = ali3_time(s->fidelity.kernel);
  double held;
  const double changed = last_change(s, i, step, &held), path = path_under(s, i, speed, changed, time);
  if (!has_slopes && path > FAR_AWAY && !(s->input_flags[i] & SLAVE_JUMPED)) {
    s->input_flags[i] |= SLAVE_JUMPED;
    slave_log(s, SLAVE_WARNING,
              "At %.6g s force and moment on the hub at '%s' are those of %.6g s, and its wheel went %.3g m since, on "
              "which those of a tyre change; another program must set them at every step. This is reported once.",
              time, v->name, changed, path);
  }
  if (s->input_flags[i] & SLAVE_FAR || !(held > 1.001 * delayed) || time - s->calls.start_time < 1.5 * step) return;
  s->input_flags[i] |= SLAVE_FAR;
  slave_log(s, SLAVE_WARNING,
            "At %.6g s the wheel at '%s' moves at %.3g m/s and its forces come every %g s: those of a tyre like the "
            "one left out that %s for longer than %.2g ms may shake it, where all programs step at once for longer "
            "than %.2g ms. Take shorter communication steps%s. This is reported once.",
            time, v->name, speed, held, has_slopes ? "follow derivatives" : "are held",
            1e3 * stable_step(v, speed, has_slopes, false), 1e3 * delayed,
            held > 1.5 * step ? ", also in the program of the tyre" : "");
}

void slave_watch_answers(slave *s) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i + 2 < t->n_known && s->completed.n > 0; i++) {
    const slave_variable *v = &t->variable[i];
    if (v->other < 0) continue;
    if (v->role == SLAVE_ANSWER && !(s->input_flags[i] & SLAVE_FAR)) check_answer(s, i);
    if (v->role == SLAVE_HUB) check_hub(s, i);
  }
}
