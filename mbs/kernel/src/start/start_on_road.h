/* A start on roads from files. */
#ifndef ALI3_START_ON_ROAD_H
#define ALI3_START_ON_ROAD_H
#include "../instance.h"

void ali3_start_on_road(ali3_instance *in);
#endif
