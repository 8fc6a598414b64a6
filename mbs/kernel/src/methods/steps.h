/* A step by the method of the settings, and functions by which methods make parts of a step. */
#ifndef ALI3_STEPS_H
#define ALI3_STEPS_H
#include "../instance.h"
#include "../request.h"

bool ali3_parted(const ali3_instance *in, double t, double h);
ali3_status ali3_advance(ali3_instance *in, const ali3_request *request);
ali3_status ali3_energy_momentum(ali3_instance *in, double t, double h, double middle, bool reported);
#endif
