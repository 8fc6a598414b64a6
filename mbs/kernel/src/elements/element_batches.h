/* Elements of one System with the same law, evaluated in vectors of four (laws.h) with the same bits as one by one. */
#ifndef ALI3_ELEMENT_BATCHES_H
#define ALI3_ELEMENT_BATCHES_H
#include "forces.h"

/* Elements in a vector, and the largest numbers of data of one of them. */
enum { ALI3_BATCH = 4, ALI3_BATCH_REALS = 64, ALI3_BATCH_STATES = 8, ALI3_BATCH_OUTPUTS = 24, ALI3_BATCH_INTEGERS = 4 };

/* At load, from el_kind and el_size: selects elements that are evaluated together, and alone. */
void ali3_batches_derive(ali3_system *s);
/* Evaluates the elements in batches, as ali3_elements_forces does one by one. */
void ali3_batches_forces(ali3_instance *in, const ali3_force_call *call);
/* A road of the instance, with its type and its numbers as by ali3_road_numbers. */
const struct ali3_road *ali3_batches_road(const ali3_instance *in, int32_t number, int32_t *type, double *numbers,
                                          double *friction_factor);
#endif
