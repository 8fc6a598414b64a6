/* Spring and damper on one signal: torsional spring on an angle, or a spring along a coordinate.
 * Reals: stiffness, damping, free value, constant force; then two factors or none. Outputs: generalised force (N or N m). */
#include "element.h"

enum { STIFFNESS, DAMPING, FREE_VALUE, CONSTANT, PLAIN, STIFFNESS_FACTOR = PLAIN, DAMPING_FACTOR, REALS };

static double factor(const double *real, int32_t nreal, int which) { return nreal == REALS ? real[which] : 1.0; }

static void evaluate(ali3_element_args *a) {
  const double *p = a->real;
  const double k = p[STIFFNESS] * factor(p, a->nreal, STIFFNESS_FACTOR);
  const double c = p[DAMPING] * factor(p, a->nreal, DAMPING_FACTOR);
  const double stretch = a->u[0] - p[FREE_VALUE];
  a->f[0] = p[CONSTANT] - k * stretch - c * a->ud[0];
  a->out[0] = a->f[0];
  a->potential = 0.5 * k * stretch * stretch - p[CONSTANT] * stretch;
  if (a->S) a->S[0] = a->wK * k + a->wC * c;
}

static bool lossy(const double *real, int32_t nreal, const int32_t *integer) {
  (void)integer;
  return real[DAMPING] * factor(real, nreal, DAMPING_FACTOR) != 0.0;
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)nsig, (void)integer, (void)nint, (void)n_inputs, (void)n_roads;
  if (nreal != PLAIN && nreal != REALS) return "a spring-damper on one signal has 4 numbers, and two factors or none";
  if (factor(real, nreal, STIFFNESS_FACTOR) < 0.0 || factor(real, nreal, DAMPING_FACTOR) < 0.0)
    return "the factors of a spring-damper must not be negative";
  return 0;
}

const ali3_element_type ali3_scalar_spring_damper = {
    .evaluate = evaluate,
    .conservative = true,
    .lossy = lossy,
    .nsig = 1,
    .nreal = -1,
    .nout = 1,
    .check = check,
};
