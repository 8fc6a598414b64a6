/* Driving functions s(t): polynomial pieces in time; an input or a sum of two, filtered by a critically damped
 * system of second order; or a curve over another driving function. */
#include <math.h>
#include <string.h>

#include "../algebra/elementary.h"
#include "../elements/cubic_table.h"
#include "../instance.h"
#include "driving_functions.h"

/* Reals of a filtered driving function: frequency, gain and start; of two inputs also the gain of the second one and
 * limits. */
enum { GAIN = 1, GAIN_2 = 3, LOW, HIGH };

bool ali3_driving_filters(int32_t type) { return type == ALI3_DRIVING_OF_INPUT || type == ALI3_DRIVING_OF_TWO_INPUTS; }

double ali3_driving_demand(const ali3_instance *in, int32_t g, const double *input) {
  const ali3_system *S = in->system;
  const double *real = in->parameters.guide_parameter + S->guide_parameter_ptr[g];
  const double first = real[GAIN] * input[S->guide_input[g]];
  return S->guide_type[g] == ALI3_DRIVING_OF_INPUT ? first : first + real[GAIN_2] * input[S->guide_second[g]];
}

double ali3_driving_clamped(const ali3_instance *in, int32_t g, double demand) {
  const double *real = in->parameters.guide_parameter + in->system->guide_parameter_ptr[g];
  if (in->system->guide_type[g] == ALI3_DRIVING_OF_INPUT) return demand;
  return demand < real[LOW] ? real[LOW] : demand > real[HIGH] ? real[HIGH] : demand;
}

/* Value to which a filtered driving function tends at given inputs. */
static double target_of(const ali3_instance *in, int32_t g, const double *input) {
  return ali3_driving_clamped(in, g, ali3_driving_demand(in, g, input));
}

/* Table of a driving function over another one: points, values and slopes by columns. */
static ali3_cubic_table make_table(const double *real, int32_t nreal) {
  return ali3_cubic_table_at(real, nreal / 3, 0);
}

double ali3_driving_slope(const ali3_instance *in, int32_t g, const double *s) {
  const int32_t *at = in->system->guide_parameter_ptr + g;
  const ali3_cubic_table table = make_table(in->parameters.guide_parameter + at[0], at[1] - at[0]);
  double slope;
  ali3_cubic_value(&table, s[in->system->guide_input[g]], &slope, NULL);
  return slope;
}

const char *ali3_driving_check(int32_t type, const double *real, int32_t nreal) {
  if (type == ALI3_DRIVING_BY_TABLE) {
    if (nreal < 6 || nreal % 3 != 0)
      return "a driving function by a table needs two points or more, and a slope at each";
    const ali3_cubic_table table = make_table(real, nreal);
    return ali3_cubic_rises(&table) ? NULL : "the first column of the table of a driving function must rise";
  }
  if (type == ALI3_DRIVING_OF_INPUT) {
    if (nreal != 3) return "a filtered driving function has three numbers: frequency, gain, start";
    return real[0] > 0.0 ? NULL : "the frequency of a filtered driving function must be positive";
  }
  if (type == ALI3_DRIVING_OF_TWO_INPUTS) {
    if (nreal != 6)
      return "a filtered driving function of two inputs has six numbers: frequency, gain, start, gain, two limits";
    if (!(real[LOW] <= real[HIGH])) return "the lower limit of a driving function must not be above the upper one";
    return real[0] > 0.0 ? NULL : "the frequency of a filtered driving function must be positive";
  }
  const double n = nreal > 0 ? real[0] : 0.0;
  if (!(n >= 1.0 && n <= 1e6) || n != floor(n) || nreal != 2 + 7 * (int32_t)n)
    return "a driving function of time needs its number of pieces, the breaks and six coefficients a piece";
  for (int32_t i = 0; i < (int32_t)n; i++)
    if (!(real[1 + i] < real[2 + i])) return "the breaks of a driving function of time must ascend";
  return NULL;
}

/* Index of the piece of a driving function of time that contains a time within its breaks; at a break the piece after
 * it. */
