/* PythonFMU's export library and the interpreter it needs. */
#ifndef ALI3_PYTHONFMU_H
#define ALI3_PYTHONFMU_H
#include "fmi2.h"

typedef struct { /* its functions that are used here */
  fmi2Component (*instantiate)(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions *, fmi2Boolean,
                               fmi2Boolean);
  void (*free_instance)(fmi2Component);
  fmi2Status (*setup)(fmi2Component, fmi2Boolean, fmi2Real, fmi2Real, fmi2Boolean, fmi2Real);
  fmi2Status (*enter)(fmi2Component), (*exit)(fmi2Component), (*terminate)(fmi2Component), (*reset)(fmi2Component);
  fmi2Status (*step)(fmi2Component, fmi2Real, fmi2Real, fmi2Boolean);
  fmi2Status (*get_real)(fmi2Component, const fmi2ValueReference *, size_t, fmi2Real *);
  fmi2Status (*set_real)(fmi2Component, const fmi2ValueReference *, size_t, const fmi2Real *);
  fmi2Status (*get_integer)(fmi2Component, const fmi2ValueReference *, size_t, fmi2Integer *);
  fmi2Status (*set_integer)(fmi2Component, const fmi2ValueReference *, size_t, const fmi2Integer *);
  void (*release_record)(void); /* of the interpreter */
  /* and Python's */
  int (*is_initialized)(void); /* 0 from the end of the exit handlers on */
  int (*enter_python)(void);
  void (*leave_python)(int);
} pythonfmu;

/* Loads PythonFMU's library, which lies beside this one, and libpython for hosts that are not Python programs. NULL on
 * failure, with a sentence in `problem`. */
const pythonfmu *pythonfmu_load(char *problem, size_t size);
#endif
