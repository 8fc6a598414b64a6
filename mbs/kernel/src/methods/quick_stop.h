/* End stops that are hit too hard for the step. */
#ifndef ALI3_METHODS_QUICK_STOP_H
#define ALI3_METHODS_QUICK_STOP_H
#include "../instance.h"

void ali3_quick_stop(ali3_instance *in, double h);
#endif
