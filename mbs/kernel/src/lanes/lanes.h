/* Groups of instances: memory and copies. */
#ifndef ALI3_LANES_H
#define ALI3_LANES_H
#include "group.h"

size_t ali3_group_bytes(const ali3_system *s, int32_t width);
void ali3_group_place(ali3_lane_group *group, void *block);
void ali3_group_parameters(ali3_lane_group *group);
void ali3_group_from(ali3_lane_group *group);
void ali3_group_to(const ali3_lane_group *group);
#endif
