/* Detection of changes of the assembly mode in a step. */
#ifndef ALI3_BRANCH_WATCH_H
#define ALI3_BRANCH_WATCH_H
#include "../instance.h"
#include "../request.h"

/* Before a step: stores its initial angles and, where branches may be close, its initial state. */
void ali3_branch_before(ali3_instance *in);
/* After a completed step: reports a change of the assembly mode; where branches are close the step is repeated in
 * parts. Returns ALI3_OK, or the status of such a part. */
ali3_status ali3_branch_after(ali3_instance *in, const ali3_request *request);
/* After a controlled step to time t, s, which ali3_branch_fraction has checked for jumps: reports a change of the
 * assembly mode. */
void ali3_branch_check(ali3_instance *in, double t);
#endif
