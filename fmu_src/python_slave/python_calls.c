/* Calls through Python. The library that a host loads is the slave in C with its FMI 2.0 adapter; the calls that
 * PythonFMU knows go to PythonFMU's export library, which lies beside it as <this library>-pythonfmu, to the class in
 * Python (slave.py) and from there back to the slave, by the functions of a python_link. The status of the slave stays
 * in the link, since PythonFMU knows OK, Discard and Fatal only. */
#include <stdio.h>
#include <string.h>

#include "fmi2_adapter.h"
#include "pythonfmu.h"

typedef struct { /* what slave.py reads and writes, in this order */
  slave *s;
  const char *name; /* of the instance */
  int32_t answer;   /* status of the slave in the present call */
  slave_status (*setup)(slave *, double, bool, double);
  slave_status (*enter)(slave *);
  slave_status (*exit)(slave *);
  slave_status (*step)(slave *, double, double);
  slave_status (*terminate)(slave *);
  slave_status (*get)(slave *, const uint32_t *, size_t, double *);
  slave_status (*set)(slave *, const uint32_t *, size_t, const double *);
  slave_status (*get_whole)(slave *, const uint32_t *, size_t, int32_t *);
  slave_status (*set_whole)(slave *, const uint32_t *, size_t, const int32_t *);
} python_link;

typedef struct {
  python_link link;
  fmi2CallbackFunctions callbacks; /* PythonFMU keeps a pointer to them */
  fmi2Component inner;             /* PythonFMU's instance; NULL once an exception of Python has ended it */
} python_instance;

static const pythonfmu *py; /* loaded with the first instance; it stays, as the interpreter does */

/* PythonFMU hands over finished text: an exception of Python, or what the class in Python logs. */
static void log_of_python(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                          fmi2String text, ...) {
  const python_instance *d = environment;
  (void)name, (void)category;
  slave_log(d->link.s, status >= fmi2Error ? SLAVE_ERROR : (slave_status)status, "%s", text);
}

/* PythonFMU reads this file without a look at what it is. */
static bool has_module(slave *s) {
  const char *why;
  size_t size = 0;
  unsigned char *text = slave_read_resource(s->resources, "slavemodule.txt", &s->memory, &size, &why);
  if (text == NULL) {
    slave_log(s, SLAVE_ERROR, "The file slavemodule.txt of the FMU cannot be read in %s: %s.", s->resources, why);
    return false;
  }
  s->memory.release(text);
  return true;
}

/* The slave then answers at once: a host may call from exit handlers and destructors that come after the interpreter. */
static bool python_has_ended(void) { return py != NULL && !py->is_initialized(); }

/* Makes PythonFMU's instance; true without one once the interpreter has ended. False: an error was logged. */
static bool start_python(python_instance *d) {
  slave *s = d->link.s;
  char address[32], uri[SLAVE_PATH + 16], problem[SLAVE_TEXT / 2];
  if (python_has_ended()) return true;
  if (!has_module(s)) return false;
  if (py == NULL) py = pythonfmu_load(problem, sizeof problem);
  if (py == NULL) {
    slave_log(s, SLAVE_ERROR, "%s", problem);
    return false;
  }
  /* PythonFMU decodes nothing of a URI but %20; the class in Python finds its link by the name of its instance */
  snprintf(uri, sizeof uri, s->resources[0] == '/' ? "file://%s" : "file:///%s", s->resources);
  snprintf(address, sizeof address, "%llu", (unsigned long long)(uintptr_t)&d->link);
  d->inner = py->instantiate(address, fmi2CoSimulation, slave_the_table.token, uri, &d->callbacks, 0, 1);
  if (d->inner == NULL) slave_log(s, SLAVE_ERROR, "PythonFMU could not make the instance.");
  return d->inner != NULL;
}

slave *fmi2_new(fmi2_adapter *adapter, const ali3_memory *memory, slave_logger *logger, bool logging, const char *name,
                const char *token, const char *resources) {
  slave *s = slave_new(memory, adapter, logger, logging, name, token, resources);
  if (s == NULL) return NULL;
  python_instance *d = memory->allocate(1, sizeof *d);
  adapter->s = s;
  adapter->python = d;
  if (d != NULL) {
    const python_instance fresh = {{s, s->name, 0, slave_setup, slave_enter, slave_exit, slave_step, slave_terminate,
                                    slave_get, slave_set, slave_get_whole, slave_set_whole},
                                   {log_of_python, memory->allocate, memory->release, NULL, d},
                                   NULL};
    *d = fresh;
  }
  if (d != NULL && start_python(d)) return s;
  if (d == NULL) slave_log(s, SLAVE_ERROR, "There is not enough memory for an instance.");
  fmi2_free(adapter);
  return NULL;
}

