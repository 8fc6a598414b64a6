/* What the files of the FMI 3.0 face share. */
#ifndef ALI3_FMI3_FACE_H
#define ALI3_FMI3_FACE_H
#include "fmi3.h"
#include "slave.h"

/* Arrays of the table's variables, generated with the FMU (table.c): the value reference is the number of an array;
 * its items are variables first[i] .. first[i + 1] - 1 of `item`. Time stands among them, without items. */
typedef struct {
  const uint32_t *item;
  const size_t *first;
  size_t n_arrays;
  fmi3ValueReference time;
} fmi3_table;

extern const fmi3_table fmi3_the_table;

typedef struct {
  ali3_float_control control; /* first, see float_control.c */
  fmi3InstanceEnvironment environment;
  fmi3LogMessageCallback log;
  fmi3IntermediateUpdateCallback update;
  bool updating; /* the host is in its intermediate update */
  slave *s;
  uint32_t *items[2]; /* work: expanded value references */
  double *one, *all;  /* work: a value per variable */
  size_t room;
} fmi3_face;

/* A function of an instance that computes: with the control of the processor that arithmetic here needs. */
#define FMI3_ENTRY(name, parameters, arguments)                                                                        \
  SLAVE_ENTRY(FMI3_EXPORT fmi3Status FMI3_NAME(name), fmi3Status, name, instance, parameters, arguments)

enum {
  FMI3_ANY = SLAVE_INSTANTIATED | SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED | SLAVE_TERMINATED,
  FMI3_SET = SLAVE_INSTANTIATED | SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED,
  FMI3_DERIVE = SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED | SLAVE_TERMINATED,
  FMI3_RUN = SLAVE_STEPPING | SLAVE_STEP_FAILED
};

/* The face of an instance if the function may be called now, else NULL. */
fmi3_face *fmi3_slave(fmi3Instance instance, const char *function, unsigned mask);
bool fmi3_given(fmi3_face *face, const char *function, bool given);
/* Numbers of variables of arrays into face->items[which]; false, and said, if a reference is unknown or the count is
 * not n_values. */
bool fmi3_expand(fmi3_face *face, int which, const fmi3ValueReference *reference, size_t n, size_t n_values);
/* Values of one array; time is one value. The reference must be below n_arrays. */
size_t fmi3_size(fmi3ValueReference reference);
/* Whether the references, time among them, are known and have n_values values; said if not. */
bool fmi3_counted(fmi3_face *face, const fmi3ValueReference *reference, size_t n, size_t n_values);
#endif
