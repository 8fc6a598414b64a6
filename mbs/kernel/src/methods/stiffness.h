/* Cause of a refused step of an explicit method. */
#ifndef ALI3_STIFFNESS_H
#define ALI3_STIFFNESS_H
#include "../instance.h"

ali3_status ali3_explain_refusal(ali3_instance *in, ali3_status status, double h);
#endif
