/* Division of steps with abrupt changes of forces. */
#ifndef ALI3_METHODS_ABRUPT_FORCE_H
#define ALI3_METHODS_ABRUPT_FORCE_H
#include "../instance.h"
#include "../request.h"

void ali3_abrupt_force(ali3_instance *in);
/* Whether to make the next step in halves, as a force changed abruptly in the last one; counted. */
bool ali3_divides_ahead(ali3_instance *in, const ali3_request *request);
/* Whether the limit of iterations leaves as many for each of two parts; counted as a division. Otherwise the step ends
 * at its limit. */
bool ali3_leaves_parts(ali3_instance *in, const ali3_request *request, int32_t iterations);
/* Whether to repeat the step from in->now to in->next, which have outputs, in halves. */
bool ali3_divides(ali3_instance *in, const ali3_request *request);
#endif
