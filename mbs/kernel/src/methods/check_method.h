/* Conditions that Systems must fulfil for a method. */
#ifndef ALI3_CHECK_METHOD_H
#define ALI3_CHECK_METHOD_H
#include "../instance.h"

/* What ali3_needs_no_states excludes, for messages. */
#define ALI3_STATES_IN_WORDS "element states or filtered guides"
ali3_status ali3_needs_no_states(const ali3_instance *in);
bool ali3_conservative(const ali3_instance *in);
static inline bool ali3_always(const ali3_instance *in) { return in != NULL; }
#endif
