/* Times the calls of an FMU from C, without Python in the loop.
 *   time_fmu LIBRARY RESOURCES_URI GUID STEP STEPS REPEATS N_OUTPUTS FIRST_OUTPUT INSTANCES
 * Prints one line "name value" per quantity, microseconds per call (the median of the repeats) or as named. */
#include <time.h>

#include "fmi2_library.h"

enum { MAX_REPEATS = 64, MAX_VALUES = 4096 };

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

int main(int count, char **arguments) {
  static fmi2ValueReference reference[MAX_VALUES];
  static double value[MAX_VALUES];
  double wall[6][MAX_REPEATS];
  if (count < 10) return 1;
  argument = arguments;
  fmu = load_library(arguments[1]);
  const double h = strtod(argument[4], NULL);
  const int steps = atoi(argument[5]), repeats = atoi(argument[6]), n = atoi(argument[7]), first = atoi(argument[8]);
  const int instances = atoi(argument[9]);
  if (repeats < 1 || repeats > MAX_REPEATS || n < 1 || n > MAX_VALUES || steps < 1) return 1;
  for (int i = 0; i < n; i++) reference[i] = (fmi2ValueReference)(first + i);
  const fmi2ValueReference input = 0;
  const double u = 0.1;
  for (int r = 0; r < repeats; r++) {
    double begin = now();
    fmi2Component c = started();
    wall[0][r] = now() - begin;
    good(fmu.set(c, &input, 1, &u), "set");
    begin = now();
    for (int k = 0; k < steps; k++) good(fmu.step(c, k * h, h, 1), "step");
    wall[1][r] = (now() - begin) / steps;
    double read = 0.0;
    begin = now();
    for (int k = 0; k < steps; k++) good(fmu.get(c, reference, (size_t)n, value), "get");
    wall[2][r] = (now() - begin) / steps;
    begin = now();
    for (int k = 0; k < steps; k++) {
      const double moving = u + 1e-6 * (k % 7);
      good(fmu.set(c, &input, 1, &moving), "set");
    }
    wall[3][r] = (now() - begin) / steps;
    fmi2FMUstate state = NULL;
    begin = now();
    for (int k = 0; k < steps; k++) {
      good(fmu.get_state(c, &state), "get state");
      good(fmu.set_state(c, state), "set state");
      good(fmu.free_state(c, &state), "free state");
    }
    wall[4][r] = (now() - begin) / steps;
    begin = now();
    for (int k = 0; k < steps; k++) {
      good(fmu.step(c, (steps + k) * h, h, 1), "step");
      const double before = now();
      good(fmu.get(c, reference, (size_t)n, value), "get");
      read += now() - before;
    }
    wall[5][r] = read / steps;
    fmu.release(c);
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
  for (int k = 0; k < instances; k++) good(fmu.step(all[k], 0.0, h, 1), "step");
  printf("many_step %.6g\n", (now() - begin) / instances);
  for (int k = 0; k < instances; k++) fmu.release(all[k]);
  free(all);
  return 0;
}
