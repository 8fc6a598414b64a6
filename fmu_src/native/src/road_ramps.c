/* Answers on the road for the end of the step that they hold in: within the step the road goes there from the last ones,
 * so that neither end misses how it bends, see docs/decisions/0240. */
#include <math.h>

#include "slave.h"

static const double AHEAD = 0.5; /* of the way between two answers: so far ahead of its wheel one is for the end */
static const double TURN = 0.3; /* of unit normals: beyond it are edges, see docs/decisions/0186 */
static const double SAME = 1e-12; /* m */
enum { ANSWER = 7 }; /* point, normal, friction */

/* An input at the end of the last step, whose derivatives it may have followed. */
double slave_reached(const slave *s, size_t i) {
  const slave_variable *v = &slave_the_table.variable[i];
  double value;
  ali3_get_input(s->fidelity.kernel, v->index, &value);
  if (s->made.sloped) slave_add_slope(s->made_slope, i, (double)s->made.n * s->made.h, &value);
  return v->scale * value;
}

/* Whether the answer at i goes there from the last one in the step that begins. */
bool slave_is_ramp(const slave *s, size_t i) {
  for (size_t k = 0; k < ANSWER; k++)
    if (s->slope[(i + k) * SLAVE_TERMS] != 0.0) return true;
  return false;
}

static bool followed(const slave *s, size_t i) {
  for (size_t k = 0; k < ANSWER * SLAVE_TERMS; k++)
    if (s->slope[i * SLAVE_TERMS + k] != 0.0) return true;
  return false;
}

/* Whether the answer at i is one for a place ahead of its wheel, of another plane than the last one, with no edge on the
 * way from that. */
static bool is_ahead(slave *s, size_t i) {
  const double *now = &s->value[i], *centre = &s->value[slave_the_table.variable[i].other];
  double square = 0.0, turn = 0.0, rise = 0.0, above = 0.0, ahead = 0.0, way[3];
  for (size_t k = 0; k < 3; k++) {
    const double last = slave_reached(s, i + 3 + k), bend = now[3 + k] - last;
    way[k] = now[k] - slave_reached(s, i + k);
    rise += last * way[k];
    square += way[k] * way[k];
    turn += bend * bend;
  }
  if (turn == 0.0 && fabs(rise) < SAME && now[6] == slave_reached(s, i + 6)) return false;
  if (!(square > 0.0) || turn > TURN * TURN || followed(s, i) || !slave_outputs(s)) return false;
  for (size_t k = 0; k < 3; k++) above += now[3 + k] * (centre[k] - now[k]);
  for (size_t k = 0; k < 3; k++) ahead += (now[k] + above * now[3 + k] - centre[k]) * way[k];
  return ahead > AHEAD * square;
}

/* Before a step, after normals are held; a first answer has none to come from. */
void slave_begin_ramps(slave *s, double step) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i + ANSWER <= t->n_known && s->made.n > 0; i++) {
    if (t->variable[i].role != SLAVE_ANSWER || t->variable[i + 3].role != SLAVE_NORMAL || t->variable[i].other < 0 ||
        !is_ahead(s, i))
      continue;
    for (size_t k = 0; k < ANSWER; k++) {
      const double way = s->value[i + k] - slave_reached(s, i + k);
      s->slope[(i + k) * SLAVE_TERMS] = -way;
      s->slope[(i + k) * SLAVE_TERMS + 1] = way / step;
    }
  }
}

/* After a step that was refused. */
void slave_end_ramps(slave *s) {
  for (size_t i = 0; i < slave_the_table.n_known; i++)
    if (s->slope[i * SLAVE_TERMS] != 0.0) s->slope[i * SLAVE_TERMS] = s->slope[i * SLAVE_TERMS + 1] = 0.0;
}
