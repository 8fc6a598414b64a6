/* Whether q and qd are all states of a System. */
#ifndef ALI3_WITHOUT_STATES_H
#define ALI3_WITHOUT_STATES_H
#include "../system.h"

bool ali3_without_states(const ali3_system *S);
#endif
