/* The integration rule of generalised-alpha. */
#ifndef ALI3_GENERALISED_ALPHA_H
#define ALI3_GENERALISED_ALPHA_H
#include "../instance.h"

bool ali3_damped_start(const ali3_instance *in, double h);
void ali3_alpha_rule(ali3_instance *in, double h);
void ali3_alpha_accept(ali3_instance *in, double h);
#endif
