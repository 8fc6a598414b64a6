/* Start on roads from files, and the slope of the roads under a scene. */
#ifndef ALI3_START_ON_ROAD_H
#define ALI3_START_ON_ROAD_H
#include "../instance.h"

/* Moves a start on a road of unknown height vertically until no part that touches the road in the drawing is deeper in
 * it than there; sets in->start.lift and in->start.uneven. */
void ali3_start_on_road(ali3_instance *in);
/* Lowers the scene to its first contact; false: an element touches already, or none can. */
bool ali3_lower_to_road(ali3_instance *in);
/* Mean vertical velocity, m/s, at which the touching elements must rise to keep their depth while the scene moves at
 * `rate` (nq); *spread: largest minus smallest of them. q (nq): work array. */
double ali3_climb(const ali3_instance *in, const double *rate, double *q, double *spread);
#endif
