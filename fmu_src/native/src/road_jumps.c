/* Answers on the road that lift a wheel at once, take the road away from it, or turn the load on it. */
#include <math.h>

#include "slave.h"

static const double JUMP = 0.015; /* m; from 0.02 m on a load is off by a fifth, see docs/decisions/0184 */

static const double TURN = 0.3; /* of unit normals; sums of ground and edge stay below it, see docs/decisions/0186 */

/* A normal that turns at once says that one plane bears where ground and edge do. */
static void watch_turn(slave *s, size_t i) {
  const slave_variable *v = &slave_the_table.variable[i];
  double last[3], now[3], square = 0.0;
  for (size_t k = 0; k < 3; k++) {
    ali3_get_input(s->fidelity.kernel, v[3 + k].index, &last[k]);
    now[k] = s->value[i + 3 + k];
  }
  for (size_t k = 0; k < 3; k++) square += (now[k] - last[k]) * (now[k] - last[k]);
  if (!(square > TURN * TURN)) return;
  s->said[i] |= SLAVE_TURNED;
  slave_say(
      s, SLAVE_WARNING,
      "At %.6g s the normal of the answer '%s' turned at once from (%.3g, %.3g, %.3g) to (%.3g, %.3g, %.3g), and with "
      "it "
      "the load of its wheel. A wheel that touches ground and edge bears on both: answer with the plane whose depth "
      "and "
      "normal are the sum of both depths along their normals, or take shorter communication steps. This is said once.",
      ali3_time(s->fidelity.kernel), v[3].name, last[0], last[1], last[2], now[0], now[1], now[2]);
}

/* How far the plane of the answer at i lifts what is at a point, against the plane of the last one, m. */
static double lifted(const slave *s, size_t i, const double *point) {
  const double *now = &s->value[i];
  double last[6], by = 0.0; /* points and normals */
  for (size_t k = 0; k < 6; k++) ali3_get_input(s->fidelity.kernel, slave_the_table.variable[i + k].index, &last[k]);
  for (size_t k = 0; k < 3; k++) by += last[3 + k] * (point[k] - last[k]) - now[3 + k] * (point[k] - now[k]);
  return by;
}

/* Before a step, after normals are held: an answer that lifts its wheel at once, or takes the road away from it. The
 * plane of an edge, which turns about the centre of the wheel, does not. Returns the one by which the step that follows
 * may be refused, or NULL. */
const slave_variable *slave_watch_jumps(slave *s) {
  const slave_table *t = &slave_the_table;
  const slave_variable *found = NULL;
  double largest = JUMP;
  for (size_t i = 0; i + 5 < t->n_known; i++) {
    const slave_variable *v = &t->variable[i];
    if (v->role != SLAVE_ANSWER || t->variable[i + 3].role != SLAVE_NORMAL || v->other < 0) continue;
    if (!(s->said[i] & SLAVE_TURNED)) watch_turn(s, i);
    if (!(fabs(lifted(s, i, &s->value[i])) > JUMP) || !slave_outputs(s)) continue;
    const double by = lifted(s, i, &s->value[v->other]);
    if (fabs(by) > largest) {
      largest = fabs(by);
      found = v + 2;
    }
    if (!(fabs(by) > JUMP) || s->said[i] & SLAVE_JUMPED) continue;
    s->said[i] |= SLAVE_JUMPED;
    slave_say(
        s, SLAVE_WARNING,
        "At %.6g s the answer '%s' = %.6g m with its normal lies %.3g m %s the plane of the last one, seen from "
        "its wheel, which is lifted or falls at once; its load is not that of a wheel on an edge. At an edge that "
        "a wheel touches the answer is the point of the edge and the normal towards the centre of the wheel. This "
        "is said once.",
        ali3_time(s->fidelity.kernel), v[2].name, s->value[i + 2], fabs(by), by > 0.0 ? "above" : "below");
  }
  return found;
}
