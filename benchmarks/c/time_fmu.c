/* Times the calls of an FMU from C, without Python in the loop.
 *   time_fmu LIBRARY RESOURCES_URI GUID STEP STEPS REPEATS N_OUTPUTS FIRST_OUTPUT INSTANCES
 * Prints one line "name value" per quantity, microseconds per call (the median of the repeats) or as named. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

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

enum { MOST_REPEATS = 64, MOST_VALUES = 4096 };

static size_t allocated; /* bytes of all live blocks, each with its size in front */

static void *counted_allocate(size_t n, size_t size) {
  size_t *block = calloc(1, n * size + 16);
  if (block == NULL) return NULL;
  block[0] = n * size;
  allocated += n * size;
  return (char *)block + 16;
}

static void counted_free(void *p) {
  if (p == NULL) return;
  size_t *block = (size_t *)((char *)p - 16);
  allocated -= block[0];
  free(block);
}

static double now(void) {
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  return (double)t.tv_sec * 1e6 + (double)t.tv_nsec * 1e-3;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(double *v, int n) {
  qsort(v, (size_t)n, sizeof *v, ascending);
  return n % 2 ? v[n / 2] : 0.5 * (v[n / 2 - 1] + v[n / 2]);
}

static void check(fmi2Status status, const char *what) {
  if (status <= fmi2Warning) return;
  fprintf(stderr, "%s: status %d\n", what, (int)status);
  exit(4);
}

static fmi2Component (*instantiate)(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions *,
                                    fmi2Boolean, fmi2Boolean);
static fmi2Status (*setup)(fmi2Component, fmi2Boolean, fmi2Real, fmi2Real, fmi2Boolean, fmi2Real);
static fmi2Status (*enter)(fmi2Component), (*leave)(fmi2Component);
static fmi2Status (*step)(fmi2Component, fmi2Real, fmi2Real, fmi2Boolean);
static fmi2Status (*get)(fmi2Component, const fmi2ValueReference *, size_t, fmi2Real *);
static fmi2Status (*set)(fmi2Component, const fmi2ValueReference *, size_t, const fmi2Real *);
static fmi2Status (*get_state)(fmi2Component, fmi2FMUstate *), (*set_state)(fmi2Component, fmi2FMUstate);
static fmi2Status (*free_state)(fmi2Component, fmi2FMUstate *);
static void (*release)(fmi2Component);
static fmi2CallbackFunctions callbacks = {NULL, counted_allocate, counted_free, NULL, NULL};
static char **argument;

static void load(void) {
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
                         {&free_state, "fmi2FreeFMUstate"},
                         {&release, "fmi2FreeInstance"}};
  void *library = open_library(argument[1]);
  for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
    void *found = library != NULL ? find(library, functions[i].name) : NULL;
    if (found == NULL) {
      fprintf(stderr, "%s cannot be loaded\n", argument[1]);
      exit(2);
    }
    memcpy(functions[i].place, &found, sizeof found);
  }
}

static fmi2Component started(void) {
  fmi2Component c = instantiate("timed", fmi2CoSimulation, argument[3], argument[2], &callbacks, 0, 0);
  if (c == NULL) {
    fprintf(stderr, "no instance\n");
    exit(3);
  }
  check(setup(c, 0, 0.0, 0.0, 0, 0.0), "setup");
  check(enter(c), "enter");
  check(leave(c), "leave");
  return c;
}

int main(int count, char **arguments) {
  static fmi2ValueReference reference[MOST_VALUES];
  static double value[MOST_VALUES];
  double wall[6][MOST_REPEATS];
  if (count < 10) return 1;
  argument = arguments;
  load();
  const double h = strtod(argument[4], NULL);
  const int steps = atoi(argument[5]), repeats = atoi(argument[6]), n = atoi(argument[7]), first = atoi(argument[8]);
  const int instances = atoi(argument[9]);
  if (repeats < 1 || repeats > MOST_REPEATS || n < 1 || n > MOST_VALUES || steps < 1) return 1;
  for (int i = 0; i < n; i++) reference[i] = (fmi2ValueReference)(first + i);
  const fmi2ValueReference input = 0;
  const double u = 0.1;
  for (int r = 0; r < repeats; r++) {
    double begin = now();
    fmi2Component c = started();
    wall[0][r] = now() - begin;
    check(set(c, &input, 1, &u), "set");
    begin = now();
    for (int k = 0; k < steps; k++) check(step(c, k * h, h, 1), "step");
    wall[1][r] = (now() - begin) / steps;
    double read = 0.0;
    begin = now();
    for (int k = 0; k < steps; k++) check(get(c, reference, (size_t)n, value), "get");
    wall[2][r] = (now() - begin) / steps;
    begin = now();
    for (int k = 0; k < steps; k++) {
      const double moving = u + 1e-6 * (k % 7);
      check(set(c, &input, 1, &moving), "set");
    }
    wall[3][r] = (now() - begin) / steps;
    fmi2FMUstate state = NULL;
    begin = now();
    for (int k = 0; k < steps; k++) {
      check(get_state(c, &state), "get state");
      check(set_state(c, state), "set state");
      check(free_state(c, &state), "free state");
    }
    wall[4][r] = (now() - begin) / steps;
    begin = now();
    for (int k = 0; k < steps; k++) {
      check(step(c, (steps + k) * h, h, 1), "step");
      const double before = now();
      check(get(c, reference, (size_t)n, value), "get");
      read += now() - before;
    }
    wall[5][r] = read / steps;
    release(c);
  }
  static const char *const name[] = {"instantiate_to_initialised", "step",   "get_again", "set_one",
                                     "save_restore_free",          "get_all"};
  for (int q = 0; q < 6; q++) printf("%s %.6g\n", name[q], median(wall[q], repeats));
  const size_t before = allocated;
  fmi2Component *all = malloc((size_t)instances * sizeof *all);
  double begin = now();
  for (int k = 0; k < instances; k++) all[k] = started();
  printf("many_start_s %.6g\n", (now() - begin) * 1e-6);
  printf("memory_per_instance_kB %.6g\n", (double)(allocated - before) / instances / 1024.0);
  begin = now();
  for (int k = 0; k < instances; k++) check(step(all[k], 0.0, h, 1), "step");
  printf("many_step %.6g\n", (now() - begin) / instances);
  for (int k = 0; k < instances; k++) release(all[k]);
  free(all);
  return 0;
}
