/* Detection of changes of the assembly mode in a step. */
#ifndef ALI3_BRANCH_WATCH_H
#define ALI3_BRANCH_WATCH_H
#include "../instance.h"
#include "../request.h"

void ali3_branch_before(ali3_instance *in);
ali3_status ali3_branch_after(ali3_instance *in, const ali3_request *request);
void ali3_branch_look(ali3_instance *in, double t);
#endif
