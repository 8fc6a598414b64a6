/* FMI 3.0: saving, restoring and serializing the state of an instance. */
#include "fmi3_adapter.h"

FMI3_ENTRY(fmi3GetFMUState, (fmi3Instance instance, fmi3FMUState *state), (instance, state)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3GetFMUState", FMI3_ANY);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3GetFMUState", state != NULL)) return fmi3Error;
  return (fmi3Status)slave_state_get(adapter->s, (slave_state **)state);
}

FMI3_ENTRY(fmi3SetFMUState, (fmi3Instance instance, fmi3FMUState state), (instance, state)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3SetFMUState", FMI3_ANY);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3SetFMUState", state != NULL)) return fmi3Error;
  return (fmi3Status)slave_state_set(adapter->s, state);
}

FMI3_ENTRY(fmi3FreeFMUState, (fmi3Instance instance, fmi3FMUState *state), (instance, state)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3FreeFMUState", FMI3_ANY);
  if (adapter == NULL) return fmi3Error;
  if (state == NULL) return fmi3OK; /* as the standard says */
  return (fmi3Status)slave_state_free(adapter->s, (slave_state **)state);
}

FMI3_ENTRY(fmi3SerializedFMUStateSize, (fmi3Instance instance, fmi3FMUState state, size_t *size),
           (instance, state, size)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3SerializedFMUStateSize", FMI3_ANY);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3SerializedFMUStateSize", state != NULL && size != NULL))
    return fmi3Error;
  return (fmi3Status)slave_state_size(adapter->s, state, size);
}

FMI3_ENTRY(fmi3SerializeFMUState, (fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[], size_t size),
           (instance, state, bytes, size)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3SerializeFMUState", FMI3_ANY);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3SerializeFMUState", state != NULL && bytes != NULL))
    return fmi3Error;
  return (fmi3Status)slave_state_write(adapter->s, state, bytes, size);
}

FMI3_ENTRY(fmi3DeserializeFMUState, (fmi3Instance instance, const fmi3Byte bytes[], size_t size, fmi3FMUState *state),
           (instance, bytes, size, state)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3DeserializeFMUState", FMI3_ANY);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3DeserializeFMUState", bytes != NULL && state != NULL))
    return fmi3Error;
  return (fmi3Status)slave_state_read(adapter->s, bytes, size, (slave_state **)state);
}
