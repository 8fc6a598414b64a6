/* Comparison of two motions of a System at samples: ranges, differences, and references of the differences.
 * mbs/results/comparison.py selects the compared values. */
#include <float.h>
#include <math.h>
#include <stdbool.h>

#include "../../include/ali3.h"

static const double PI = 3.141592653589793;
static const double STANDS = 0.01; /* the same of coordinates: rates and forces of what moves less are those of rest */
static const double NO_TURN = 1e-3; /* rad: a smaller turn counts only where nothing else moves, 1 mm at 1 m */

enum { KINDS = 4 }; /* of sizes in a unit: places and rates, loads, each always judged or not */

static int32_t group_of(const ali3_judged *what) {
  return what->unit * KINDS + (what->kind & ALI3_JUDGED_LOAD ? 2 : 0) + (what->kind & ALI3_JUDGED_ALWAYS ? 1 : 0);
}

/* The difference of two values; of angles the smaller arc. */
static double apart(const ali3_judged *what, double one, double other) {
  const double gap = fabs(one - other);
  return what->kind & ALI3_JUDGED_WRAPPED ? fabs(gap - 2.0 * PI * floor(gap / (2.0 * PI) + 0.5)) : gap;
}

static void see(const ali3_judged *what, double value, bool compared, ali3_compared *seen) {
  if (seen->samples > 0 && what->kind & ALI3_JUDGED_WRAPPED) {
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

void ali3_compare(const ali3_judged *what, int32_t n, int64_t rows, const double *time, const double *one,
                  const double *other, ali3_compared *seen) {
  for (int64_t row = 0; row < rows; row++)
    for (int32_t i = 0; i < n; i++) {
      see(what + i, other[row * n + i], one != NULL, seen + i);
      if (one == NULL) continue;
      seen[i].latest = apart(what + i, one[row * n + i], other[row * n + i]);
      if (!(seen[i].latest > seen[i].gap)) continue;
      seen[i].gap = seen[i].latest;
      if (time != NULL) seen[i].time = time[row];
    }
}

/* An angle that turns by more than a quarter from sample to sample is not followed. */
static bool follows(const ali3_compared *seen) { return seen->quickest <= 0.5 * PI; }

/* Sizes without those that a condition leaves out. */
static void leave_out(const ali3_judged *what, int32_t n, int32_t kind, double *size) {
  for (int32_t i = 0; i < n; i++)
    if (!(what[i].kind & kind)) size[i] = 0.0;
}

void ali3_compared_sizes(const ali3_judged *what, int32_t n, const ali3_compared *seen, double length, double energy,
                         int32_t guided, double *size) {
  double largest[ALI3_JUDGED_COUNT * KINDS] = {0.0}, moved[ALI3_JUDGED_COUNT * KINDS] = {0.0};
  bool others = false, loads = true, moves = false;
  for (int32_t i = 0; i < n; i++) {
    const int32_t group = group_of(what + i);
    if (!follows(seen + i)) continue;
    largest[group] = fmax(largest[group], fmax(fabs(seen[i].least), fabs(seen[i].most)));
    moved[group] = fmax(moved[group], seen[i].most - seen[i].least);
  }
  for (int32_t i = 0; i < n; i++) {
    const int32_t group = group_of(what + i), unit = what[i].unit;
    const double most = unit == ALI3_JUDGED_M            ? length
                        : unit == ALI3_JUDGED_RAD        ? 1.0
                        : unit == ALI3_JUDGED_COORDINATE ? fmax(length, 1.0)
                                                         : HUGE_VAL;
    const double unseen = most < HUGE_VAL           ? DBL_EPSILON * most /* of coordinates: less is no motion */
                          : unit == ALI3_JUDGED_N   ? energy / length
                          : unit == ALI3_JUDGED_N_M ? energy
                                                    : 0.0;
    const double in_unit = fmax(largest[group], largest[group ^ 1]); /* beside large forces small ones are round-off */
    const double rest = fmax((unit == ALI3_JUDGED_COORDINATE ? STANDS : ALI3_STILL) * fmin(in_unit, most), unseen);
    size[i] = !(moved[group] > rest) || !follows(seen + i) ? 0.0
              : what[i].kind & ALI3_JUDGED_LOAD            ? largest[group]
                                                           : moved[group];
    others |= size[i] > 0.0 && what[i].kind & ALI3_JUDGED_ALWAYS && unit != ALI3_JUDGED_RAD;
  }
  for (int32_t i = 0; i < n; i++) {
    if (others && what[i].unit == ALI3_JUDGED_RAD && size[i] <= NO_TURN) size[i] = 0.0;
    if (!(size[i] > 0.0)) continue;
    loads &= (what[i].kind & ALI3_JUDGED_LOAD) != 0;
    moves |= what[i].kind & ALI3_JUDGED_PLACE && (!guided || seen[i].gap > ALI3_STILL * size[i]);
  }
  if (loads || moves) leave_out(what, n, ALI3_JUDGED_ALWAYS, size);
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
