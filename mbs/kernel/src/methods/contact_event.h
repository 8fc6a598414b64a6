/* Division of steps at contact events. */
#ifndef ALI3_METHODS_CONTACT_EVENT_H
#define ALI3_METHODS_CONTACT_EVENT_H
#include "../instance.h"
#include "../request.h"

/* Starts a requested step whose parts may be halved `depth` times: sets the number of events at which it may be
 * divided, in->parting.events_left. */
void ali3_events_begin(ali3_instance *in, int32_t depth);
/* Whether to divide the step from one state to another, whose outputs are evaluated, at the fraction
 * in->parting.event. End stops of Systems with roads do not divide it: for cars it costs more than it gains
 * (docs/force_laws.md). */
bool ali3_contact_event(ali3_instance *in, const ali3_request *request, const ali3_vectors *from,
                        const ali3_vectors *to);
/* Whether a step of h, s, from one state to another, whose outputs are evaluated, meets or leaves an end stop with a
 * kink, or passes a row of a force by table that its ends do not resolve. */
bool ali3_meets_event(const ali3_instance *in, const ali3_vectors *from, const ali3_vectors *to, double h);
#endif
