/* The adapter between FMI 2.0 and the slave: the instance that a host holds, and checks that its functions share. */
#ifndef ALI3_FMI2_ADAPTER_H
#define ALI3_FMI2_ADAPTER_H
#include "fmi2.h"
#include "slave.h"

typedef struct {
  ali3_float_control control; /* of the host; first, as float_control.c reads it at the address of an instance */
  fmi2CallbackFunctions host; /* logger and memory */
  slave *s;
  void *python; /* PythonFMU's instance; NULL in the native FMU */
} fmi2_adapter;

/* The calls that PythonFMU also has, with the arguments of slave_new, slave_setup and the others in slave.h. The native
 * FMU calls the slave directly (fmi2_direct.c), the Python FMU through its class (python_slave/python_calls.c). */
slave *fmi2_new(fmi2_adapter *adapter, const ali3_memory *memory, slave_logger *logger, bool logging, const char *name,
                const char *token, const char *resources);
void fmi2_free(fmi2_adapter *adapter);
slave_status fmi2_setup(slave *s, double start_time, bool stop_defined, double stop_time);
slave_status fmi2_enter(slave *s);
slave_status fmi2_exit(slave *s);
slave_status fmi2_step(slave *s, double time, double step);
slave_status fmi2_terminate(slave *s);
slave_status fmi2_reset(slave *s);
slave_status fmi2_get(slave *s, const uint32_t *reference, size_t n, double *value);
slave_status fmi2_set(slave *s, const uint32_t *reference, size_t n, const double *value);
slave_status fmi2_get_whole(slave *s, const uint32_t *reference, size_t n, int32_t *value);
slave_status fmi2_set_whole(slave *s, const uint32_t *reference, size_t n, const int32_t *value);

/* Defines a function of an instance, called with the floating-point control that the kernel needs. */
#define FMI2_ENTRY(name, parameters, arguments)                                                                        \
  SLAVE_ENTRY(FMI2_EXPORT fmi2Status FMI2_NAME(name), fmi2Status, name, c, parameters, arguments)

/* Phases in which calls are allowed, by the standard's table for co-simulation. */
enum {
  FMI2_ANY = SLAVE_INSTANTIATED | SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED | SLAVE_TERMINATED,
  FMI2_SET = SLAVE_INSTANTIATED | SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED,
  FMI2_GET = SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED | SLAVE_TERMINATED,
  FMI2_RUN = SLAVE_STEPPING | SLAVE_STEP_FAILED,
  FMI2_DONE = SLAVE_STEPPING | SLAVE_STEP_FAILED | SLAVE_TERMINATED
};

/* The slave of a component if the function may be called now, otherwise NULL. */
slave *fmi2_slave(fmi2Component c, const char *function, unsigned phases);
/* Logs an error if a required pointer of the call is NULL; returns `valid`. */
bool fmi2_check_pointers(slave *s, const char *function, bool valid);
#endif
