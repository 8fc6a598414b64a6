/* The control of floating point around a call: what the host has, in the face for callbacks. */
#include "slave.h"

ali3_float_control slave_call_begins(void *instance) {
  ali3_float_control *kept = instance;
  if (kept == NULL) return 0;
  const ali3_float_control host = ali3_float_control_set();
  if (host != 0) *kept = host;
  return host;
}

void slave_call_ends(void *instance, ali3_float_control host) {
  ali3_float_control *kept = instance;
  if (kept != NULL) *kept = 0;
  ali3_float_control_restore(host);
}

/* The host may call again, so nothing is kept meanwhile. */
ali3_float_control slave_call_leaves(void *instance) {
  ali3_float_control *kept = instance;
  const ali3_float_control host = *kept;
  slave_call_ends(instance, host);
  return host;
}

void slave_call_returns(void *instance, ali3_float_control host) {
  ali3_float_control *kept = instance;
  ali3_float_control_set();
  *kept = host;
}
