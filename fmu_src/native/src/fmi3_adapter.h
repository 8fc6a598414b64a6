/* The adapter between FMI 3.0 and the slave: the instance that a host holds, arrays of variables, and checks that its
 * functions share. */
#ifndef ALI3_FMI3_ADAPTER_H
#define ALI3_FMI3_ADAPTER_H
#include "fmi3.h"
#include "slave.h"

/* Arrays of the table's variables, generated with the FMU (table.c): the value reference is the number of an array;
 * its items are variables first[i] .. first[i + 1] - 1 of `item`. Time is one of the arrays, without items. */
typedef struct {
  const uint32_t *item;
  const size_t *first;
  size_t n_arrays;
  fmi3ValueReference time;
} fmi3_table;

extern const fmi3_table fmi3_the_table;

typedef struct {
  ali3_float_control control; /* of the host; first, as float_control.c reads it at the address of an instance */
  fmi3InstanceEnvironment environment;
  fmi3LogMessageCallback log;
  fmi3IntermediateUpdateCallback update;
  bool updating; /* during the host's intermediate update */
  slave *s;
  uint32_t *items[2];        /* work: expanded value references, `capacity` each */
  double *unit, *derivative; /* work: seed vector and directional derivatives, `capacity` each */
  size_t capacity;           /* number of variables */
} fmi3_adapter;

/* Defines a function of an instance, called with the floating-point control that the kernel needs. */
#define FMI3_ENTRY(name, parameters, arguments)                                                                        \
  SLAVE_ENTRY(FMI3_EXPORT fmi3Status FMI3_NAME(name), fmi3Status, name, instance, parameters, arguments)

enum {
  FMI3_ANY = SLAVE_INSTANTIATED | SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED | SLAVE_TERMINATED,
  FMI3_SET = SLAVE_INSTANTIATED | SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED,
  FMI3_DERIVE = SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED | SLAVE_TERMINATED,
  FMI3_RUN = SLAVE_STEPPING | SLAVE_STEP_FAILED
};

/* The adapter of an instance if the function may be called in its phase; otherwise NULL, and an error was logged. */
fmi3_adapter *fmi3_slave(fmi3Instance instance, const char *function, unsigned phases);
/* Logs an error if a required pointer of the call is NULL; returns `valid`. */
bool fmi3_check_pointers(fmi3_adapter *adapter, const char *function, bool valid);
/* Writes the indices of the variables of n arrays to adapter->items[list]. False: a reference is unknown or the arrays
 * do not have n_values values, and an error was logged. */
bool fmi3_expand(fmi3_adapter *adapter, int list, const fmi3ValueReference *reference, size_t n, size_t n_values);
/* Number of values of one array, 1 for time. The reference must be below n_arrays. */
size_t fmi3_array_size(fmi3ValueReference reference);
/* Whether the references, which may include time, are known and have n_values values; if not, an error is logged. */
bool fmi3_check_count(fmi3_adapter *adapter, const fmi3ValueReference *reference, size_t n, size_t n_values);
#endif
