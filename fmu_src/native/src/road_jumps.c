/* Answers on the road that lift a wheel at once, take the road away from it, turn the load on it, or lie too far apart
 * for how the road bends. */
#include <math.h>

#include "slave.h"

static const double JUMP = 0.015; /* m; from 0.02 m on a load is off by a fifth, see docs/decisions/0091 */

static const double BEND = 1e-4; /* m; loads are then off by up to 1.2 %, see docs/decisions/0091 */
static const double FARTHEST = 4.0; /* square of a wheel's way to an answer over that between two */

/* A normal that turns at once says that one plane bears where ground and edge do. */
static void watch_turn(slave *s, size_t i) {
  const slave_variable *v = &slave_the_table.variable[i];
  double last[3], now[3], square = 0.0;
  for (size_t k = 0; k < 3; k++) {
    last[k] = slave_reached(s, i + 3 + k);
    now[k] = s->value[i + 3 + k];
  }
  for (size_t k = 0; k < 3; k++) square += (now[k] - last[k]) * (now[k] - last[k]);
  if (!(square > SLAVE_EDGE * SLAVE_EDGE)) return;
  s->said[i] |= SLAVE_TURNED;
  slave_say(
      s, SLAVE_WARNING,
      "At %.6g s the normal of the answer '%s' turned at once from (%.3g, %.3g, %.3g) to (%.3g, %.3g, %.3g), and with "
      "it the load of its wheel. A wheel that touches ground and edge bears on both: answer with the plane whose depth "
      "and normal are the sum of both depths along their normals, or take shorter communication steps. This is "
      "reported once.",
      ali3_time(s->fidelity.kernel), v[3].name, last[0], last[1], last[2], now[0], now[1], now[2]);
}

/* How far the plane of the answer at i lifts what is at a point, against the plane of the last one, m. */
static double lifted(const slave *s, size_t i, const double *point) {
  const double *now = &s->value[i];
  double last[6], by = 0.0; /* points and normals */
  for (size_t k = 0; k < 6; k++) last[k] = slave_reached(s, i + k);
  for (size_t k = 0; k < 3; k++) by += last[3 + k] * (point[k] - last[k]) - now[3 + k] * (point[k] - now[k]);
  return by;
}

/* Two planes that touch a road tell how it bends between them, and by that how far each missed it at the wheel: the last
 * one at the end of its step, the new one at the start of its. */
static void watch_bend(slave *s, size_t i) {
  const double *now = &s->value[i], *centre = &s->value[slave_the_table.variable[i].other];
  double bend = 0.0, square = 0.0, above = 0.0, away = 0.0, behind = 0.0, way[3];
  for (size_t k = 0; k < 3; k++) {
    way[k] = now[k] - slave_reached(s, i + k);
    square += way[k] * way[k];
    bend += way[k] * (now[3 + k] - slave_reached(s, i + 3 + k));
  }
  if (s->made.n == 0 || !(fabs(bend) > BEND || fabs(lifted(s, i, now)) > BEND) || !slave_outputs(s)) return;
  for (size_t k = 0; k < 3; k++) above += now[3 + k] * (centre[k] - now[k]);
  for (size_t k = 0; k < 3; k++) {
    const double along = centre[k] - now[k] - above * now[3 + k];
    away += along * along;
    behind += along * way[k];
  }
  const double far = 0.5 * bend * fmin(away / square, FARTHEST), end = far - lifted(s, i, centre);
  /* a road that goes from one plane to the next misses a quarter, in the middle, and is 0.2 % off at 0.1 mm */
  const bool ramp = slave_is_ramp(s->slope, i);
  const double start = ramp ? 0.25 * far : far, most = ramp ? 4.0 * BEND : BEND;
  if (!(fabs(end) + 0.25 * fabs(start) > most)) return; /* a step makes more of its end */
  s->said[i + 1] |= SLAVE_TURNED;
  slave_say(s, SLAVE_WARNING,
            "At %.6g s the answer on the road '%s' tells that the last one was off by %.2g mm at its wheel at the end "
            "of its step, and that it is off by %.2g mm itself%s; where the road goes on so, loads are off by 1 %% or "
            "more. It holds for %.1f steps ahead of its wheel, where 1 is best. Ask at the point ahead, with "
            "ports.road_lead = 1 where an answer holds in the step that follows the question, with 2 where all "
            "programs step at once, or take shorter communication steps; ports.road_lead is %g now. This is reported "
            "once.",
            ali3_time(s->fidelity.kernel), slave_the_table.variable[i].name, 1e3 * fabs(end), 1e3 * fabs(start),
            ramp ? " in the middle of its step" : "", 0.0 + nearbyint(-10.0 * behind / square) / 10.0,
            s->value[s->lead_reference]);
}

/* Before a step, after normals are held: an answer that lifts its wheel at once, or takes the road away from it. The
 * plane of an edge, which turns about the centre of the wheel, does not. Returns the one by which the step that follows
 * may be refused, or NULL. */
const slave_variable *slave_watch_jumps(slave *s) {
  const slave_table *t = &slave_the_table;
  const slave_variable *found = NULL;
  double largest = JUMP;
  for (size_t i = 0; i < t->n_known; i++) {
    const slave_variable *v = &t->variable[i];
    if (!slave_is_answer(i)) continue;
    if (!(s->said[i] & SLAVE_TURNED)) watch_turn(s, i);
    if (!(s->said[i + 1] & SLAVE_TURNED)) watch_bend(s, i);
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
        "is reported once.",
        ali3_time(s->fidelity.kernel), v[2].name, s->value[i + 2], fabs(by), by > 0.0 ? "above" : "below");
  }
  return found;
}
