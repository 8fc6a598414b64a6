/* Comparison of two motions of a System at samples: ranges, differences, and references of the differences.
 * mbs/results/comparison.py selects the compared values. */
#include <float.h>
#include <math.h>
#include <stdbool.h>

#include "../../include/ali3.h"

static const double PI = 3.141592653589793;
static const double STANDS = 0.01; /* of the largest coordinate: with a smaller motion the System is at rest */

enum { KINDS = 4 }; /* groups in each unit: positions and rates, or loads; each always judged or not */

/* Number of the group whose values are judged together. */
static int32_t group_of(const ali3_judged *judged) {
  return judged->unit * KINDS + (judged->kind & ALI3_JUDGED_LOAD ? 2 : 0) + (judged->kind & ALI3_JUDGED_ALWAYS ? 1 : 0);
}

/* Absolute difference of two values; of angles the smaller arc. */
static double difference(const ali3_judged *judged, double one, double other) {
  const double gap = fabs(one - other);
  return judged->kind & ALI3_JUDGED_WRAPPED ? fabs(gap - 2.0 * PI * floor(gap / (2.0 * PI) + 0.5)) : gap;
}

/* Adds a value of the finer motion; of angles whole turns are counted. */
static void update(const ali3_judged *judged, double value, bool compared, ali3_compared *seen) {
  if (seen->samples > 0 && judged->kind & ALI3_JUDGED_WRAPPED) {
    const double turn = value - seen->last, whole = floor(turn / (2.0 * PI) + 0.5);
    seen->turns -= whole;
    if (compared && seen->in_turn > 0) seen->quickest = fmax(seen->quickest, fabs(turn - 2.0 * PI * whole));
  }
  seen->last = value;
  value += 2.0 * PI * seen->turns;
  seen->least = seen->samples > 0 ? fmin(seen->least, value) : value;
  seen->most = seen->samples > 0 ? fmax(seen->most, value) : value;
  seen->samples++;
  seen->in_turn = compared ? seen->in_turn + 1 : 0;
}

void ali3_compare(const ali3_judged *judged, int32_t n, int64_t rows, const double *time, const double *one,
                  const double *other, ali3_compared *seen) {
  for (int64_t row = 0; row < rows; row++)
    for (int32_t i = 0; i < n; i++) {
      const double finer = judged[i].factor * other[row * n + i];
      update(judged + i, finer, one != NULL, seen + i);
      if (one == NULL) continue;
      seen[i].latest = difference(judged + i, judged[i].factor * one[row * n + i], finer);
      if (!(seen[i].latest > seen[i].gap)) continue;
      seen[i].gap = seen[i].latest;
      if (time != NULL) seen[i].time = time[row];
    }
}

/* Whether an angle can be followed: it changes by at most a quarter turn between samples. */
static bool is_followed(const ali3_compared *seen) { return seen->quickest <= 0.5 * PI; }

/* Sets sizes of values without a flag to 0. */
static void clear_sizes(const ali3_judged *judged, int32_t n, int32_t kind, double *size) {
  for (int32_t i = 0; i < n; i++)
    if (!(judged[i].kind & kind)) size[i] = 0.0;
}

void ali3_compared_sizes(const ali3_judged *judged, int32_t n, const ali3_compared *seen, double length, double energy,
                         int32_t exclude_prescribed, double *size) {
  double largest[ALI3_JUDGED_COUNT * KINDS] = {0.0}, range[ALI3_JUDGED_COUNT * KINDS] = {0.0};
  double moved[ALI3_JUDGED_COUNT * KINDS] = {0.0}; /* by how much places of the other motion are off */
  bool others_move = false, only_loads = true, positions_differ = false;
  for (int32_t i = 0; i < n; i++) {
    const int32_t group = group_of(judged + i);
    if (!is_followed(seen + i)) continue;
    largest[group] = fmax(largest[group], fmax(fabs(seen[i].least), fabs(seen[i].most)));
    range[group] = fmax(range[group], seen[i].most - seen[i].least);
    if (judged[i].kind & ALI3_JUDGED_PLACE) moved[group] = fmax(moved[group], seen[i].gap);
  }
  for (int32_t i = 0; i < n; i++) {
    const int32_t group = group_of(judged + i), unit = judged[i].unit;
    const double limit = unit == ALI3_JUDGED_M            ? length
                         : unit == ALI3_JUDGED_RAD        ? 1.0
                         : unit == ALI3_JUDGED_COORDINATE ? fmax(length, 1.0)
                                                          : HUGE_VAL;
    const double resolution = limit < HUGE_VAL ? DBL_EPSILON * limit /* of coordinates: below it there is no motion */
                              : unit == ALI3_JUDGED_N     ? energy / length
                              : unit == ALI3_JUDGED_N_M   ? energy
                              : unit == ALI3_JUDGED_PA    ? energy / (length * length * length)
                              : unit == ALI3_JUDGED_RAD_S ? ALI3_REST_SPEED / length
                                                          : ALI3_REST_SPEED;
    const double in_unit = fmax(largest[group], largest[group ^ 1]); /* small forces beside large ones are round-off */
    const double rest = fmax((unit == ALI3_JUDGED_COORDINATE ? STANDS : ALI3_STILL) * fmin(in_unit, limit), resolution);
    /* places that rest in this motion, and not in the other, are compared with their way in that one */
    const double way = range[group] > rest ? range[group] : moved[group];
    size[i] = !(way > rest) || !is_followed(seen + i) ? 0.0 : judged[i].kind & ALI3_JUDGED_LOAD ? largest[group] : way;
    others_move |= size[i] > 0.0 && judged[i].kind & ALI3_JUDGED_ALWAYS && unit != ALI3_JUDGED_RAD;
  }
  for (int32_t i = 0; i < n; i++) {
    /* rotations of which a difference that agrees is rest, 1 mm at 1 m, count only where nothing else moves */
    if (others_move && judged[i].unit == ALI3_JUDGED_RAD && ALI3_AGREED * size[i] <= ALI3_STILL) size[i] = 0.0;
    if (!(size[i] > 0.0)) continue;
    only_loads &= (judged[i].kind & ALI3_JUDGED_LOAD) != 0;
    positions_differ |=
        judged[i].kind & ALI3_JUDGED_PLACE && (!exclude_prescribed || seen[i].gap > ALI3_STILL * size[i]);
  }
  if (only_loads || positions_differ) clear_sizes(judged, n, ALI3_JUDGED_ALWAYS, size);
}

double ali3_compared_error(int32_t n, const ali3_compared *seen, const double *size, int32_t latest, int32_t *worst) {
  double error = 0.0;
  *worst = -1;
  for (int32_t i = 0; i < n; i++) {
    const double gap = latest ? seen[i].latest : seen[i].gap;
    if (!(size[i] > 0.0 && gap > error * size[i])) continue;
    error = gap / size[i];
    *worst = i;
  }
  return error;
}
