/* Contacts with a road that are too quick for the step. */
#ifndef ALI3_METHODS_COARSE_EVENT_H
#define ALI3_METHODS_COARSE_EVENT_H
#include "../instance.h"

void ali3_coarse_event(ali3_instance *in, double h, double change, double miss);
#endif
