/* Functions of the energy-momentum method for reports and compositions; energy_momentum.c describes them. */
#ifndef ALI3_ENERGY_MOMENTUM_H
#define ALI3_ENERGY_MOMENTUM_H
#include "../instance.h"

double ali3_energy_momentum_penalty(const ali3_instance *in, double h); /* c alpha */
void ali3_energy_momentum_carry(ali3_instance *in, ali3_vectors *v, double weight);
ali3_status ali3_energy_momentum_show(ali3_instance *in, ali3_vectors *v);
void ali3_energy_momentum_report(ali3_instance *in);
void ali3_energy_momentum_restart(ali3_instance *in, double h, bool controlled);
void ali3_energy_momentum_motion(ali3_instance *in, const ali3_vectors *from, double h);
#endif
