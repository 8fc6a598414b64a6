/* Checks of answers on the road that lift a wheel suddenly, drop the road below it, turn its load, or are too far apart
 * for the curvature of the road. */
#include <math.h>

#include "slave.h"

static const double JUMP = 0.015; /* m; at 0.02 m a load has an error of a fifth, see docs/decisions/0091 */

static const double BEND = 1e-4; /* m; loads then have errors of up to 1.2 %, see docs/decisions/0091 */
static const double MAX_RATIO =
    4.0; /* limit of the squared distance of a wheel from its answer, relative to the one between two answers */

/* A normal that turns suddenly shows that one plane carries the load where ground and edge should. */
static void check_turn(slave *s, size_t i) {
  const slave_variable *v = &slave_the_table.variable[i];
  double last[3], now[3], square = 0.0;
  for (size_t k = 0; k < 3; k++) {
    last[k] = slave_reached_input(s, i + 3 + k);
    now[k] = s->value[i + 3 + k];
  }
  for (size_t k = 0; k < 3; k++) square += (now[k] - last[k]) * (now[k] - last[k]);
  if (!(square > SLAVE_EDGE * SLAVE_EDGE)) return;
  s->input_flags[i] |= SLAVE_TURNED;
  slave_log(
      s, SLAVE_WARNING,
      "At %.6g s the normal of the answer '%s' jumped from (%.3g, %.3g, %.3g) to (%.3g, %.3g, %.3g), and with "
      "it the load of its wheel. A wheel that touches ground and edge bears on both: answer with the plane whose depth "
      "and normal are the sum of both depths along their normals, or take shorter communication steps. This is "
      "reported once.",
      ali3_time(s->fidelity.kernel), v[3].name, last[0], last[1], last[2], now[0], now[1], now[2]);
}

/* Height of the plane of the answer at i above the plane of the last one at a point, m. */
static double plane_rise(const slave *s, size_t i, const double *point) {
  const double *now = &s->value[i];
  double last[6], rise = 0.0; /* points and normals */
  for (size_t k = 0; k < 6; k++) last[k] = slave_reached_input(s, i + k);
  for (size_t k = 0; k < 3; k++) rise += last[3 + k] * (point[k] - last[k]) - now[3 + k] * (point[k] - now[k]);
  return rise;
}

/* Two tangent planes of a road give its curvature between them, and by that the error of each at the wheel: of the last
 * one at the end of its step, of the new one at the start of its own. */
static void check_bend(slave *s, size_t i) {
  const double *now = &s->value[i], *centre = &s->value[slave_the_table.variable[i].other];
  double bend = 0.0, square = 0.0, height = 0.0, distance = 0.0, lag = 0.0, path[3];
  for (size_t k = 0; k < 3; k++) {
    path[k] = now[k] - slave_reached_input(s, i + k);
    square += path[k] * path[k];
    bend += path[k] * (now[3 + k] - slave_reached_input(s, i + 3 + k));
  }
  if (s->completed.n == 0 || !(fabs(bend) > BEND || fabs(plane_rise(s, i, now)) > BEND) || !slave_compute_outputs(s))
    return;
  for (size_t k = 0; k < 3; k++) height += now[3 + k] * (centre[k] - now[k]);
  for (size_t k = 0; k < 3; k++) {
    const double along = centre[k] - now[k] - height * now[3 + k];
    distance += along * along;
    lag += along * path[k];
  }
  const double miss = 0.5 * bend * fmin(distance / square, MAX_RATIO), end = miss - plane_rise(s, i, centre);
  /* a linear change between two planes misses a quarter, in the middle; loads have 0.2 % error at 0.1 mm */
  const bool ramp = slave_is_ramp(s->slope, i);
  const double start = ramp ? 0.25 * miss : miss, limit = ramp ? 4.0 * BEND : BEND;
  if (!(fabs(end) + 0.25 * fabs(start) > limit)) return; /* the end of a step has more effect than its start */
  s->input_flags[i + 1] |= SLAVE_TURNED;
  slave_log(s, SLAVE_WARNING,
            "At %.6g s the answer on the road '%s' shows that the last one was off by %.2g mm at its wheel at the end "
            "of its step, and that it is off by %.2g mm itself%s; where the road goes on so, loads are off by 1 %% or "
            "more. It holds for %.1f steps ahead of its wheel, where 1 is best. Ask at the point ahead, with "
            "ports.road_lead = 1 where an answer holds in the step that follows the question, with 2 where all "
            "programs step at once, or take shorter communication steps; ports.road_lead is %g now. This is reported "
            "once.",
            ali3_time(s->fidelity.kernel), slave_the_table.variable[i].name, 1e3 * fabs(end), 1e3 * fabs(start),
            ramp ? " in the middle of its step" : "", 0.0 + nearbyint(-10.0 * lag / square) / 10.0,
            s->value[s->lead_reference]);
}

const slave_variable *slave_watch_jumps(slave *s) {
  const slave_table *t = &slave_the_table;
  const slave_variable *largest_jump = NULL;
  double largest = JUMP;
  for (size_t i = 0; i < t->n_known; i++) {
    const slave_variable *v = &t->variable[i];
    if (!slave_is_answer(i)) continue;
    if (!(s->input_flags[i] & SLAVE_TURNED)) check_turn(s, i);
    if (!(s->input_flags[i + 1] & SLAVE_TURNED)) check_bend(s, i);
    if (!(fabs(plane_rise(s, i, &s->value[i])) > JUMP) || !slave_compute_outputs(s)) continue;
    const double rise = plane_rise(s, i, &s->value[v->other]);
    if (fabs(rise) > largest) {
      largest = fabs(rise);
      largest_jump = v + 2;
    }
    if (!(fabs(rise) > JUMP) || s->input_flags[i] & SLAVE_JUMPED) continue;
    s->input_flags[i] |= SLAVE_JUMPED;
    slave_log(
        s, SLAVE_WARNING,
        "At %.6g s the answer '%s' = %.6g m with its normal lies %.3g m %s the plane of the last one, seen from "
        "its wheel, which is lifted or falls at once; its load is not that of a wheel on an edge. At an edge that "
        "a wheel touches the answer is the point of the edge and the normal towards the centre of the wheel. This "
        "is reported once.",
        ali3_time(s->fidelity.kernel), v[2].name, s->value[i + 2], fabs(rise), rise > 0.0 ? "above" : "below");
  }
  return largest_jump;
}
