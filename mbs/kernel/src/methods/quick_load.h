/* Loads of tyres that change too quickly for the step. */
#ifndef ALI3_METHODS_QUICK_LOAD_H
#define ALI3_METHODS_QUICK_LOAD_H
#include "../instance.h"

void ali3_quick_load(ali3_instance *in, double h);
#endif
