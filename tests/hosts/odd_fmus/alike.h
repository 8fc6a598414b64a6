/* The functions of FMI 2.0 that are alike in the FMUs of this folder: what they do not have, and the bytes of a state. */
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"

#ifndef FREE_STATE
#define FREE_STATE(state) free(*(state)), *(state) = NULL
#define MORE_BYTES 0
#endif

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String names[]) {
  (void)c, (void)on, (void)names;
  return n ? fmi2Error : fmi2OK;
}

#define ABSENT(name, type)                                                                                             \
  fmi2Status fmi2Get##name(fmi2Component c, const fmi2ValueReference r[], size_t n, type v[]) {                        \
    (void)c, (void)r, (void)v;                                                                                         \
    return n ? fmi2Error : fmi2OK;                                                                                     \
  }                                                                                                                    \
  fmi2Status fmi2Set##name(fmi2Component c, const fmi2ValueReference r[], size_t n, const type v[]) {                  \
    (void)c, (void)r, (void)v;                                                                                         \
    return n ? fmi2Error : fmi2OK;                                                                                     \
  }
ABSENT(Integer, fmi2Integer)
ABSENT(Boolean, fmi2Boolean)
ABSENT(String, fmi2String)

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
  (void)c;
  FREE_STATE(state);
  return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  (void)c;
  memcpy(bytes, state, size + MORE_BYTES);
  return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) {
  (void)c;
  *state = malloc(size);
  memcpy(*state, bytes, size);
  return fmi2OK;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n,
                                       const fmi2Integer order[], const fmi2Real v[]) {
  (void)c, (void)r, (void)n, (void)order, (void)v;
  return fmi2Error;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n,
                                        const fmi2Integer order[], fmi2Real v[]) {
  (void)c, (void)r, (void)n, (void)order, (void)v;
  return fmi2Error;
}

fmi2Status fmi2CancelStep(fmi2Component c) { return c ? fmi2Error : fmi2OK; }

#define STATUS(name, type)                                                                                             \
  fmi2Status fmi2Get##name(fmi2Component c, const fmi2StatusKind kind, type *v) {                                      \
    (void)c, (void)kind, (void)v;                                                                                      \
    return fmi2Discard;                                                                                                \
  }
STATUS(Status, fmi2Status)
STATUS(RealStatus, fmi2Real)
STATUS(IntegerStatus, fmi2Integer)
STATUS(BooleanStatus, fmi2Boolean)
STATUS(StringStatus, fmi2String)
