/* Spring and damper between two points, each by a number or by a table, with optional end stops: as spring_damper.c
 * with the tension T = Fk(l - l0) + Fc(l') + stops. The points of the tables follow the numbers, by columns: of the
 * spring stretch from the free length m, tension N, slope N/m, energy from stretch 0 J; of the damper rate m/s, tension
 * N, slope N s/m. Without points the number applies. */
#include <stddef.h>

#include "cubic_table.h"
#include "element.h"
#include "end_stops.h"
#include "line_force.h"
#include "spring_damper_table_fields.h"

/* Tension, N, over the stretch, m, with energies. */
static ali3_cubic_table read_spring_table(const double *real, const int32_t *integer) {
  return ali3_cubic_table_at(real + SPRING_DAMPER_TABLE_REALS, integer[SPRING_POINTS], 1);
}

/* Tension, N, over the rate, m/s. */
static ali3_cubic_table read_damper_table(const double *real, const int32_t *integer) {
  const double *spring = real + SPRING_DAMPER_TABLE_REALS;
  const int32_t columns = spring_damper_table_integers[SPRING_POINTS].reals;
  return ali3_cubic_table_at(spring + columns * (int64_t)integer[SPRING_POINTS], integer[DAMPER_POINTS], 0);
}

/* Tension of the damper, N; adds its slope to t->damping. */
static double add_damper(const ali3_element_args *a, double rate, ali3_tension *t) {
  const double *p = a->real, factor = p[DAMPING_FACTOR];
  double slope = p[DAMPING], force = p[DAMPING] * rate;
  if (a->integer[DAMPER_POINTS] > 0) {
    const ali3_cubic_table table = read_damper_table(p, a->integer);
    force = ali3_cubic_value(&table, rate, &slope, NULL);
  }
  t->damping += factor * slope;
  return factor * force;
}

/* Tension, stiffness and energy of the spring. */
static void add_spring(const ali3_element_args *a, double stretch, ali3_tension *t) {
  const double *p = a->real, factor = p[STIFFNESS_FACTOR];
  double slope = p[STIFFNESS], force = slope * stretch, energy = 0.0;
  if (a->integer[SPRING_POINTS] > 0) {
    const ali3_cubic_table table = read_spring_table(p, a->integer);
    force = ali3_cubic_value(&table, stretch, &slope, &energy);
  } else {
    energy = 0.5 * slope * stretch * stretch;
  }
  t->elastic += factor * force;
  t->stiffness += factor * slope;
  t->potential += factor * energy;
}

/* Mean tension over a step; its slope by the length at the middle of the step. */
static void add_mean_spring(const ali3_element_args *a, double x0, double x1, ali3_tension *t) {
  const double *p = a->real, factor = p[STIFFNESS_FACTOR];
  double slope = p[STIFFNESS], mean = slope * 0.5 * (x0 + x1);
  if (a->integer[SPRING_POINTS] > 0) {
    const ali3_cubic_table table = read_spring_table(p, a->integer);
    mean = ali3_cubic_mean(&table, x0, x1);
    const double end = ali3_cubic_value(&table, x1, &slope, NULL);
    if (fabs(x1 - x0) > 1e-6 * (fabs(x0) + fabs(x1))) slope = 2.0 * (end - mean) / (x1 - x0);
  }
  t->elastic += factor * mean;
  t->stiffness += factor * slope;
}

static void evaluate(ali3_element_args *a) {
  const double *p = a->real;
  const ali3_line line = ali3_line_at(a);
  ali3_tension t = {0};
  add_spring(a, line.length - p[FREE_LENGTH], &t);
  const double damper_tension = add_damper(a, line.rate, &t);
  ali3_end_stops_at(p + STOPS, 1, line.length, line.rate, &t);
  const double tension = t.elastic + damper_tension + t.lost;
  ali3_line_force(a, &line, tension, t.stiffness, t.damping);
  a->potential = t.potential;
  a->piece = t.piece;
  a->out[SPRING_DAMPER_TABLE_OUT_LENGTH] = line.length;
  a->out[SPRING_DAMPER_TABLE_OUT_FORCE] = tension;
  a->out[SPRING_DAMPER_TABLE_OUT_RATE] = line.rate;
  a->out[SPRING_DAMPER_TABLE_OUT_DAMPER_FORCE] = damper_tension;
}

static void evaluate_discrete(ali3_element_args *a) {
  const double *p = a->real;
  const ali3_line line = ali3_line_between(a);
  if (line.length <= ALI3_MIN_LENGTH) return;
  ali3_tension t = {0};
  add_mean_spring(a, line.start - p[FREE_LENGTH], line.end - p[FREE_LENGTH], &t);
  const double damper_tension = add_damper(a, line.rate, &t);
  ali3_end_stops_between(p + STOPS, 1, line.start, line.end, line.rate, &t);
  ali3_line_force(a, &line, t.elastic + damper_tension, t.stiffness, t.damping);
}

static bool is_lossy(const double *real, int32_t nreal, const int32_t *integer) {
  (void)nreal;
  const double *loss = real + STOPS + ALI3_STOP_LOSS;
  const bool damper_tension = integer[DAMPER_POINTS] > 0 || real[DAMPING] != 0.0;
  return (damper_tension && real[DAMPING_FACTOR] != 0.0) || loss[0] != 0.0 || loss[1] != 0.0;
}

static bool is_beyond_stop(const double *real, const double *out) {
  return ali3_end_stops_beyond(real + STOPS, out[0]);
}

/* The table of a damper does not fall: it hides nothing between two rates. */
static double find_resolved_way(const double *real, const int32_t *integer, double from, double to, double share,
                                double largest) {
  const double free_length = real[FREE_LENGTH], factor = real[STIFFNESS_FACTOR];
  if (integer[SPRING_POINTS] == 0 || factor == 0.0) return 1.0;
  const ali3_cubic_table table = read_spring_table(real, integer);
  return ali3_cubic_resolved(&table, from - free_length, to - free_length, share, largest / factor);
}

/* A damper never supplies energy: its force must not decrease with the rate and is 0 at rest. */
static const char *check_damper(const ali3_cubic_table *t) {
  double slope;
  for (int32_t i = 0; i < t->n; i++)
    if (t->slope[i] < 0.0 || (i > 0 && t->y[i] < t->y[i - 1])) return "the force of a damper's table must not fall";
  return ali3_cubic_value(t, 0.0, &slope, NULL) == 0.0 ? 0 : "the table of a damper must pass through the origin";
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint) {
  (void)nsig, (void)nreal;
  for (int32_t i = 0; i < nint; i++)
    if (integer[i] == 1) return "a table of a spring-damper needs two points at least";
  const ali3_cubic_table spring = read_spring_table(real, integer), damper = read_damper_table(real, integer);
  if (!(ali3_cubic_rises(&spring) && ali3_cubic_rises(&damper)))
    return "the first column of a table of a spring-damper must rise";
  if (spring.n > 0 && !ali3_cubic_integrals_fit(&spring))
    return "the energies in the table of a spring are not those of its forces";
  const char *error = damper.n > 0 ? check_damper(&damper) : 0;
  return error != 0 ? error : ali3_end_stops_check(real + STOPS);
}

const ali3_element_type ali3_spring_damper_table = {
    ALI3_SPRING_DAMPER_TABLE,
    .evaluate = evaluate,
    .discrete = evaluate_discrete,
    .conservative = true,
    .lossy = is_lossy,
    .stops = is_beyond_stop,
    .first_force = 1,
    .n_forces = 1,
    .check = check,
    .resolved = find_resolved_way,
};
