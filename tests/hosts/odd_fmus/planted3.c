/* The face of FMI 3.0 of `plants.h`. */
#include "plants.h"

#include "fmi3FunctionTypes.h"
#include "fmi3PlatformTypes.h"

typedef struct {
  planted p;
  fmi3LogMessageCallback log;
  void *environment;
} face;

static void say(const void *c, const char *text) {
  const face *f = c;
  f->log(f->environment, fmi3OK, PLANT == NO_CATEGORY ? NULL : "log", text);
}

#pragma GCC visibility push(default) /* what follows is exported */

const char *fmi3GetVersion(void) { return PLANT == VERSION ? "2.0" : "3.0"; }

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String names[]) {
  (void)c, (void)on, (void)names;
  return n ? fmi3Error : fmi3OK;
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early,
                                         const fmi3ValueReference needed[], size_t n,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update) {
  (void)visible, (void)logging, (void)events, (void)early, (void)needed, (void)n, (void)update;
  if (!*name || strcmp(token, "{small}") || !takes_path(resources) || !may_begin()) return NULL;
  face *f = calloc(1, sizeof *f);
  f->p = new_planted(), f->log = log, f->environment = environment;
  return f;
}

void fmi3FreeInstance(fmi3Instance c) { free(c), alive--; }

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerant, fmi3Float64 tolerance, fmi3Float64 start,
                                       fmi3Boolean ends, fmi3Float64 stop) {
  (void)tolerant, (void)tolerance, (void)ends, (void)stop;
  ((face *)c)->p.time = begin_planted(start);
  at_start(c);
  return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return c ? fmi3OK : fmi3Error; }

fmi3Status fmi3Terminate(fmi3Instance c) {
  at_end();
  return c && PLANT != NO_END ? fmi3OK : fmi3Error;
}

fmi3Status fmi3Reset(fmi3Instance c) {
  reset_planted(&((face *)c)->p);
  return fmi3OK;
}

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 v[], size_t count) {
  for (size_t k = 0; k < n && n == count; k++) {
    if (r[k] > 2) return fmi3Error;
    v[place_planted(r, n, k)] = r[k] == 2 ? ((face *)c)->p.time : read_planted(&((face *)c)->p, r[k]);
  }
  return n == count ? fmi3OK : fmi3Error;
}

fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Float64 v[], size_t count) {
  for (size_t k = 0; k < n && n == count; k++) {
    if (r[k]) return fmi3Error;
    set_planted(&((face *)c)->p, v[k]);
  }
  return n == count ? fmi3OK : fmi3Error;
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) {
  if (!*state) *state = new_state();
  save_planted(*state, &((face *)c)->p);
  return fmi3OK;
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) {
  take_planted(&((face *)c)->p, state);
  return fmi3OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) {
  (void)c;
  free_planted(state);
  return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size) {
  (void)c, (void)state;
  *size = STATE_SIZE;
  return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
  (void)c;
  memcpy(bytes, state, size + SPILL);
  return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state) {
  (void)c;
  *state = malloc(size);
  memcpy(*state, bytes, size);
  return fmi3OK;
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference z[], size_t nz,
                                        const fmi3ValueReference v[], size_t nv, const fmi3Float64 seed[], size_t seeds,
                                        fmi3Float64 found[], size_t size) {
  if (nv != 1 || v[0] != 0 || seeds != 1 || size != nz) return fmi3Error;
  for (size_t k = 0; k < nz; k++) found[k] = z[k] == 1 ? seed[0] * slope_planted(&((face *)c)->p) : 0.0;
  return fmi3OK;
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 step, fmi3Boolean no_return, fmi3Boolean *event,
                      fmi3Boolean *ends, fmi3Boolean *early, fmi3Float64 *last) {
  (void)no_return;
  if (!takes_time(&((face *)c)->p, time)) return fmi3Error;
  step_planted(c, &((face *)c)->p, step);
  *event = *ends = *early = false;
  *last = time + step;
  return PLANT == WARNS ? fmi3Warning : fmi3OK;
}

/* FMPy wants every function of the standard to be there. */
#define NO(name)                                                                                                       \
  fmi3Status name(void) { return fmi3Error; }
NO(fmi3ActivateModelPartition)
NO(fmi3CompletedIntegratorStep)
NO(fmi3EnterConfigurationMode)
NO(fmi3EnterContinuousTimeMode)
NO(fmi3EnterEventMode)
NO(fmi3EnterStepMode)
NO(fmi3EvaluateDiscreteStates)
NO(fmi3ExitConfigurationMode)
NO(fmi3GetAdjointDerivative)
NO(fmi3GetBinary)
NO(fmi3GetBoolean)
NO(fmi3GetClock)
NO(fmi3GetContinuousStateDerivatives)
NO(fmi3GetContinuousStates)
NO(fmi3GetEventIndicators)
NO(fmi3GetFloat32)
NO(fmi3GetInt16)
NO(fmi3GetInt32)
NO(fmi3GetInt64)
NO(fmi3GetInt8)
NO(fmi3GetIntervalDecimal)
NO(fmi3GetIntervalFraction)
NO(fmi3GetNominalsOfContinuousStates)
NO(fmi3GetNumberOfContinuousStates)
NO(fmi3GetNumberOfEventIndicators)
NO(fmi3GetNumberOfVariableDependencies)
NO(fmi3GetOutputDerivatives)
NO(fmi3GetShiftDecimal)
NO(fmi3GetShiftFraction)
NO(fmi3GetString)
NO(fmi3GetUInt16)
NO(fmi3GetUInt32)
NO(fmi3GetUInt64)
NO(fmi3GetUInt8)
NO(fmi3GetVariableDependencies)
NO(fmi3InstantiateModelExchange)
NO(fmi3InstantiateScheduledExecution)
NO(fmi3SetBoolean)
NO(fmi3SetInt32)
NO(fmi3SetBinary)
NO(fmi3SetClock)
NO(fmi3SetContinuousStates)
NO(fmi3SetFloat32)
NO(fmi3SetInt16)
NO(fmi3SetInt64)
NO(fmi3SetInt8)
NO(fmi3SetIntervalDecimal)
NO(fmi3SetIntervalFraction)
NO(fmi3SetShiftDecimal)
NO(fmi3SetShiftFraction)
NO(fmi3SetString)
NO(fmi3SetTime)
NO(fmi3SetUInt16)
NO(fmi3SetUInt32)
NO(fmi3SetUInt64)
NO(fmi3SetUInt8)
NO(fmi3UpdateDiscreteStates)
