/* What other programs answer on the road under a wheel: a normal that is none holds the last one, an answer on a place
 * far from the wheel is told. */
#include <math.h>

#include "slave.h"

static const double FAR_AWAY = 10.0; /* m */

/* Before a step or a start. The last normal is that of the kernel, at a start that of the table. */
void slave_hold_normals(slave *s) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i + 2 < t->n_known; i++) {
    double *n = &s->value[i], held[3];
    if (t->variable[i].normal != 1 || ali3_is_road_normal(n)) continue;
    for (size_t k = 0; k < 3; k++) {
      held[k] = t->variable[i + k].start;
      if (s->calls.initialised) ali3_get_input(s->fidelity.kernel, t->variable[i + k].index, &held[k]);
    }
    if (!(s->said[i] & SLAVE_HELD_NORMAL))
      slave_say(s, SLAVE_WARNING,
                "The normal of the road '%s' and its neighbours was set to (%g, %g, %g); it must be a unit vector that "
                "points up, and the last one, (%g, %g, %g), is held. This is said once.",
                t->variable[i].name, n[0], n[1], n[2], held[0], held[1], held[2]);
    s->said[i] |= SLAVE_HELD_NORMAL;
    for (size_t k = 0; k < 3; k++) {
      n[k] = held[k];
      for (size_t order = 0; order < SLAVE_MOST_ORDERS; order++) s->slope[(i + k) * SLAVE_MOST_ORDERS + order] = 0.0;
    }
  }
}

/* After the outputs are known. */
void slave_watch_answers(slave *s) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i + 2 < t->n_known; i++) {
    const slave_variable *v = &t->variable[i];
    if (v->source != SLAVE_INPUT || v->other < 0 || s->said[i] & SLAVE_FAR || s->made.n == 0) continue;
    double square = 0.0;
    for (size_t k = 0; k < 3; k++) {
      const double gap = s->value[i + k] - s->value[(size_t)v->other + k];
      square += gap * gap;
    }
    if (!(square > FAR_AWAY * FAR_AWAY)) continue;
    s->said[i] |= SLAVE_FAR;
    slave_say(s, SLAVE_WARNING,
              "At %.6g s the last answer on the road at '%s' holds for the point (%.6g, %.6g, %.6g), %.3g m from its "
              "wheel; the road is taken to go on as a plane from there. This is said once.",
              ali3_time(s->fidelity.kernel), v->name, s->value[i], s->value[i + 1], s->value[i + 2], sqrt(square));
  }
}
