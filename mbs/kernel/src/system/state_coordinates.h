/* Test whether q and qd are the only states of a System. */
#ifndef ALI3_STATE_COORDINATES_H
#define ALI3_STATE_COORDINATES_H
#include "../system.h"

/* True without element states and filtered driving functions: forces at stages inside a step then depend only on q, qd
 * and time. */
bool ali3_states_are_coordinates(const ali3_system *S);
#endif
