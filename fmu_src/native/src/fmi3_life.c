/* FMI 3.0: inquiry, instances, initialisation, end, logging. */
#include <stdlib.h>
#include <string.h>

#include "fmi3_face.h"

fmi3_face *fmi3_slave(fmi3Instance instance, const char *function, unsigned phases) {
  fmi3_face *face = instance;
  if (face == NULL) return NULL;
  if (face->updating && strcmp(function, "fmi3SetFloat64") != 0) {
    slave_say(face->s, SLAVE_ERROR, "%s was called in an intermediate update, in which real inputs can be set.",
              function);
    return NULL;
  }
  return slave_is_allowed(face->s, function, phases) ? face : NULL;
}

bool fmi3_check_pointers(fmi3_face *face, const char *function, bool valid) {
  if (!valid) slave_say(face->s, SLAVE_ERROR, "%s was called with a null pointer.", function);
  return valid;
}

size_t fmi3_array_size(fmi3ValueReference reference) {
  const fmi3_table *t = &fmi3_the_table;
  return reference != t->time ? t->first[reference + 1] - t->first[reference] : 1;
}

bool fmi3_check_count(fmi3_face *face, const fmi3ValueReference *reference, size_t n, size_t n_values) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    if (reference[i] >= fmi3_the_table.n_arrays) {
      slave_say(face->s, SLAVE_ERROR, "There is no variable with value reference %u for this call.",
                (unsigned)reference[i]);
      return false;
    }
    count += fmi3_array_size(reference[i]);
  }
  if (count == n_values) return true;
  slave_say(face->s, SLAVE_ERROR, "The variables have %zu values, the call gives room for %zu.", count, n_values);
  return false;
}

bool fmi3_expand(fmi3_face *face, int list, const fmi3ValueReference *reference, size_t n, size_t n_values) {
  const fmi3_table *t = &fmi3_the_table;
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    if (reference[i] >= t->n_arrays || reference[i] == t->time) {
      slave_say(face->s, SLAVE_ERROR, "There is no variable with value reference %u for this call.",
                (unsigned)reference[i]);
      return false;
    }
    const size_t size = t->first[reference[i] + 1] - t->first[reference[i]];
    if (count + size > face->capacity) {
      slave_say(face->s, SLAVE_ERROR, "One call asks for more values than this FMU has variables (%zu).",
                face->capacity);
      return false;
    }
    memcpy(face->items[list] + count, t->item + t->first[reference[i]], size * sizeof(uint32_t));
    count += size;
  }
  if (count == n_values) return true;
  slave_say(face->s, SLAVE_ERROR, "The variables have %zu values, the call gives room for %zu.", count, n_values);
  return false;
}

static void log_to_host(slave *s, slave_status status, const char *category, const char *text) {
  fmi3_face *face = s->host;
  if (face->log == NULL) return;
  const ali3_float_control host = slave_call_leaves(face);
  face->log(face->environment, (fmi3Status)status, category, text);
  slave_call_returns(face, host);
}

/* Calls the host's intermediate update, which may set inputs at `time`, the end of the next inner step. */
static void request_inputs(slave *s, double time) {
  fmi3_face *face = s->host;
  fmi3Boolean early = false;
  fmi3Float64 early_time = time;
  const ali3_float_control host = slave_call_leaves(face);
  face->updating = true;
  face->update(face->environment, time, true, false, false, false, &early, &early_time);
  face->updating = false;
  slave_call_returns(face, host);
}

FMI3_EXPORT const char *FMI3_NAME(fmi3GetVersion)(void) { return "3.0"; }

FMI3_ENTRY(fmi3SetDebugLogging, (fmi3Instance instance, fmi3Boolean on, size_t n, const fmi3String categories[]),
           (instance, on, n, categories)) {
  fmi3_face *face = fmi3_slave(instance, "fmi3SetDebugLogging", FMI3_ANY);
  return face != NULL ? (fmi3Status)slave_set_logging(face->s, on, n, categories) : fmi3Error;
}

static void log_refusal(fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, const char *text) {
  if (log != NULL) log(environment, fmi3Error, "logStatusError", text);
}

FMI3_EXPORT fmi3Instance FMI3_NAME(fmi3InstantiateModelExchange)(fmi3String name, fmi3String token,
                                                                 fmi3String resources, fmi3Boolean visible,
                                                                 fmi3Boolean logging, fmi3InstanceEnvironment env,
                                                                 fmi3LogMessageCallback log) {
  (void)name, (void)token, (void)resources, (void)visible, (void)logging;
  log_refusal(env, log, "This FMU is for co-simulation only.");
  return NULL;
}

