/* Parameters, settings and start of an instance. */
#ifndef ALI3_PARAMETERS_H
#define ALI3_PARAMETERS_H
#include "../instance.h"

double ali3_parameter_writes(const ali3_system *S, int64_t k, double value);
ali3_status ali3_parameters_apply(ali3_instance *in);
bool ali3_parameters_take(ali3_instance *in, const void *values);
void ali3_parameters_switch(ali3_instance *in);
bool ali3_settings_valid(const ali3_settings *s);
void ali3_file_start(ali3_instance *in);
#endif
