/* Elements of one System that have the same law, side by side in vectors of four, as lanes are (laws.h): each
 * has the bits that it has alone. */
#ifndef ALI3_ELEMENT_FOURS_H
#define ALI3_ELEMENT_FOURS_H
#include "forces.h"

/* Elements side by side, and the most numbers of each kind of one of them. */
enum { ALI3_FOUR = 4, ALI3_FOUR_REALS = 64, ALI3_FOUR_STATES = 8, ALI3_FOUR_OUTPUTS = 24, ALI3_FOUR_INTEGERS = 4 };

/* At load, from el_kind and el_size: which elements go together, and which are evaluated alone. */
void ali3_fours_derive(ali3_system *s);
/* The forces of all that go together, as ali3_elements_forces has them of each. */
void ali3_fours_forces(ali3_instance *in, const ali3_force_call *call);
/* A road of the instance, with the numbers of ali3_road_numbers. */
const struct ali3_road *ali3_fours_road(const ali3_instance *in, int32_t number, int32_t *type, double *numbers,
                                        double *friction_factor);
#endif
