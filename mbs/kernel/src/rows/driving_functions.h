/* Driving functions s(t) of rows. */
#ifndef ALI3_DRIVING_FUNCTIONS_H
#define ALI3_DRIVING_FUNCTIONS_H
#include "../instance.h"

enum { /* guide_type of a System file; `DrivingFunctionType` in Python is read from here */
       ALI3_DRIVING_OF_TIME = 0, /* polynomial pieces of time */
       ALI3_DRIVING_OF_INPUT,    /* an input through a critically damped filter, with a state of its own */
       ALI3_DRIVING_OF_TWO_INPUTS, /* the sum of two inputs, held between two limits, through the same filter */
       ALI3_DRIVING_BY_TABLE,      /* a curve over an earlier driving function that is not by a table itself */
       ALI3_DRIVING_TYPE_COUNT
};

/* Whether a driving function of this type is one or two inputs through a filter. */
bool ali3_driving_filters(int32_t type);
/* Unlimited demand of the inputs (nu) of filtered driving function g: gain times input, or the sum of two. */
double ali3_driving_demand(const ali3_instance *in, int32_t g, const double *input);
/* A demand clamped to the limits of its driving function. */
double ali3_driving_clamped(const ali3_instance *in, int32_t g, double demand);
/* ds/du of driving function g, which is a table over driving function u; s (ng): values of driving functions. */
double ali3_driving_slope(const ali3_instance *in, int32_t g, const double *s);
/* NULL, or what is wrong with the numbers of a driving function. */
const char *ali3_driving_check(int32_t type, const double *real, int32_t nreal);
/* Measures the ranges of each driving function of time, its rate and acceleration, and writes the smallest departures
 * and jumps that count to in->driving.least. */
void ali3_driving_measure(ali3_instance *in);
/* The first break of a driving function of time after t and before `end`, otherwise `end`; s. */
double ali3_driving_until(const ali3_instance *in, double t, double end);
/* The first such break at which rate or acceleration of the driving function jump. */
double ali3_driving_break(const ali3_instance *in, double t, double end);
/* End of the next part of a step from t to `end`, s: `end` if values and rates of the driving functions of time there
 * tell what they are at quarters of their pieces in between, and with `by_means` their way and mean; otherwise a
 * quarter of a piece up to which they nearly do. Times within `near` of t and `end` do not count. */
double ali3_driving_resolved(const ali3_instance *in, double t, double end, double near, bool by_means);
/* Writes driving functions and their rates at the start to v: filtered ones rest where their inputs hold them. */
void ali3_driving_start(const ali3_instance *in, ali3_vectors *v, double t);
/* Evaluates driving functions of time and tables at t, s, in v; filtered ones keep their values. */
void ali3_driving_time(const ali3_instance *in, ali3_vectors *v, double t);
/* Writes driving functions and their rates at the end of a step of h to time t, s, to `to`; filtered ones by the exact
 * solution for inputs that change linearly from in->inputs.begin to in->inputs.set. */
void ali3_driving_step(const ali3_instance *in, const ali3_vectors *from, ali3_vectors *to, double t, double h);
#endif
