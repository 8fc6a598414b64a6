/* Conditions that Systems must fulfil for a method. */
#ifndef ALI3_CHECK_METHOD_H
#define ALI3_CHECK_METHOD_H
#include "../instance.h"

#define ALI3_STATES_IN_WORDS "element states or filtered driving functions"
/* ALI3_WRONG_METHOD if forces at stages within a step depend on more than q, qd and time. */
ali3_status ali3_needs_no_states(const ali3_instance *in);
/* Whether neither elements nor flexible bodies dissipate energy. */
bool ali3_conservative(const ali3_instance *in);
/* `has_balance` of methods whose steps always end with ali3_energy_watch. */
static inline bool ali3_always(const ali3_instance *in) { return in != NULL; }
#endif
