/* The library of an FMI 2.0 co-simulation FMU, opened at run time, for one source file that drives it. */
#ifndef FMI2_LIBRARY_H
#define FMI2_LIBRARY_H
#include <string.h>

#include "../../../hosts/c/library.h"
#include "fmi2.h"

typedef struct {
  fmi2Component (*instantiate)(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions *, fmi2Boolean,
                               fmi2Boolean);
  fmi2Status (*setup)(fmi2Component, fmi2Boolean, fmi2Real, fmi2Real, fmi2Boolean, fmi2Real);
  fmi2Status (*enter)(fmi2Component), (*leave)(fmi2Component);
  fmi2Status (*step)(fmi2Component, fmi2Real, fmi2Real, fmi2Boolean);
  fmi2Status (*get)(fmi2Component, const fmi2ValueReference *, size_t, fmi2Real *);
  fmi2Status (*set)(fmi2Component, const fmi2ValueReference *, size_t, const fmi2Real *);
  fmi2Status (*set_whole)(fmi2Component, const fmi2ValueReference *, size_t, const fmi2Integer *);
  fmi2Status (*get_state)(fmi2Component, fmi2FMUstate *), (*set_state)(fmi2Component, fmi2FMUstate);
  fmi2Status (*free_state)(fmi2Component, fmi2FMUstate *);
  fmi2Status (*state_size)(fmi2Component, fmi2FMUstate, size_t *);
  fmi2Status (*to_bytes)(fmi2Component, fmi2FMUstate, fmi2Byte *, size_t);
  fmi2Status (*from_bytes)(fmi2Component, const fmi2Byte *, size_t, fmi2FMUstate *);
  void (*release)(fmi2Component);
} fmi2_library;

/* Ends the program where the library or one of its functions is not there. */
static fmi2_library load_library(const char *path) {
  fmi2_library fmu;
  const struct {
    void *place;
    const char *name;
  } functions[] = {{&fmu.instantiate, "fmi2Instantiate"},
                   {&fmu.setup, "fmi2SetupExperiment"},
                   {&fmu.enter, "fmi2EnterInitializationMode"},
                   {&fmu.leave, "fmi2ExitInitializationMode"},
                   {&fmu.step, "fmi2DoStep"},
                   {&fmu.get, "fmi2GetReal"},
                   {&fmu.set, "fmi2SetReal"},
                   {&fmu.set_whole, "fmi2SetInteger"},
                   {&fmu.get_state, "fmi2GetFMUstate"},
                   {&fmu.set_state, "fmi2SetFMUstate"},
                   {&fmu.free_state, "fmi2FreeFMUstate"},
                   {&fmu.state_size, "fmi2SerializedFMUstateSize"},
                   {&fmu.to_bytes, "fmi2SerializeFMUstate"},
                   {&fmu.from_bytes, "fmi2DeSerializeFMUstate"},
                   {&fmu.release, "fmi2FreeInstance"}};
  void *library = open_library(path);
  if (library == NULL) stop(2, "%s cannot be loaded", path);
  for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
    void *found = function(library, functions[i].name);
    memcpy(functions[i].place, &found, sizeof found);
  }
  return fmu;
}

static void good(fmi2Status status, const char *what) {
  if (status > fmi2Warning) stop(4, "%s: status %d", what, (int)status);
}

/* From setup to the end of initialisation. */
static void initialise(const fmi2_library *fmu, fmi2Component c) {
  good(fmu->setup(c, 0, 0.0, 0.0, 0, 0.0), "setup");
  good(fmu->enter(c), "enter");
  good(fmu->leave(c), "leave");
}
#endif
