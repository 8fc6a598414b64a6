/* Forces of contacts and end stops that change too quickly for the step. */
#ifndef ALI3_METHODS_ABRUPT_FORCE_H
#define ALI3_METHODS_ABRUPT_FORCE_H
#include "../instance.h"
#include "../request.h"

void ali3_abrupt_force(ali3_instance *in);
/* Whether the coming step is to be made in halves, because a force changed as quickly in the last; counted. */
bool ali3_divides_ahead(ali3_instance *in, const ali3_request *request);
/* Whether a limit of the step's iterations leaves so many for each of two parts; they are counted as a division. Else the
 * limit ends the step, as one whose iterations it stops. */
bool ali3_leaves_parts(ali3_instance *in, const ali3_request *request, int32_t iterations);
/* Whether that from in->now to in->next, both with their outputs, is. */
bool ali3_divides(ali3_instance *in, const ali3_request *request);
#endif
