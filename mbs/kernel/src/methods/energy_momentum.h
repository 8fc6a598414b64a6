/* Functions of the energy-momentum method for reports and compositions. The carried velocity v->own is that of the
 * recursion of steps; v->qd is the reported one, on the rows. */
#ifndef ALI3_ENERGY_MOMENTUM_H
#define ALI3_ENERGY_MOMENTUM_H
#include "../instance.h"

/* Projects v->own onto the rows, of Systems with flexible bodies, with the factorised tangent of the step; weight: c
 * alpha of that tangent. Needs Phi_q in in->tangent.J. */
void ali3_energy_momentum_carry(ali3_instance *in, ali3_vectors *v, double weight);
/* Writes v->qd, v->qdd and v->lam from v->q and v->own. Needs Phi_q in in->tangent.J. Returns a status if the equations
 * cannot be solved. */
ali3_status ali3_energy_momentum_complete(ali3_instance *in, ali3_vectors *v);
/* Completes in->now after steps of which nothing was read. */
void ali3_energy_momentum_report(ali3_instance *in);
/* Before a step of h, s, after steps of this method: in->now.own = in->now.qd in a controlled run or if h is not the
 * length of the last step; then in->now is backed up, and completed if the run is not controlled. */
void ali3_energy_momentum_restart(ali3_instance *in, double h, bool controlled);
/* Adds steps from in->next to in->now with total length h, s, by their carried velocities, to the accuracy measures. */
void ali3_energy_momentum_motion(ali3_instance *in, double h);
#endif
