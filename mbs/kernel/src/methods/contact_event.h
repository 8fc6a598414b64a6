/* Division of steps at contact events. */
#ifndef ALI3_METHODS_CONTACT_EVENT_H
#define ALI3_METHODS_CONTACT_EVENT_H
#include "../instance.h"
#include "../request.h"

void ali3_events_begin(ali3_instance *in, int32_t depth);
/* Whether to divide the step from in->now to in->next, which have outputs, at in->parting.event. */
bool ali3_contact_event(ali3_instance *in, const ali3_request *request);
#endif
