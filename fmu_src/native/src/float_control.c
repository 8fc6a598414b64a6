/* Floating-point control around a call of the FMU. The host's control is the first member of the instance, so that
 * callbacks run with it. */
#include "slave.h"

ali3_float_control slave_call_begins(void *instance) {
  ali3_float_control *stored = instance;
  if (stored == NULL) return 0;
  const ali3_float_control host = ali3_float_control_set();
  if (host != 0) *stored = host;
  return host;
}

void slave_call_ends(void *instance, ali3_float_control host) {
  ali3_float_control *stored = instance;
  if (stored != NULL) *stored = 0;
  ali3_float_control_restore(host);
}

/* The stored control is cleared, as a callback may call the FMU again. */
ali3_float_control slave_call_leaves(void *instance) {
  ali3_float_control *stored = instance;
  const ali3_float_control host = *stored;
  slave_call_ends(instance, host);
  return host;
}

void slave_call_returns(void *instance, ali3_float_control host) {
  ali3_float_control *stored = instance;
  ali3_float_control_set();
  *stored = host;
}
