/* FMI 2.0: inquiry, instances, initialisation, end, logging. */
#include <stdlib.h>
#include <string.h>

#include "fmi2_adapter.h"

slave *fmi2_slave(fmi2Component c, const char *function, unsigned phases) {
  fmi2_adapter *adapter = c;
  return adapter != NULL && slave_is_allowed(adapter->s, function, phases) ? adapter->s : NULL;
}

bool fmi2_check_pointers(slave *s, const char *function, bool valid) {
  if (!valid) slave_log(s, SLAVE_ERROR, "%s was called with a null pointer.", function);
  return valid;
}

/* The text is the format string itself, with % and # doubled: hosts that do not format it show it too. */
static void log_to_host(slave *s, slave_status status, const char *category, const char *text) {
  fmi2_adapter *adapter = s->host;
  char format[2 * SLAVE_TEXT];
  size_t n = 0;
  if (adapter->host.logger == NULL) return;
  for (; *text != 0 && n + 2 < sizeof format; text++) {
    if (*text == '%' || *text == '#') format[n++] = *text;
    format[n++] = *text;
  }
  format[n] = 0;
  const ali3_float_control host = slave_call_leaves(adapter);
  adapter->host.logger(adapter->host.componentEnvironment, s->name != NULL ? s->name : "", (fmi2Status)status, category,
                       format);
  slave_call_returns(adapter, host);
}

FMI2_EXPORT const char *FMI2_NAME(fmi2GetTypesPlatform)(void) { return "default"; }

FMI2_EXPORT const char *FMI2_NAME(fmi2GetVersion)(void) { return "2.0"; }

/* Logs why no instance was made; slave_log needs one. */
static fmi2Component refuse(const fmi2CallbackFunctions *functions, fmi2String name, fmi2String text) {
  if (functions->logger != NULL)
    functions->logger(functions->componentEnvironment, name != NULL ? name : "", fmi2Error, "logStatusError", text);
  return NULL;
}

FMI2_EXPORT fmi2Component FMI2_NAME(fmi2Instantiate)(fmi2String name, fmi2Type type, fmi2String guid,
                                                     fmi2String resources, const fmi2CallbackFunctions *functions,
                                                     fmi2Boolean visible, fmi2Boolean logging) {
  char path[SLAVE_PATH];
  ali3_memory memory = {calloc, free};
  (void)visible;
  if (functions == NULL) return NULL;
  if (functions->allocateMemory != NULL && functions->freeMemory != NULL) {
    memory.allocate = functions->allocateMemory;
    memory.release = functions->freeMemory;
  }
  if (type != fmi2CoSimulation) return refuse(functions, name, "This FMU is for co-simulation only.");
  if (resources != NULL && !slave_path_of_uri(resources, path, sizeof path))
    return refuse(functions, name, "The location of the resources is too long.");
  fmi2_adapter *adapter = memory.allocate(1, sizeof *adapter);
  if (adapter == NULL) return refuse(functions, name, "There is not enough memory for an instance.");
  adapter->host = *functions;
  const ali3_float_control host = slave_call_begins(adapter);
  adapter->s = fmi2_new(adapter, &memory, log_to_host, logging != 0, name, guid, resources != NULL ? path : NULL);
  slave_call_ends(adapter, host);
  if (adapter->s != NULL) return adapter;
  memory.release(adapter);
  return NULL;
}

FMI2_EXPORT void FMI2_NAME(fmi2FreeInstance)(fmi2Component c) {
  fmi2_adapter *adapter = c;
  if (adapter == NULL) return;
  void (*const release)(void *) = adapter->s->memory.release;
  fmi2_free(adapter);
  release(adapter);
}

FMI2_ENTRY(fmi2SetDebugLogging, (fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[]),
           (c, on, n, categories)) {
  slave *s = fmi2_slave(c, "fmi2SetDebugLogging", FMI2_ANY);
  return s != NULL ? (fmi2Status)slave_set_logging(s, on != 0, n, categories) : fmi2Error;
}

FMI2_ENTRY(fmi2SetupExperiment,
           (fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance, fmi2Real start,
            fmi2Boolean stop_defined, fmi2Real stop),
           (c, tolerance_defined, tolerance, start, stop_defined, stop)) {
  slave *s = fmi2_slave(c, "fmi2SetupExperiment", SLAVE_INSTANTIATED);
  if (s == NULL || !slave_check_tolerance(s, tolerance_defined != 0, tolerance)) return fmi2Error;
  return (fmi2Status)fmi2_setup(s, start, stop_defined != 0, stop);
}

FMI2_ENTRY(fmi2EnterInitializationMode, (fmi2Component c), (c)) {
  slave *s = fmi2_slave(c, "fmi2EnterInitializationMode", SLAVE_INSTANTIATED);
  return s != NULL ? (fmi2Status)fmi2_enter(s) : fmi2Error;
}

FMI2_ENTRY(fmi2ExitInitializationMode, (fmi2Component c), (c)) {
  slave *s = fmi2_slave(c, "fmi2ExitInitializationMode", SLAVE_INITIALISING);
  return s != NULL ? (fmi2Status)fmi2_exit(s) : fmi2Error;
}

FMI2_ENTRY(fmi2Terminate, (fmi2Component c), (c)) {
  slave *s = fmi2_slave(c, "fmi2Terminate", FMI2_RUN);
  return s != NULL ? (fmi2Status)fmi2_terminate(s) : fmi2Error;
}

FMI2_ENTRY(fmi2Reset, (fmi2Component c), (c)) {
  slave *s = fmi2_slave(c, "fmi2Reset", FMI2_ANY);
  return s != NULL ? (fmi2Status)fmi2_reset(s) : fmi2Error;
}
