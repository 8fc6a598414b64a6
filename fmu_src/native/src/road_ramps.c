/* Answers on the road for the end of the step that they hold in: within the step the road goes there from the last ones,
 * so that neither end misses how it bends, see docs/decisions/0091. */
#include <math.h>

#include "slave.h"

static const double AHEAD = 0.5; /* of the way between two answers: so far ahead of its wheel one is for the end */
static const double SAME = 1e-12; /* of metres, of unit normals and of frictions: round-off of what was reached */
enum { ANSWER = 7 }; /* point, normal, friction */

bool slave_is_answer(size_t i) {
  const slave_table *t = &slave_the_table;
  return i + ANSWER <= t->n_known && t->variable[i].role == SLAVE_ANSWER && t->variable[i + 3].role == SLAVE_NORMAL &&
         t->variable[i].other >= 0;
}

/* An input at the end of the last step, whose derivatives it may have followed. */
double slave_reached(const slave *s, size_t i) {
  const slave_variable *v = &slave_the_table.variable[i];
  double value;
  ali3_get_input(s->fidelity.kernel, v->index, &value);
  if (s->made.sloped) slave_add_slope(s->made_slope, i, (double)s->made.n * s->made.h, &value);
  return v->scale * value;
}

/* Whether the answer at i goes there from the one before it, by the slopes of its step. */
bool slave_is_ramp(const double *slope, size_t i) {
  for (size_t k = 0; k < ANSWER; k++)
    if (slope[(i + k) * SLAVE_TERMS] != 0.0) return true;
  return false;
}

static bool followed(const slave *s, size_t i) {
  for (size_t k = 0; k < ANSWER * SLAVE_TERMS; k++)
    if (s->slope[i * SLAVE_TERMS + k] != 0.0) return true;
  return false;
}

/* One that nobody sets anew holds, where a derivative has led the last one too. */
static bool is_new(const slave *s, size_t i) {
  for (size_t k = 0; k < ANSWER; k++)
    if (s->pending[i + k]) return true;
  return false;
}

/* Whether the answer at i is one for a place ahead of its wheel, of another plane than the last one, with no edge on the
 * way from that. */
static bool is_ahead(slave *s, size_t i) {
  if (!is_new(s, i)) return false;
  const double *now = &s->value[i], *centre = &s->value[slave_the_table.variable[i].other];
  double square = 0.0, turn = 0.0, rise = 0.0, size = 1.0, above = 0.0, ahead = 0.0, way[3];
  for (size_t k = 0; k < 3; k++) {
    const double last = slave_reached(s, i + 3 + k), bend = now[3 + k] - last;
    way[k] = now[k] - slave_reached(s, i + k);
    rise += last * way[k];
    size += fabs(now[k]);
    square += way[k] * way[k];
    turn += bend * bend;
  }
  if (turn < SAME * SAME && fabs(rise) < SAME * size && fabs(now[6] - slave_reached(s, i + 6)) < SAME) return false;
  if (!(square > 0.0) || turn > SLAVE_EDGE * SLAVE_EDGE || followed(s, i) || !slave_outputs(s)) return false;
  for (size_t k = 0; k < 3; k++) above += now[3 + k] * (centre[k] - now[k]);
  for (size_t k = 0; k < 3; k++) ahead += (now[k] + above * now[3 + k] - centre[k]) * way[k];
  return ahead > AHEAD * square;
}

/* Before a step, after normals are held; a first answer has none to come from. */
void slave_begin_ramps(slave *s, double step) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i < t->n_known && s->made.n > 0; i++) {
    if (!slave_is_answer(i) || !is_ahead(s, i)) continue;
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
