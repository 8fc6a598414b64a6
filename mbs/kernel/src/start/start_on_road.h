/* A start on roads from files, and the slope of the roads that a scene touches. */
#ifndef ALI3_START_ON_ROAD_H
#define ALI3_START_ON_ROAD_H
#include "../instance.h"

void ali3_start_on_road(ali3_instance *in);
bool ali3_lower_to_road(ali3_instance *in); /* to the first touch; false: something touches, or nothing can */
/* The rate at which what touches a road must rise to stay as deep where the scene moves at `rate` (nq): the mean, and
 * the most less the least of them in *spread. q (nq): to work in. */
double ali3_climb(const ali3_instance *in, const double *rate, double *q, double *spread);
#endif
