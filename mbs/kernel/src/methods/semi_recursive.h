/* Reports of the semi-recursive methods. */
#ifndef ALI3_SEMI_RECURSIVE_H
#define ALI3_SEMI_RECURSIVE_H
#include "../instance.h"

void ali3_semi_recursive_report(ali3_instance *in);
#endif
