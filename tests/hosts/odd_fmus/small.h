/* A whole FMU of FMI 2.0 for co-simulation around one function: an input, an output, one number as its state.

   Who includes it defines `advance`. */
#include "alike.h"

typedef struct {
  double time, u, y;
} small;

/* The step from `s->time` to `end`. */
static fmi2Status advance(small *s, double end);

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
  (void)type, (void)resources, (void)visible;
  if (*name && !strcmp(guid, "{small}")) return calloc(1, sizeof(small));
  if (logging) functions->logger(functions->componentEnvironment, name, fmi2OK, "info", "another GUID");
  return NULL;
}

void fmi2FreeInstance(fmi2Component c) { free(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerant, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean ends, fmi2Real stop) {
  (void)tolerant, (void)tolerance, (void)ends, (void)stop;
  ((small *)c)->time = start;
  return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return c ? fmi2OK : fmi2Error; }
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return c ? fmi2OK : fmi2Error; }
fmi2Status fmi2Terminate(fmi2Component c) { return c ? fmi2OK : fmi2Error; }

fmi2Status fmi2Reset(fmi2Component c) {
  memset(c, 0, sizeof(small));
  return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real v[]) {
  for (size_t k = 0; k < n; k++) {
    if (r[k] > 1) return fmi2Error;
    v[k] = r[k] ? ((small *)c)->y : ((small *)c)->u;
  }
  return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real v[]) {
  for (size_t k = 0; k < n; k++) {
    if (r[k]) return fmi2Error;
    ((small *)c)->u = v[k];
  }
  return fmi2OK;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
  if (!*state) *state = malloc(sizeof(small));
  memcpy(*state, c, sizeof(small));
  return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  memcpy(c, state, sizeof(small));
  return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
  (void)c, (void)state;
#ifdef STATE_SIZE
  *size = STATE_SIZE;
#else
  *size = sizeof(small);
#endif
  return fmi2OK;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference z[], size_t nz,
                                        const fmi2ValueReference v[], size_t nv, const fmi2Real dv[], fmi2Real dz[]) {
  (void)c, (void)z, (void)nz, (void)v, (void)nv, (void)dv, (void)dz;
  return fmi2Error;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean forward) {
  (void)forward;
  return advance(c, time + step);
}
