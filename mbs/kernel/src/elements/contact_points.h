/* Points of a body that touch a road. */
#ifndef ALI3_CONTACT_POINTS_H
#define ALI3_CONTACT_POINTS_H
#include "element.h"

enum { ALI3_CONTACT_HEAD = 13, ALI3_CONTACT_STATES = 4 }; /* reals before the points; states of each point */

/* By discrete gradients, see discrete_gradient.c. */
void ali3_contact_points_discrete(ali3_element_args *a);
#endif
