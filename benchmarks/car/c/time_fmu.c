/* Times the calls of an FMU from C, without Python in the loop.
 *   time_fmu LIBRARY RESOURCES_URI GUID STEP STEPS REPEATS N_OUTPUTS FIRST_OUTPUT INSTANCES
 * Prints one line "name value" per quantity, microseconds per call (the median of the repeats) or as named. */
#include <time.h>

#include "fmi2_library.h"

enum { MAX_REPEATS = 64, MAX_VALUES = 4096 };
enum { START, STEP, GET_AGAIN, SET_ONE, SAVE, GET_ALL, QUANTITIES };
static const char *const quantity[QUANTITIES] = {"instantiate_to_initialised", "step",   "get_again", "set_one",
                                                 "save_restore_free",          "get_all"};

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

static fmi2_library fmu;
static fmi2CallbackFunctions callbacks = {NULL, counted_allocate, counted_free, NULL, NULL};
static char **argument;

static fmi2Component started(void) {
  fmi2Component c = fmu.instantiate("timed", fmi2CoSimulation, argument[3], argument[2], &callbacks, 0, 0);
  if (c == NULL) stop(3, "no instance");
  initialise(&fmu, c);
  return c;
}

/* Wall time of each quantity in one repeat, us per call. reference: the n outputs that are read; h: step, s. */
static void time_repeat(double h, int steps, const fmi2ValueReference *reference, int n, double *wall) {
  static double value[MAX_VALUES];
  const fmi2ValueReference input = 0;
  const double u = 0.1;
  double begin = now();
  fmi2Component c = started();
  wall[START] = now() - begin;
  good(fmu.set(c, &input, 1, &u), "set");
  begin = now();
  for (int k = 0; k < steps; k++) good(fmu.step(c, k * h, h, 1), "step");
  wall[STEP] = (now() - begin) / steps;
  double read = 0.0;
  begin = now();
  for (int k = 0; k < steps; k++) good(fmu.get(c, reference, (size_t)n, value), "get");
  wall[GET_AGAIN] = (now() - begin) / steps;
  begin = now();
  for (int k = 0; k < steps; k++) {
    const double moving = u + 1e-6 * (k % 7);
    good(fmu.set(c, &input, 1, &moving), "set");
  }
  wall[SET_ONE] = (now() - begin) / steps;
  fmi2FMUstate state = NULL;
  begin = now();
  for (int k = 0; k < steps; k++) {
    good(fmu.get_state(c, &state), "get state");
    good(fmu.set_state(c, state), "set state");
    good(fmu.free_state(c, &state), "free state");
  }
  wall[SAVE] = (now() - begin) / steps;
  begin = now();
  for (int k = 0; k < steps; k++) {
    good(fmu.step(c, (steps + k) * h, h, 1), "step");
    const double before = now();
    good(fmu.get(c, reference, (size_t)n, value), "get");
    read += now() - before;
  }
  wall[GET_ALL] = read / steps;
  fmu.release(c);
}

/* Prints start, memory and step of many instances at the same time. */
static void time_many(double h, int instances) {
  const size_t before = allocated;
  fmi2Component *all = malloc((size_t)instances * sizeof *all);
  double begin = now();
  for (int k = 0; k < instances; k++) all[k] = started();
  printf("many_start_s %.6g\n", (now() - begin) * 1e-6);
  printf("memory_per_instance_kB %.6g\n", (double)(allocated - before) / instances / 1024.0);
  begin = now();
  for (int k = 0; k < instances; k++) good(fmu.step(all[k], 0.0, h, 1), "step");
  printf("many_step %.6g\n", (now() - begin) / instances);
  for (int k = 0; k < instances; k++) fmu.release(all[k]);
  free(all);
}

int main(int count, char **arguments) {
  static fmi2ValueReference reference[MAX_VALUES];
  double wall[QUANTITIES], all[QUANTITIES][MAX_REPEATS];
  if (count < 10) return 1;
  argument = arguments;
  fmu = load_library(arguments[1]);
  const double h = strtod(argument[4], NULL);
  const int steps = atoi(argument[5]), repeats = atoi(argument[6]), n = atoi(argument[7]), first = atoi(argument[8]);
  const int instances = atoi(argument[9]);
  if (repeats < 1 || repeats > MAX_REPEATS || n < 1 || n > MAX_VALUES || steps < 1) return 1;
  for (int i = 0; i < n; i++) reference[i] = (fmi2ValueReference)(first + i);
  for (int r = 0; r < repeats; r++) {
    time_repeat(h, steps, reference, n, wall);
    for (int q = 0; q < QUANTITIES; q++) all[q][r] = wall[q];
  }
  for (int q = 0; q < QUANTITIES; q++) printf("%s %.6g\n", quantity[q], median(all[q], repeats));
  time_many(h, instances);
  return 0;
}
