/* Guides of rows over time. */
#ifndef ALI3_GUIDES_H
#define ALI3_GUIDES_H
#include "../instance.h"

enum { /* guide_type of a System file; `GuideType` in Python is read from here */
       ALI3_GUIDE_OF_TIME = 0, /* polynomial pieces of time */
       ALI3_GUIDE_OF_INPUT,    /* an input through a critically damped filter, with a state of its own */
       ALI3_GUIDE_OF_TWO_INPUTS, /* the sum of two inputs, held between two limits, through the same filter */
       ALI3_GUIDE_BY_TABLE,      /* a curve over an earlier guide that is not by a table itself */
       ALI3_GUIDE_TYPE_COUNT
};

/* Whether a guide of this type is one or two inputs through a filter. */
bool ali3_guide_filters(int32_t type);
/* Unlimited demand of the inputs (nu) of filtered guide g: gain times input, or the sum of two. */
double ali3_guide_demand(const ali3_instance *in, int32_t g, const double *input);
/* A demand clamped to the limits of its guide. */
double ali3_guide_clamped(const ali3_instance *in, int32_t g, double demand);
/* ds/du of guide g, which is a table over guide u; s (ng): values of guides. */
double ali3_guide_slope(const ali3_instance *in, int32_t g, const double *s);
/* NULL, or what is wrong with the numbers of a guide. */
const char *ali3_guide_check(int32_t type, const double *real, int32_t nreal);
/* Measures the ranges of each guide of time, its rate and acceleration, and writes the smallest departures and jumps
 * that count to in->guide.abrupt. */
void ali3_guides_measure(ali3_instance *in);
/* The first break of a guide of time after t and before `end`, otherwise `end`; s. */
double ali3_guides_until(const ali3_instance *in, double t, double end);
/* The first such break at which rate or acceleration of the guide jump. */
double ali3_guides_break(const ali3_instance *in, double t, double end);
/* End of the next part of a step from t to `end`, s: `end` if values and rates of the guides of time there tell what
 * they are at quarters of their pieces in between, and with `by_means` their way and mean; otherwise a quarter of a
 * piece up to which they nearly do. Times within `near` of t and `end` do not count. */
double ali3_guides_resolved(const ali3_instance *in, double t, double end, double near, bool by_means);
/* Writes guides and their rates at the start to v: filtered ones rest where their inputs hold them. */
void ali3_guides_start(const ali3_instance *in, ali3_vectors *v, double t);
/* Evaluates guides of time and tables at t, s, in v; filtered ones keep their values. */
void ali3_guides_time(const ali3_instance *in, ali3_vectors *v, double t);
/* Writes guides and their rates at the end of a step of h to time t, s, to `to`; filtered ones by the exact solution
 * for inputs that change linearly from in->inputs.begin to in->inputs.set. */
void ali3_guides_step(const ali3_instance *in, const ali3_vectors *from, ali3_vectors *to, double t, double h);
#endif
