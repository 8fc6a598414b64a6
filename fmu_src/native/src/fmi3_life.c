/* FMI 3.0: inquiry, instances, initialisation, end, logging. */
#include <stdlib.h>
#include <string.h>

#include "fmi3_adapter.h"

fmi3_adapter *fmi3_slave(fmi3Instance instance, const char *function, unsigned phases) {
  fmi3_adapter *adapter = instance;
  if (adapter == NULL) return NULL;
  if (adapter->updating && strcmp(function, "fmi3SetFloat64") != 0) {
    slave_log(adapter->s, SLAVE_ERROR, "%s was called in an intermediate update, in which real inputs can be set.",
              function);
    return NULL;
  }
  return slave_is_allowed(adapter->s, function, phases) ? adapter : NULL;
}

bool fmi3_check_pointers(fmi3_adapter *adapter, const char *function, bool valid) {
  if (!valid) slave_log(adapter->s, SLAVE_ERROR, "%s was called with a null pointer.", function);
  return valid;
}

size_t fmi3_array_size(fmi3ValueReference reference) {
  const fmi3_table *t = &fmi3_the_table;
  return reference != t->time ? t->first[reference + 1] - t->first[reference] : 1;
}

bool fmi3_check_count(fmi3_adapter *adapter, const fmi3ValueReference *reference, size_t n, size_t n_values) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    if (reference[i] >= fmi3_the_table.n_arrays) {
      slave_log(adapter->s, SLAVE_ERROR, "There is no variable with value reference %u for this call.",
                (unsigned)reference[i]);
      return false;
    }
    count += fmi3_array_size(reference[i]);
  }
  if (count == n_values) return true;
  slave_log(adapter->s, SLAVE_ERROR, "The variables have %zu values, the call gives room for %zu.", count, n_values);
  return false;
}

bool fmi3_expand(fmi3_adapter *adapter, int list, const fmi3ValueReference *reference, size_t n, size_t n_values) {
  const fmi3_table *t = &fmi3_the_table;
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    if (reference[i] >= t->n_arrays || reference[i] == t->time) {
      slave_log(adapter->s, SLAVE_ERROR, "There is no variable with value reference %u for this call.",
                (unsigned)reference[i]);
      return false;
    }
    const size_t size = t->first[reference[i] + 1] - t->first[reference[i]];
    if (count + size > adapter->capacity) {
      slave_log(adapter->s, SLAVE_ERROR, "One call asks for more values than this FMU has variables (%zu).",
                adapter->capacity);
      return false;
    }
    memcpy(adapter->items[list] + count, t->item + t->first[reference[i]], size * sizeof(uint32_t));
    count += size;
  }
  if (count == n_values) return true;
  slave_log(adapter->s, SLAVE_ERROR, "The variables have %zu values, the call gives room for %zu.", count, n_values);
  return false;
}

/* Logger of the slave: passes a message to the host. */
static void log_to_host(slave *s, slave_status status, const char *category, const char *text) {
  fmi3_adapter *adapter = s->host;
  if (adapter->log == NULL) return;
  const ali3_float_control host = slave_call_leaves(adapter);
  adapter->log(adapter->environment, (fmi3Status)status, category, text);
  slave_call_returns(adapter, host);
}

/* Calls the host's intermediate update, which may set inputs at `time`, the end of the next inner step. */
static void request_inputs(slave *s, double time) {
  fmi3_adapter *adapter = s->host;
  fmi3Boolean early = false;
  fmi3Float64 early_time = time;
  const ali3_float_control host = slave_call_leaves(adapter);
  adapter->updating = true;
  adapter->update(adapter->environment, time, true, false, false, false, &early, &early_time);
  adapter->updating = false;
  slave_call_returns(adapter, host);
}

FMI3_EXPORT const char *FMI3_NAME(fmi3GetVersion)(void) { return "3.0"; }

FMI3_ENTRY(fmi3SetDebugLogging, (fmi3Instance instance, fmi3Boolean on, size_t n, const fmi3String categories[]),
           (instance, on, n, categories)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3SetDebugLogging", FMI3_ANY);
  return adapter != NULL ? (fmi3Status)slave_set_logging(adapter->s, on, n, categories) : fmi3Error;
}

/* Logs why there is no instance, before there is one. */
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

static void free_adapter(fmi3_adapter *adapter) {
  slave_free(adapter->s);
  free(adapter->items[0]);
  free(adapter->unit);
  free(adapter);
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
  fmi3_adapter *adapter = calloc(1, sizeof *adapter);
  if (adapter == NULL) return NULL;
  adapter->environment = env;
  adapter->log = log;
  adapter->capacity = capacity;
  adapter->items[0] = calloc(2 * capacity, sizeof(uint32_t));
  adapter->unit = calloc(2 * capacity, sizeof(double));
  const ali3_float_control host = slave_call_begins(adapter);
  if (adapter->items[0] != NULL && adapter->unit != NULL)
    adapter->s = slave_new(&memory, adapter, log_to_host, logging, name, token, resources);
  slave_call_ends(adapter, host);
  if (adapter->s == NULL) {
    free_adapter(adapter);
    return NULL;
  }
  for (size_t i = 0; i < n_intermediate; i++) {
    if (intermediate != NULL && intermediate[i] < fmi3_the_table.n_arrays) continue;
    slave_log(adapter->s, SLAVE_ERROR, "There is no variable with value reference %u for an intermediate update.",
              intermediate != NULL ? (unsigned)intermediate[i] : 0U);
    free_adapter(adapter);
    return NULL;
  }
  adapter->update = update;
  adapter->s->request_inputs = update != NULL && n_intermediate > 0 ? request_inputs : NULL;
  adapter->s->early_return = early_return;
  adapter->items[1] = adapter->items[0] + capacity;
  adapter->derivative = adapter->unit + capacity;
  return adapter;
}

FMI3_EXPORT void FMI3_NAME(fmi3FreeInstance)(fmi3Instance instance) {
  if (instance != NULL) free_adapter(instance);
}

FMI3_ENTRY(fmi3EnterInitializationMode,
           (fmi3Instance instance, fmi3Boolean tolerance_defined, fmi3Float64 tolerance, fmi3Float64 start,
            fmi3Boolean stop_defined, fmi3Float64 stop),
           (instance, tolerance_defined, tolerance, start, stop_defined, stop)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3EnterInitializationMode", SLAVE_INSTANTIATED);
  if (adapter == NULL || !slave_check_tolerance(adapter->s, tolerance_defined, tolerance)) return fmi3Error;
  if (slave_setup(adapter->s, start, stop_defined, stop) != SLAVE_OK) return fmi3Error;
  return (fmi3Status)slave_enter(adapter->s);
}

FMI3_ENTRY(fmi3ExitInitializationMode, (fmi3Instance instance), (instance)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3ExitInitializationMode", SLAVE_INITIALISING);
  return adapter != NULL ? (fmi3Status)slave_exit(adapter->s) : fmi3Error;
}

FMI3_ENTRY(fmi3Terminate, (fmi3Instance instance), (instance)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3Terminate", FMI3_RUN);
  return adapter != NULL ? (fmi3Status)slave_terminate(adapter->s) : fmi3Error;
}

FMI3_ENTRY(fmi3Reset, (fmi3Instance instance), (instance)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3Reset", FMI3_ANY);
  return adapter != NULL ? (fmi3Status)slave_reset(adapter->s) : fmi3Error;
}
