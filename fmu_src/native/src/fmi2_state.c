/* FMI 2.0: saving, restoring and serializing the state of an instance. */
#include "fmi2_adapter.h"

FMI2_ENTRY(fmi2GetFMUstate, (fmi2Component c, fmi2FMUstate *state), (c, state)) {
  slave *s = fmi2_slave(c, "fmi2GetFMUstate", FMI2_ANY);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2GetFMUstate", state != NULL)) return fmi2Error;
  return (fmi2Status)slave_state_get(s, (slave_state **)state);
}

FMI2_ENTRY(fmi2SetFMUstate, (fmi2Component c, fmi2FMUstate state), (c, state)) {
  slave *s = fmi2_slave(c, "fmi2SetFMUstate", FMI2_ANY);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2SetFMUstate", state != NULL)) return fmi2Error;
  return (fmi2Status)slave_state_set(s, state);
}

FMI2_ENTRY(fmi2FreeFMUstate, (fmi2Component c, fmi2FMUstate *state), (c, state)) {
  slave *s = fmi2_slave(c, "fmi2FreeFMUstate", FMI2_ANY);
  if (s == NULL) return fmi2Error;
  if (state == NULL) return fmi2OK; /* as the standard says */
  return (fmi2Status)slave_state_free(s, (slave_state **)state);
}

FMI2_ENTRY(fmi2SerializedFMUstateSize, (fmi2Component c, fmi2FMUstate state, size_t *size), (c, state, size)) {
  slave *s = fmi2_slave(c, "fmi2SerializedFMUstateSize", FMI2_ANY);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2SerializedFMUstateSize", state != NULL && size != NULL))
    return fmi2Error;
  return (fmi2Status)slave_state_size(s, state, size);
}

FMI2_ENTRY(fmi2SerializeFMUstate, (fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size),
           (c, state, bytes, size)) {
  slave *s = fmi2_slave(c, "fmi2SerializeFMUstate", FMI2_ANY);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2SerializeFMUstate", state != NULL && bytes != NULL)) return fmi2Error;
  return (fmi2Status)slave_state_write(s, state, (unsigned char *)bytes, size);
}

FMI2_ENTRY(fmi2DeSerializeFMUstate, (fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state),
           (c, bytes, size, state)) {
  slave *s = fmi2_slave(c, "fmi2DeSerializeFMUstate", FMI2_ANY);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2DeSerializeFMUstate", bytes != NULL && state != NULL)) return fmi2Error;
  return (fmi2Status)slave_state_read(s, (const unsigned char *)bytes, size, (slave_state **)state);
}
