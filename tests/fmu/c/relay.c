/* Hands a state on: relay LIBRARY RESOURCES_URI GUID (save | load) FILE
 * "save" makes 30 steps, writes the state to FILE, goes on; "load" goes on from FILE. Both print the outputs after. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#include <windows.h>
static void *open_library(const char *path) { return (void *)LoadLibraryA(path); }
static void *find(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }
#else
#include <dlfcn.h>
static void *open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *find(void *library, const char *name) { return dlsym(library, name); }
#endif

#include "fmi2.h"

enum { STEPS = 30, FIRST = 3, LAST = 7, MOST_BYTES = 1 << 20 };

static fmi2Component (*instantiate)(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions *,
                                    fmi2Boolean, fmi2Boolean);
static fmi2Status (*setup)(fmi2Component, fmi2Boolean, fmi2Real, fmi2Real, fmi2Boolean, fmi2Real);
static fmi2Status (*enter)(fmi2Component), (*leave)(fmi2Component);
static fmi2Status (*step)(fmi2Component, fmi2Real, fmi2Real, fmi2Boolean);
static fmi2Status (*get)(fmi2Component, const fmi2ValueReference *, size_t, fmi2Real *);
static fmi2Status (*set)(fmi2Component, const fmi2ValueReference *, size_t, const fmi2Real *);
static fmi2Status (*get_state)(fmi2Component, fmi2FMUstate *), (*set_state)(fmi2Component, fmi2FMUstate);
static fmi2Status (*state_size)(fmi2Component, fmi2FMUstate, size_t *);
static fmi2Status (*to_bytes)(fmi2Component, fmi2FMUstate, fmi2Byte *, size_t);
static fmi2Status (*from_bytes)(fmi2Component, const fmi2Byte *, size_t, fmi2FMUstate *);

static void good(fmi2Status status, const char *what) {
  if (status <= fmi2Warning) return;
  fprintf(stderr, "%s: status %d\n", what, (int)status);
  exit(4);
}

static void load(const char *path) {
  struct {
    void *place;
    const char *name;
  } const functions[] = {{&instantiate, "fmi2Instantiate"},
                         {&setup, "fmi2SetupExperiment"},
                         {&enter, "fmi2EnterInitializationMode"},
                         {&leave, "fmi2ExitInitializationMode"},
                         {&step, "fmi2DoStep"},
                         {&get, "fmi2GetReal"},
                         {&set, "fmi2SetReal"},
                         {&get_state, "fmi2GetFMUstate"},
                         {&set_state, "fmi2SetFMUstate"},
                         {&state_size, "fmi2SerializedFMUstateSize"},
                         {&to_bytes, "fmi2SerializeFMUstate"},
                         {&from_bytes, "fmi2DeSerializeFMUstate"}};
  void *library = open_library(path);
  for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
    void *found = library != NULL ? find(library, functions[i].name) : NULL;
    if (found == NULL) exit(2);
    memcpy(functions[i].place, &found, sizeof found);
  }
}

static void go_on(fmi2Component c, int from, int print) {
  fmi2ValueReference reference[LAST - FIRST + 1];
  double value[LAST - FIRST + 1];
  for (int i = FIRST; i <= LAST; i++) reference[i - FIRST] = (fmi2ValueReference)i;
  for (int k = from; k < from + STEPS; k++) {
    good(step(c, 0.01 * k, 0.01, 1), "step");
    good(get(c, reference, LAST - FIRST + 1, value), "get");
    for (int i = 0; print && i <= LAST - FIRST; i++) printf("%a%c", value[i], i < LAST - FIRST ? ' ' : '\n');
  }
}

int main(int count, char **argument) {
  static fmi2Byte bytes[MOST_BYTES];
  const fmi2CallbackFunctions callbacks = {NULL, calloc, free, NULL, NULL};
  const fmi2ValueReference input = 0;
  const double u = 3.5;
  fmi2FMUstate state = NULL;
  size_t size = 0;
  if (count < 6) return 1;
  load(argument[1]);
  fmi2Component c = instantiate("relay", fmi2CoSimulation, argument[3], argument[2], &callbacks, 0, 0);
  if (c == NULL) return 3;
  const int saves = strcmp(argument[4], "save") == 0;
  FILE *file = fopen(argument[5], saves ? "wb" : "rb");
  if (file == NULL) return 5;
  if (saves) {
    good(setup(c, 0, 0.0, 0.0, 0, 0.0), "setup");
    good(enter(c), "enter");
    good(leave(c), "leave");
    good(set(c, &input, 1, &u), "set");
    go_on(c, 0, 0);
    good(get_state(c, &state), "get state");
    good(state_size(c, state, &size), "size");
    if (size > MOST_BYTES) return 6;
    good(to_bytes(c, state, bytes, size), "serialise");
    if (fwrite(bytes, 1, size, file) != size) return 7;
  } else {
    size = fread(bytes, 1, MOST_BYTES, file);
    good(from_bytes(c, bytes, size, &state), "deserialise");
    good(set_state(c, state), "set state");
  }
  fclose(file);
  go_on(c, STEPS, 1);
  return 0;
}
