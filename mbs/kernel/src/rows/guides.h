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

bool ali3_guide_filters(int32_t type);
double ali3_guide_demand(const ali3_instance *in, int32_t g, const double *input);
double ali3_guide_held(const ali3_instance *in, int32_t g, double demand);
double ali3_guide_slope(const ali3_instance *in, int32_t g, const double *s);
const char *ali3_guide_check(int32_t type, const double *real, int32_t nreal);
void ali3_guides_measure(ali3_instance *in);
double ali3_guides_until(const ali3_instance *in, double t, double end);
double ali3_guides_break(const ali3_instance *in, double t, double end);
void ali3_guides_start(const ali3_instance *in, ali3_vectors *v, double t);
void ali3_guides_time(const ali3_instance *in, ali3_vectors *v, double t);
void ali3_guides_step(const ali3_instance *in, const ali3_vectors *from, ali3_vectors *to, double t, double h);
#endif
