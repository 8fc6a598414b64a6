/* The face of FMI 2.0 of `plants.h`. */
#include "plants.h"

#define FREE_STATE free_planted
#define MORE_BYTES SPILL

#include "alike.h"

typedef struct {
  planted p;
  const fmi2CallbackFunctions *functions;
} face;

static void say(const void *c, const char *text) {
  const face *f = c;
  f->functions->logger(f->functions->componentEnvironment, "planted", fmi2OK, PLANT == NO_CATEGORY ? NULL : "log",
                       text);
}

const char *fmi2GetVersion(void) { return PLANT == VERSION ? "1.0" : fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
  (void)type, (void)visible, (void)logging;
  if (!*name || strcmp(guid, "{small}") || !takes_path(resources) || !may_begin()) return NULL;
  face *f = calloc(1, sizeof *f);
  f->p = new_planted(), f->functions = functions;
  return f;
}

void fmi2FreeInstance(fmi2Component c) { free(c), alive--; }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerant, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean ends, fmi2Real stop) {
  (void)tolerant, (void)tolerance, (void)ends, (void)stop;
  ((face *)c)->p.time = begin_planted(start);
  return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  at_start(c);
  return c ? fmi2OK : fmi2Error;
}
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return c ? fmi2OK : fmi2Error; }
fmi2Status fmi2Terminate(fmi2Component c) {
  at_end();
  return c && PLANT != NO_END ? fmi2OK : fmi2Error;
}

fmi2Status fmi2Reset(fmi2Component c) {
  reset_planted(&((face *)c)->p);
  return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real v[]) {
  for (size_t k = 0; k < n; k++) {
    if (r[k] > 1) return fmi2Error;
    v[place_planted(r, n, k)] = read_planted(&((face *)c)->p, r[k]);
  }
  return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real v[]) {
  for (size_t k = 0; k < n; k++) {
    if (r[k]) return fmi2Error;
    set_planted(&((face *)c)->p, v[k]);
  }
  return fmi2OK;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
  if (!*state) *state = new_state();
  save_planted(*state, &((face *)c)->p);
  return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  take_planted(&((face *)c)->p, state);
  return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
  (void)c, (void)state;
  *size = STATE_SIZE;
  return fmi2OK;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference z[], size_t nz,
                                        const fmi2ValueReference v[], size_t nv, const fmi2Real dv[], fmi2Real dz[]) {
  if (nv != 1 || v[0] != 0) return fmi2Error;
  for (size_t k = 0; k < nz; k++) dz[k] = z[k] == 1 ? dv[0] * slope_planted(&((face *)c)->p) : 0.0;
  return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean forward) {
  (void)forward;
  if (!takes_time(&((face *)c)->p, time)) return fmi2Error;
  step_planted(c, &((face *)c)->p, step);
  return PLANT == WARNS ? fmi2Warning : fmi2OK;
}
