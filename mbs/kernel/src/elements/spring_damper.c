/* Linear spring and damper between two points, with optional end stops (end_stops.h, linear or progressive). The
 * signals are d = p2 - p1, earth axes; with l = |d| the tension T = k (l - l0) + c l' + stops pulls the points
 * together: the force conjugate to d is -T d/l. */
#include "element.h"
#include "end_stops.h"
#include "line_force.h"
#include "spring_damper_fields.h"

/* Their data follow the others. */
static int has_progressive_stops(int32_t nreal) { return nreal > SPRING_DAMPER_REALS; }

static void evaluate(ali3_element_args *a) {
  const real *p = a->real;
  const real k = p[STIFFNESS] * p[STIFFNESS_FACTOR];
  const real c = p[DAMPING] * p[DAMPING_FACTOR];
  const ali3_line line = ali3_line_at(a);
  const real stretch = line.length - p[FREE_LENGTH];
  ali3_tension t = {.elastic = k * stretch, .stiffness = k, .damping = c, .potential = 0.5 * k * stretch * stretch};
  ali3_end_stops_at(p + STOPS, has_progressive_stops(a->nreal), line.length, line.rate, &t);
  const real tension = t.elastic + c * line.rate + t.lost;
  ali3_line_force(a, &line, tension, t.stiffness, t.damping);
  a->potential = t.potential;
  a->piece = t.piece;
  a->out[SPRING_DAMPER_OUT_LENGTH] = line.length;
  a->out[SPRING_DAMPER_OUT_FORCE] = tension;
  a->out[SPRING_DAMPER_OUT_RATE] = line.rate;
  a->out[SPRING_DAMPER_OUT_DAMPER_FORCE] = c * line.rate;
}

#ifndef ALI3_WIDTH
static void evaluate_discrete(ali3_element_args *a) {
  const double *p = a->real;
  const double k = p[STIFFNESS] * p[STIFFNESS_FACTOR];
  const double c = p[DAMPING] * p[DAMPING_FACTOR];
  const ali3_line line = ali3_line_between(a);
  if (line.length <= ALI3_MIN_LENGTH) return;
  ali3_tension t = {.elastic = k * (line.length - p[FREE_LENGTH]), .stiffness = k, .damping = c};
  ali3_end_stops_between(p + STOPS, has_progressive_stops(a->nreal), line.start, line.end, line.rate, &t);
  ali3_line_force(a, &line, t.elastic + c * line.rate, t.stiffness, t.damping);
}

static bool is_lossy(const double *real, int32_t nreal, const int32_t *integer) {
  (void)integer;
  const double *loss = real + STOPS + ALI3_STOP_LOSS;
  return real[DAMPING] * real[DAMPING_FACTOR] != 0.0 ||
         (has_progressive_stops(nreal) && (loss[0] != 0.0 || loss[1] != 0.0));
}

static bool is_beyond_stop(const double *real, const double *out) {
  return ali3_end_stops_beyond(real + STOPS, out[0]);
}

/* The onset of progressive stops has no kink and is not an event. */
static double find_event(const double *real, int32_t nreal, const double *from, const double *to, double h) {
  if (has_progressive_stops(nreal)) return 1.0;
  return ali3_end_stops_event(real + STOPS, (double[]){from[0], to[0]}, (double[]){from[2], to[2]}, h);
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint) {
  (void)nsig, (void)integer, (void)nint;
  return has_progressive_stops(nreal) ? ali3_end_stops_check(real + STOPS) : 0;
}

const ali3_element_type ali3_spring_damper = {
    ALI3_SPRING_DAMPER,   .evaluate = evaluate, .discrete = evaluate_discrete,
    .conservative = true, .lossy = is_lossy,    .stops = is_beyond_stop,
    .first_force = 1,     .n_forces = 1,        .event = find_event,
    .check = check,
};
#endif
