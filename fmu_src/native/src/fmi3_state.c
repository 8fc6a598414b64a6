/* FMI 3.0: saving, restoring and serializing the state of an instance. */
#include "fmi3_face.h"

FMI3_ENTRY(fmi3GetFMUState, (fmi3Instance instance, fmi3FMUState *state), (instance, state)) {
  fmi3_face *face = fmi3_slave(instance, "fmi3GetFMUState", FMI3_ANY);
  if (face == NULL || !fmi3_check_pointers(face, "fmi3GetFMUState", state != NULL)) return fmi3Error;
  return (fmi3Status)slave_state_get(face->s, (slave_state **)state);
}

FMI3_ENTRY(fmi3SetFMUState, (fmi3Instance instance, fmi3FMUState state), (instance, state)) {
  fmi3_face *face = fmi3_slave(instance, "fmi3SetFMUState", FMI3_ANY);
  if (face == NULL || !fmi3_check_pointers(face, "fmi3SetFMUState", state != NULL)) return fmi3Error;
  return (fmi3Status)slave_state_set(face->s, state);
}

FMI3_ENTRY(fmi3FreeFMUState, (fmi3Instance instance, fmi3FMUState *state), (instance, state)) {
  fmi3_face *face = fmi3_slave(instance, "fmi3FreeFMUState", FMI3_ANY);
  if (face == NULL) return fmi3Error;
  if (state == NULL) return fmi3OK; /* as the standard says */
  return (fmi3Status)slave_state_free(face->s, (slave_state **)state);
}

FMI3_ENTRY(fmi3SerializedFMUStateSize, (fmi3Instance instance, fmi3FMUState state, size_t *size),
           (instance, state, size)) {
  fmi3_face *face = fmi3_slave(instance, "fmi3SerializedFMUStateSize", FMI3_ANY);
  if (face == NULL || !fmi3_check_pointers(face, "fmi3SerializedFMUStateSize", state != NULL && size != NULL))
    return fmi3Error;
  return (fmi3Status)slave_state_size(face->s, state, size);
}

FMI3_ENTRY(fmi3SerializeFMUState, (fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[], size_t size),
           (instance, state, bytes, size)) {
  fmi3_face *face = fmi3_slave(instance, "fmi3SerializeFMUState", FMI3_ANY);
  if (face == NULL || !fmi3_check_pointers(face, "fmi3SerializeFMUState", state != NULL && bytes != NULL))
    return fmi3Error;
  return (fmi3Status)slave_state_write(face->s, state, bytes, size);
}

FMI3_ENTRY(fmi3DeserializeFMUState, (fmi3Instance instance, const fmi3Byte bytes[], size_t size, fmi3FMUState *state),
           (instance, bytes, size, state)) {
  fmi3_face *face = fmi3_slave(instance, "fmi3DeserializeFMUState", FMI3_ANY);
  if (face == NULL || !fmi3_check_pointers(face, "fmi3DeserializeFMUState", bytes != NULL && state != NULL))
    return fmi3Error;
  return (fmi3Status)slave_state_read(face->s, bytes, size, (slave_state **)state);
}
