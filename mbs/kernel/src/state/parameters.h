/* Parameters, settings and start of an instance. */
#ifndef ALI3_PARAMETERS_H
#define ALI3_PARAMETERS_H
#include "../instance.h"

/* Number that a parameter with a value writes to target k of the System. */
double ali3_parameter_writes(const ali3_system *S, int64_t k, double value);
/* Applies in->parameters.value (np); ALI3_BAD_ARGUMENT if the data of an element, driving function or road become
 * invalid. */
ali3_status ali3_parameters_apply(ali3_instance *in);
/* Sets all values (np doubles at any address) and returns true if the data they write are valid; otherwise keeps the
 * present ones. In both cases the previous values are in in->parameters.work afterwards. */
bool ali3_parameters_set_all(ali3_instance *in, const void *values);
/* Sets the switches with parameters to their values. */
void ali3_parameters_switch(ali3_instance *in);
/* Whether all settings are in their ranges. */
bool ali3_settings_valid(const ali3_settings *s);
/* Resets the coordinates of the start, in->start.q, to those of the System file. */
void ali3_file_start(ali3_instance *in);
#endif