void fmi2_free(fmi2_adapter *adapter) {
  python_instance *d = adapter->python;
  slave *s = adapter->s;
  if (d != NULL && d->inner != NULL && !python_has_ended()) {
    /* At its end the interpreter ends threads that wait for it; in PythonFMU's destructor that would abort the host. */
    const int state = py->enter_python();
    py->free_instance(d->inner);
    py->leave_python(state);
  }
  if (d != NULL) s->memory.release(d);
  slave_free(s);
}

/* PythonFMU's instance behind a slave, or NULL if the interpreter has ended or, which is logged, after an exception of
 * Python. */
static python_instance *begin(slave *s) {
  python_instance *d = ((fmi2_adapter *)s->host)->python;
  d->link.answer = SLAVE_ERROR; /* unless Python brings another one */
  if (python_has_ended()) return NULL;
  if (d->inner != NULL) return d;
  slave_log(s, SLAVE_ERROR, "An exception has ended the Python part of this instance; it can only be freed.");
  return NULL;
}

/* Of a call that did not go to Python. */
#define AT_ONCE(call) (python_has_ended() ? (call) : SLAVE_ERROR)

/* PythonFMU frees its instance after an exception. */
static slave_status end(python_instance *d, fmi2Status status) {
  if (status < fmi2Error) return (slave_status)d->link.answer;
  d->inner = NULL;
  return SLAVE_ERROR;
}

slave_status fmi2_setup(slave *s, double start_time, bool stop_defined, double stop_time) {
  python_instance *d = begin(s);
  return d != NULL ? end(d, py->setup(d->inner, 0, 0.0, start_time, stop_defined, stop_time))
                   : AT_ONCE(slave_setup(s, start_time, stop_defined, stop_time));
}

slave_status fmi2_enter(slave *s) {
  python_instance *d = begin(s);
  return d != NULL ? end(d, py->enter(d->inner)) : AT_ONCE(slave_enter(s));
}

slave_status fmi2_exit(slave *s) {
  python_instance *d = begin(s);
  return d != NULL ? end(d, py->exit(d->inner)) : AT_ONCE(slave_exit(s));
}

slave_status fmi2_step(slave *s, double time, double step) {
  python_instance *d = begin(s);
  return d != NULL ? end(d, py->step(d->inner, time, step, 0)) : AT_ONCE(slave_step(s, time, step));
}

slave_status fmi2_terminate(slave *s) {
  python_instance *d = begin(s);
  return d != NULL ? end(d, py->terminate(d->inner)) : AT_ONCE(slave_terminate(s));
}

/* PythonFMU makes a new object of the class, which finds the same link. */
slave_status fmi2_reset(slave *s) {
  python_instance *d = begin(s);
  if (d == NULL) return AT_ONCE(slave_reset(s));
  d->link.answer = SLAVE_OK;
  const slave_status status = end(d, py->reset(d->inner));
  return status == SLAVE_OK ? slave_reset(s) : status;
}

slave_status fmi2_get(slave *s, const uint32_t *reference, size_t n, double *value) {
  python_instance *d = begin(s);
  return d != NULL ? end(d, py->get_real(d->inner, reference, n, value)) : AT_ONCE(slave_get(s, reference, n, value));
}

slave_status fmi2_set(slave *s, const uint32_t *reference, size_t n, const double *value) {
  python_instance *d = begin(s);
  return d != NULL ? end(d, py->set_real(d->inner, reference, n, value)) : AT_ONCE(slave_set(s, reference, n, value));
}

slave_status fmi2_get_whole(slave *s, const uint32_t *reference, size_t n, int32_t *value) {
  python_instance *d = begin(s);
  return d != NULL ? end(d, py->get_integer(d->inner, reference, n, value))
                   : AT_ONCE(slave_get_whole(s, reference, n, value));
}

slave_status fmi2_set_whole(slave *s, const uint32_t *reference, size_t n, const int32_t *value) {
  python_instance *d = begin(s);
  return d != NULL ? end(d, py->set_integer(d->inner, reference, n, value))
                   : AT_ONCE(slave_set_whole(s, reference, n, value));
}
