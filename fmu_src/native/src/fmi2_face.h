/* What the files of the FMI 2.0 face share. */
#ifndef ALI3_FMI2_FACE_H
#define ALI3_FMI2_FACE_H
#include "fmi2.h"
#include "slave.h"

typedef struct {
  fmi2CallbackFunctions host;
  slave *s;
} fmi2_face;

/* Calls allowed in the states of the standard's table for co-simulation. */
enum {
  FMI2_ANY = SLAVE_INSTANTIATED | SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED | SLAVE_TERMINATED,
  FMI2_SET = SLAVE_INSTANTIATED | SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED,
  FMI2_GET = SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED | SLAVE_TERMINATED,
  FMI2_RUN = SLAVE_STEPPING | SLAVE_STEP_FAILED,
  FMI2_DONE = SLAVE_STEPPING | SLAVE_STEP_FAILED | SLAVE_TERMINATED
};

/* The slave of a component if the function may be called now, else NULL. */
slave *fmi2_slave(fmi2Component c, const char *function, unsigned mask);
/* Whether pointers that are needed are there; said if not. */
bool fmi2_given(slave *s, const char *function, bool given);
#endif
