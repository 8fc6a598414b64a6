/* A step by the method of the settings, and functions by which methods make parts of a step. Times and steps in s. */
#ifndef ALI3_STEPS_H
#define ALI3_STEPS_H
#include "../instance.h"
#include "../request.h"

/* Whether a step of h to time t is divided where inputs or driving functions jump, or to resolve a driving function or
 * a force by table, or ends at a jump of a driving function. */
bool ali3_is_divided(const ali3_instance *in, double t, double h);
/* Makes a step in parts that end where inputs or driving functions jump or that resolve driving functions and forces
 * by table; returns its status, after a failure with in->now unchanged. */
ali3_status ali3_advance(ali3_instance *in, const ali3_request *request);
/* Makes a step of energy-momentum from in->now to in->next; in->now changes only if it succeeds. t: time at its end; h
 * may be negative; `middle`: its middle as a fraction of the step of ali3_inputs_begin; `reported`: the end is read. */
ali3_status ali3_energy_momentum(ali3_instance *in, double t, double h, double middle, bool reported);
#endif