FMI3_EXPORT fmi3Instance FMI3_NAME(fmi3InstantiateScheduledExecution)(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3InstanceEnvironment env, fmi3LogMessageCallback log, fmi3ClockUpdateCallback clock,
    fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock) {
  (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)clock, (void)lock, (void)unlock;
  log_refusal(env, log, "This FMU is for co-simulation only.");
  return NULL;
}

static void free_face(fmi3_face *face) {
  slave_free(face->s);
  free(face->items[0]);
  free(face->unit);
  free(face);
}

FMI3_EXPORT fmi3Instance FMI3_NAME(fmi3InstantiateCoSimulation)(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3Boolean event_mode, fmi3Boolean early_return, const fmi3ValueReference intermediate[], size_t n_intermediate,
    fmi3InstanceEnvironment env, fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update) {
  const ali3_memory memory = {calloc, free};
  const size_t capacity = slave_the_table.n_variables;
  (void)visible;
  if (event_mode) {
    log_refusal(env, log, "This FMU has no event mode.");
    return NULL;
  }
  fmi3_face *face = calloc(1, sizeof *face);
  if (face == NULL) return NULL;
  face->environment = env;
  face->log = log;
  face->capacity = capacity;
  face->items[0] = calloc(2 * capacity, sizeof(uint32_t));
  face->unit = calloc(2 * capacity, sizeof(double));
  const ali3_float_control host = slave_call_begins(face);
  if (face->items[0] != NULL && face->unit != NULL)
    face->s = slave_new(&memory, face, log_to_host, logging, name, token, resources);
  slave_call_ends(face, host);
  if (face->s == NULL) {
    free_face(face);
    return NULL;
  }
  for (size_t i = 0; i < n_intermediate; i++) {
    if (intermediate != NULL && intermediate[i] < fmi3_the_table.n_arrays) continue;
    slave_say(face->s, SLAVE_ERROR, "There is no variable with value reference %u for an intermediate update.",
              intermediate != NULL ? (unsigned)intermediate[i] : 0U);
    free_face(face);
    return NULL;
  }
  face->update = update;
  face->s->request_inputs = update != NULL && n_intermediate > 0 ? request_inputs : NULL;
  face->s->early_return = early_return;
  face->items[1] = face->items[0] + capacity;
  face->derivative = face->unit + capacity;
  return face;
}

FMI3_EXPORT void FMI3_NAME(fmi3FreeInstance)(fmi3Instance instance) {
  if (instance != NULL) free_face(instance);
}

FMI3_ENTRY(fmi3EnterInitializationMode,
           (fmi3Instance instance, fmi3Boolean tolerance_defined, fmi3Float64 tolerance, fmi3Float64 start,
            fmi3Boolean stop_defined, fmi3Float64 stop),
           (instance, tolerance_defined, tolerance, start, stop_defined, stop)) {
  fmi3_face *face = fmi3_slave(instance, "fmi3EnterInitializationMode", SLAVE_INSTANTIATED);
  (void)tolerance_defined, (void)tolerance; /* the inner step is fixed */
  if (face == NULL || slave_setup(face->s, start, stop_defined, stop) != SLAVE_OK) return fmi3Error;
  return (fmi3Status)slave_enter(face->s);
}

FMI3_ENTRY(fmi3ExitInitializationMode, (fmi3Instance instance), (instance)) {
  fmi3_face *face = fmi3_slave(instance, "fmi3ExitInitializationMode", SLAVE_INITIALISING);
  return face != NULL ? (fmi3Status)slave_exit(face->s) : fmi3Error;
}

FMI3_ENTRY(fmi3Terminate, (fmi3Instance instance), (instance)) {
  fmi3_face *face = fmi3_slave(instance, "fmi3Terminate", FMI3_RUN);
  return face != NULL ? (fmi3Status)slave_terminate(face->s) : fmi3Error;
}

FMI3_ENTRY(fmi3Reset, (fmi3Instance instance), (instance)) {
  fmi3_face *face = fmi3_slave(instance, "fmi3Reset", FMI3_ANY);
  return face != NULL ? (fmi3Status)slave_reset(face->s) : fmi3Error;
}
