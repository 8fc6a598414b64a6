/* Mass matrix of an instance: the matrix of the System with payloads, armatures, inertias and axes of its parameters. */
#ifndef ALI3_MASSES_H
#define ALI3_MASSES_H
#include "../instance.h"
#include "../system/pool.h"

void ali3_masses_place(const ali3_system *s, ali3_instance *in, ali3_pool *pool);
void ali3_masses_start(ali3_instance *in);
void ali3_masses_apply(ali3_instance *in);
#endif
