/* Groups of instances that advance together (group.h): memory and copies. */
#ifndef ALI3_LANES_H
#define ALI3_LANES_H
#include "group.h"

/* Bytes of memory of a group of `width` lanes. */
size_t ali3_group_bytes(const ali3_system *s, int32_t width);
/* Places the arrays of a group in a block of that size. */
void ali3_group_place(ali3_lane_group *g, void *block);
/* Copies the numbers that depend on parameters but not on steps to the group. */
void ali3_group_parameters(ali3_lane_group *g);
/* Copies the start of a step, in->now, and the driving functions of in->next to the group. */
void ali3_group_from(ali3_lane_group *g);
/* Copies the state and the counters after a step to the instances: in->next and, for rigid Systems, the mean
 * acceleration and the multipliers of Newton's iteration, before (25). */
void ali3_group_to(const ali3_lane_group *g);
#endif
