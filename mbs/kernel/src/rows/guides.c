/* Guides s(t): polynomial pieces of time, or an input through a critically damped filter of second order. */
#include <math.h>
#include <string.h>

#include "../algebra/elementary.h"
#include "../instance.h"
#include "guides.h"

const char *ali3_guide_check(int32_t type, const double *real, int32_t nreal) {
  if (type == ALI3_GUIDE_OF_INPUT) {
    if (nreal != 3) return "a filtered guide has three numbers: frequency, gain, start";
    return real[0] > 0.0 ? NULL : "the frequency of a filtered guide must be positive";
  }
  const double n = nreal > 0 ? real[0] : 0.0;
  if (!(n >= 1.0 && n <= 1e6) || n != floor(n) || nreal != 2 + 7 * (int32_t)n)
    return "a guide of time needs its number of pieces, the breaks and six coefficients a piece";
  for (int32_t i = 0; i < (int32_t)n; i++)
    if (!(real[1 + i] < real[2 + i])) return "the breaks of a guide of time must ascend";
  return NULL;
}

/* Value and rates at time t; outside the breaks the end values at rest. */
static void guide_of_time(const double *real, double t, double *s, double *sd, double *sdd) {
  const int32_t n = (int32_t)real[0];
  const double *breaks = real + 1;
  const bool inside = t >= breaks[0] && t <= breaks[n];
  int32_t low = 0, high = n;
  const double time = t < breaks[0] ? breaks[0] : (t > breaks[n] ? breaks[n] : t);
  while (high - low > 1) {
    const int32_t middle = (low + high) / 2;
    if (breaks[middle] <= time)
      low = middle;
    else
      high = middle;
  }
  const double *c = breaks + n + 1 + 6 * low, x = time - breaks[low];
  *s = ((((c[5] * x + c[4]) * x + c[3]) * x + c[2]) * x + c[1]) * x + c[0];
  *sd = inside ? (((5.0 * c[5] * x + 4.0 * c[4]) * x + 3.0 * c[3]) * x + 2.0 * c[2]) * x + c[1] : 0.0;
  *sdd = inside ? ((20.0 * c[5] * x + 12.0 * c[4]) * x + 6.0 * c[3]) * x + 2.0 * c[2] : 0.0;
}

/* Guides of time at t; filtered ones stay. */
void ali3_guides_time(const ali3_instance *in, ali3_vectors *v, double t) {
  const ali3_system *S = in->system;
  for (int32_t g = 0; g < S->size.ng; g++)
    if (S->guide_type[g] == ALI3_GUIDE_OF_TIME)
      guide_of_time(in->guide_real + S->guide_real_ptr[g], t, &v->s[g], &v->sd[g], &v->sdd[g]);
}

void ali3_guides_start(const ali3_instance *in, ali3_vectors *v, double t) {
  const ali3_system *S = in->system;
  for (int32_t g = 0; g < S->size.ng; g++) {
    if (S->guide_type[g] == ALI3_GUIDE_OF_TIME) continue;
    v->s[g] =
        in->guide_real[S->guide_real_ptr[g] + 1] * in->input[S->guide_input[g]]; /* at rest where its input holds it */
    v->sd[g] = v->sdd[g] = 0.0;
  }
  ali3_guides_time(in, v, t);
}

void ali3_guides_step(const ali3_instance *in, const ali3_vectors *from, ali3_vectors *to, double t, double h) {
  const ali3_system *S = in->system;
  ali3_guides_time(in, to, t);
  for (int32_t g = 0; g < S->size.ng; g++) {
    if (S->guide_type[g] == ALI3_GUIDE_OF_TIME) continue;
    /* exact solution of s'' = w^2 (gain u - s) - 2 w s' for an input that goes straight from its last value to this
     * one; held over the step it would lead by h/2, which is an error of first order */
    const double *real = in->guide_real + S->guide_real_ptr[g];
    const double w = real[0], target = real[1] * in->input[S->guide_input[g]],
                 before = real[1] * in->input_begin[S->guide_input[g]], slope = (target - before) / h,
                 lag = 2.0 * slope / w;
    const double e = from->s[g] - before + lag, rate = from->sd[g] - slope + w * e, decay = ali3_exp(-w * h);
    to->s[g] = target - lag + (e + rate * h) * decay;
    to->sd[g] = slope + (from->sd[g] - slope - w * rate * h) * decay;
    to->sdd[g] = w * w * (target - to->s[g]) - 2.0 * w * to->sd[g];
  }
}
