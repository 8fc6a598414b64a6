/* Stops that are met or left within a step. */
#ifndef ALI3_METHODS_CONTACT_EVENT_H
#define ALI3_METHODS_CONTACT_EVENT_H
#include "../instance.h"

enum { ALI3_EVENTS = 4 }; /* at which a step is parted at most */

/* Whether the step of size h from in->now to in->next, both with their outputs, is to be parted at in->event. */
bool ali3_contact_event(ali3_instance *in, double h);
#endif
