/* Cause of a refused step of an explicit method. */
#ifndef ALI3_STIFFNESS_H
#define ALI3_STIFFNESS_H
#include "../instance.h"

/* Status of a refused step h, s: ALI3_TOO_STIFF if the method is explicit and the fastest rate of the motion is the
 * cause, also of diverged stages, or after steps that have left a state without a rate; otherwise `status`. */
ali3_status ali3_explain_refusal(ali3_instance *in, ali3_status status, double h);
#endif
