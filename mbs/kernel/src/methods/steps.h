/* The step of each method, and a step by the method of the settings. */
#ifndef ALI3_STEPS_H
#define ALI3_STEPS_H
#include "../instance.h"

ali3_status ali3_augmented_lagrangian(ali3_instance *in, double t, double h);
ali3_status ali3_energy_momentum(ali3_instance *in, double t, double h, double share, bool report);
ali3_status ali3_composition(ali3_instance *in, double t, double h);
ali3_status ali3_runge_kutta(ali3_instance *in, double t, double h);
ali3_status ali3_semi_recursive(ali3_instance *in, double t, double h);
ali3_status ali3_radau(ali3_instance *in, double t, double h);
ali3_status ali3_advance(ali3_instance *in, double t, double h, int32_t depth);
#endif