static int32_t piece_at(const double *real, double time) {
  const double *breaks = real + 1;
  int32_t low = 0, high = (int32_t)real[0];
  while (high - low > 1) {
    const int32_t middle = (low + high) / 2;
    if (breaks[middle] <= time)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Value and rates of a piece, x seconds after its break. */
static void piece(const double *real, int32_t i, double x, double *s, double *sd, double *sdd) {
  const double *c = real + 2 + (int32_t)real[0] + 6 * i;
  *s = ((((c[5] * x + c[4]) * x + c[3]) * x + c[2]) * x + c[1]) * x + c[0];
  *sd = (((5.0 * c[5] * x + 4.0 * c[4]) * x + 3.0 * c[3]) * x + 2.0 * c[2]) * x + c[1];
  *sdd = ((20.0 * c[5] * x + 12.0 * c[4]) * x + 6.0 * c[3]) * x + 2.0 * c[2];
}

/* Value and rates of a driving function of time at t; outside its breaks it rests at its end values. */
static void driving_of_time(const double *real, double t, double *s, double *sd, double *sdd) {
  const int32_t n = (int32_t)real[0];
  const double *breaks = real + 1;
  const bool inside = t >= breaks[0] && t <= breaks[n];
  const double time = t < breaks[0] ? breaks[0] : (t > breaks[n] ? breaks[n] : t);
  const int32_t i = piece_at(real, time);
  piece(real, i, time - breaks[i], s, sd, sdd);
  if (!inside) *sd = *sdd = 0.0;
}

/* A jump of the rate or acceleration of a driving function of time, or a departure of its value from a cubic, counts
 * if it is larger than what would be wrong of their range, which is more than noise of samples, and than SAME times
 * their largest value, which is more than round-off. Parts depart by at most STRAIGHT of that, as with tables of
 * inputs. */
static const double SAME = 1e-9, STRAIGHT = 0.2;
enum { QUARTERS = 4 }; /* of a piece: its rates may be 0 at both ends and in the middle */

void ali3_driving_measure(ali3_instance *in) {
  const ali3_system *S = in->system;
  for (int32_t g = 0; g < S->size.ng; g++) {
    if (S->guide_type[g] != ALI3_DRIVING_OF_TIME) continue;
    const double *real = in->parameters.guide_parameter + S->guide_parameter_ptr[g];
    double least[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, most[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int32_t i = 0; i < (int32_t)real[0]; i++)
      for (int32_t part = 0; part <= QUARTERS; part++) {
        double value[3];
        piece(real, i, part * (real[2 + i] - real[1 + i]) / QUARTERS, &value[0], &value[1], &value[2]);
        for (int32_t k = 0; k < 3; k++) {
          least[k] = fmin(least[k], value[k]);
          most[k] = fmax(most[k], value[k]);
        }
      }
    for (int32_t k = 0; k < 3; k++)
      in->driving.least[3 * g + k] =
          fmax(ALI3_WRONG_ERROR * (most[k] - least[k]), SAME * fmax(fabs(most[k]), fabs(least[k])));
  }
}

/* Whether rate or acceleration of a driving function of time jump at break i; before the first and after the last it
 * rests. */
static bool jumps(const double *real, int32_t i, const double *least) {
  const int32_t n = (int32_t)real[0];
  double s, before[2] = {0.0, 0.0}, behind[2] = {0.0, 0.0};
  if (i > 0) piece(real, i - 1, real[1 + i] - real[i], &s, &before[0], &before[1]);
  if (i < n) piece(real, i, 0.0, &s, &behind[0], &behind[1]);
  return fabs(behind[0] - before[0]) > least[0] || fabs(behind[1] - before[1]) > least[1];
}

/* The first break after t and before `end` of all driving functions of time, otherwise `end`; with `all` false only
 * breaks that jump. */
static double first_break(const ali3_instance *in, double t, double end, bool all) {
  const ali3_system *S = in->system;
  for (int32_t g = 0; g < S->size.ng; g++) {
    if (S->guide_type[g] != ALI3_DRIVING_OF_TIME) continue;
    const double *real = in->parameters.guide_parameter + S->guide_parameter_ptr[g], *breaks = real + 1;
    const int32_t n = (int32_t)real[0];
    if (end <= breaks[0] || t >= breaks[n]) continue;
    for (int32_t i = t < breaks[0] ? 0 : piece_at(real, t) + 1; i <= n && breaks[i] < end; i++)
      if (breaks[i] > t && (all || jumps(real, i, in->driving.least + 3 * g + 1))) end = breaks[i];
  }
  return end;
}

/* The first time after t at which a piece of a driving function of time begins or ends, or a quarter of it. */
static double next_quarter(const double *real, double t) {
  const int32_t n = (int32_t)real[0];
  const double *breaks = real + 1;
  if (t < breaks[0]) return breaks[0];
  if (t >= breaks[n]) return HUGE_VAL;
  const int32_t i = piece_at(real, t);
  const double quarter = (breaks[i + 1] - breaks[i]) / QUARTERS;
  for (int32_t k = 1; k < QUARTERS; k++)
    if (breaks[i] + k * quarter > t) return breaks[i] + k * quarter;
  return breaks[i + 1];
}

/* Whether values and rates of a driving function of time at two times tell what it is in between, to `least`: at
 * quarters of pieces by the cubic through them; with `by_means` also its way by the mean of the rates, and the mean of
 * its values, to leading order. */
static bool resolved(const double *real, double from, double to, double least, bool by_means) {
  const double way = to - from;
  double s[2], rise[2], value, rate, unused;
  driving_of_time(real, from, &s[0], &rise[0], &unused);
  driving_of_time(real, to, &s[1], &rise[1], &unused);
  for (int32_t k = 0; k < 2; k++) rise[k] *= way;
  if (by_means && (fabs(s[1] - s[0] - 0.5 * (rise[0] + rise[1])) > least || fabs(rise[1] - rise[0]) / 12.0 > least))
    return false;
  for (double at = next_quarter(real, from); at < to; at = next_quarter(real, at)) {
    driving_of_time(real, at, &value, &rate, &unused);
    if (ali3_cubic_departure(s, rise, (at - from) / way, value) > least) return false;
  }
  return true;
}

double ali3_driving_resolved(const ali3_instance *in, double t, double end, double near, bool by_means) {
  const ali3_system *S = in->system;
  for (int32_t g = 0; g < S->size.ng; g++) {
    if (S->guide_type[g] != ALI3_DRIVING_OF_TIME) continue;
    const double *real = in->parameters.guide_parameter + S->guide_parameter_ptr[g], least = in->driving.least[3 * g];
    const double from = t + near, to = end - near;
    double part = next_quarter(real, from), next = part;
    if (part >= to || resolved(real, from, to, least, by_means)) continue;
    while ((next = next_quarter(real, next + near)) < to &&
           resolved(real, from, next - near, STRAIGHT * least, by_means))
      part = next;
    end = part;
  }
  return end;
}

double ali3_driving_until(const ali3_instance *in, double t, double end) { return first_break(in, t, end, true); }

double ali3_driving_break(const ali3_instance *in, double t, double end) { return first_break(in, t, end, false); }

/* s = f(u): s' = f' u' and s'' = f' u'' + f'' u'^2. */
static void driving_by_table(const ali3_instance *in, ali3_vectors *v, int32_t g) {
  const int32_t *at = in->system->guide_parameter_ptr + g, u = in->system->guide_input[g];
  const ali3_cubic_table table = make_table(in->parameters.guide_parameter + at[0], at[1] - at[0]);
  double slope, curvature;
  v->s[g] = ali3_cubic_derivatives(&table, v->s[u], &slope, &curvature);
  v->sd[g] = slope * v->sd[u];
  v->sdd[g] = slope * v->sdd[u] + curvature * v->sd[u] * v->sd[u];
}

void ali3_driving_time(const ali3_instance *in, ali3_vectors *v, double t) {
  const ali3_system *S = in->system;
  for (int32_t g = 0; g < S->size.ng; g++)
    if (S->guide_type[g] == ALI3_DRIVING_OF_TIME)
      driving_of_time(in->parameters.guide_parameter + S->guide_parameter_ptr[g], t, &v->s[g], &v->sd[g], &v->sdd[g]);
    else if (S->guide_type[g] == ALI3_DRIVING_BY_TABLE)
      driving_by_table(in, v, g);
}

void ali3_driving_start(const ali3_instance *in, ali3_vectors *v, double t) {
  const ali3_system *S = in->system;
  for (int32_t g = 0; g < S->size.ng; g++) {
    if (!ali3_driving_filters(S->guide_type[g])) continue;
    v->s[g] = target_of(in, g, in->inputs.set); /* at rest where its input holds it */
    v->sd[g] = v->sdd[g] = 0.0;
  }
  ali3_driving_time(in, v, t);
}

void ali3_driving_step(const ali3_instance *in, const ali3_vectors *from, ali3_vectors *to, double t, double h) {
  const ali3_system *S = in->system;
  for (int32_t g = 0; g < S->size.ng; g++) {
    if (!ali3_driving_filters(S->guide_type[g])) continue;
    /* exact solution of s'' = w^2 (gain u - s) - 2 w s' for an input that goes straight from its value at the start of
     * the step to that at its end; held at the end it would lead by h/2, which is an error of first order */
    const double *real = in->parameters.guide_parameter + S->guide_parameter_ptr[g];
    const double w = real[0], target = target_of(in, g, in->inputs.set), before = target_of(in, g, in->inputs.begin),
                 slope = (target - before) / h, lag = 2.0 * slope / w;
    const double e = from->s[g] - before + lag, rate = from->sd[g] - slope + w * e, decay = ali3_exp(-w * h);
    to->s[g] = target - lag + (e + rate * h) * decay;
    to->sd[g] = slope + (from->sd[g] - slope - w * rate * h) * decay;
    to->sdd[g] = w * w * (target - to->s[g]) - 2.0 * w * to->sd[g];
    in->driving.follows[g] = from->sd[g] != 0.0 || from->sdd[g] != 0.0 || to->sd[g] != 0.0 || to->sdd[g] != 0.0;
  }
  ali3_driving_time(in, to, t); /* last, as tables may depend on filtered driving functions */
}
