/* Mass matrix of an instance: the matrix of the System with payloads, armatures, inertias and axes of its parameters. */
#ifndef ALI3_MASSES_H
#define ALI3_MASSES_H
#include "../instance.h"
#include "../system/pool.h"

/* Places in->mass.own, if a parameter changes masses. */
void ali3_masses_place(const ali3_system *s, ali3_instance *in, ali3_pool *pool);
/* Selects the mass arrays of a new instance: those of the System, or its own. */
void ali3_masses_start(ali3_instance *in);
/* Updates the masses after payloads, ratios, inertias or axes have changed. */
void ali3_masses_apply(ali3_instance *in);
#endif
