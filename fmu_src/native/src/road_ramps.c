/* Answers on the road that hold at the end of the communication step: within it the road changes linearly to them from
 * the last ones, so that the curvature of the road is followed at both ends, see docs/decisions/0091. */
#include <math.h>

#include "slave.h"

static const double MIN_LEAD =
    0.5; /* of the distance of two answers: an answer farther ahead of its wheel holds at the end of the step */
static const double ROUND_OFF = 1e-12; /* of metres, unit normals and frictions */
enum { ANSWER = 7 }; /* point, normal, friction */

bool slave_is_answer(size_t i) {
  const slave_table *t = &slave_the_table;
  return i + ANSWER <= t->n_known && t->variable[i].role == SLAVE_ANSWER && t->variable[i + 3].role == SLAVE_NORMAL &&
         t->variable[i].other >= 0;
}

double slave_reached_input(const slave *s, size_t i) {
  const slave_variable *v = &slave_the_table.variable[i];
  double value;
  ali3_get_input(s->fidelity.kernel, v->index, &value);
  if (s->completed.sloped) slave_add_slope(s->completed_slope, i, (double)s->completed.n * s->completed.h, &value);
  return v->scale * value;
}

bool slave_is_ramp(const double *slope, size_t i) {
  for (size_t k = 0; k < ANSWER; k++)
    if (slope[(i + k) * SLAVE_TERMS] != 0.0) return true;
  return false;
}

/* Whether the host set a derivative of the answer at i. */
static bool has_derivative(const slave *s, size_t i) {
  for (size_t k = 0; k < ANSWER * SLAVE_TERMS; k++)
    if (s->slope[i * SLAVE_TERMS + k] != 0.0) return true;
  return false;
}

/* Whether the answer at i was set since the last step; otherwise it holds. */
static bool is_new(const slave *s, size_t i) {
  for (size_t k = 0; k < ANSWER; k++)
    if (s->pending[i + k]) return true;
  return false;
}

/* Whether the answer at i is for a point ahead of its wheel, with another plane than the last one and no edge in
 * between. */
static bool is_ahead(slave *s, size_t i) {
  if (!is_new(s, i)) return false;
  const double *now = &s->value[i], *centre = &s->value[slave_the_table.variable[i].other];
  double square = 0.0, turn = 0.0, rise = 0.0, size = 1.0, height = 0.0, ahead = 0.0, path[3];
  for (size_t k = 0; k < 3; k++) {
    const double last = slave_reached_input(s, i + 3 + k), bend = now[3 + k] - last;
    path[k] = now[k] - slave_reached_input(s, i + k);
    rise += last * path[k];
    size += fabs(now[k]);
    square += path[k] * path[k];
    turn += bend * bend;
  }
  if (turn < ROUND_OFF * ROUND_OFF && fabs(rise) < ROUND_OFF * size &&
      fabs(now[6] - slave_reached_input(s, i + 6)) < ROUND_OFF)
    return false;
  if (!(square > 0.0) || turn > SLAVE_EDGE * SLAVE_EDGE || has_derivative(s, i) || !slave_compute_outputs(s))
    return false;
  for (size_t k = 0; k < 3; k++) height += now[3 + k] * (centre[k] - now[k]);
  for (size_t k = 0; k < 3; k++) ahead += (now[k] + height * now[3 + k] - centre[k]) * path[k];
  return ahead > MIN_LEAD * square;
}

void slave_begin_ramps(slave *s, double step) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i < t->n_known && s->completed.n > 0; i++) {
    if (!slave_is_answer(i) || !is_ahead(s, i)) continue;
    for (size_t k = 0; k < ANSWER; k++) {
      const double path = s->value[i + k] - slave_reached_input(s, i + k);
      s->slope[(i + k) * SLAVE_TERMS] = -path;
      s->slope[(i + k) * SLAVE_TERMS + 1] = path / step;
    }
  }
}

void slave_end_ramps(slave *s) {
  for (size_t i = 0; i < slave_the_table.n_known; i++)
    if (s->slope[i * SLAVE_TERMS] != 0.0) s->slope[i * SLAVE_TERMS] = s->slope[i * SLAVE_TERMS + 1] = 0.0;
}
