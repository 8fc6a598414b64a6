/* Repeats the last step of a stretch of a drive, for counters of instructions and of time.
 *   replay_fmu LIBRARY RESOURCES_URI GUID STATE INPUTS KINDS TIME STEP STEPS REPEATS [LATER]
 * STATE: file with the saved state at TIME. INPUTS: file of doubles, a row for each of the STEPS. KINDS: a letter for
 * each input, numbered from 0: r real, i whole. The last step is made REPEATS times from the same state; a line with the
 * processor time of each, ns. LATER: file for the state before the last step but one. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#endif
#include <time.h>

#include "fmi2_library.h"

static fmi2_library fmu;

static void *read_file(const char *path, size_t *size) {
  FILE *file = fopen(path, "rb");
  char *bytes = NULL;
  *size = 0;
  if (file != NULL && fseek(file, 0, SEEK_END) == 0) {
    const long end = ftell(file);
    bytes = end > 0 ? malloc((size_t)end) : NULL;
    rewind(file);
    if (bytes != NULL) *size = fread(bytes, 1, (size_t)end, file);
  }
  if (file != NULL) fclose(file);
  if (*size == 0) {
    fprintf(stderr, "%s cannot be read\n", path);
    exit(3);
  }
  return bytes;
}

static void write_state(const char *path, fmi2Component c) {
  fmi2FMUstate state = NULL;
  size_t size = 0;
  good(fmu.get_state(c, &state), "get the state");
  good(fmu.state_size(c, state, &size), "the size of the state");
  fmi2Byte *bytes = malloc(size);
  FILE *file = fopen(path, "wb");
  if (bytes == NULL || file == NULL) exit(3);
  good(fmu.to_bytes(c, state, bytes, size), "write the state");
  if (fwrite(bytes, 1, size, file) != size || fclose(file) != 0) exit(3);
  good(fmu.free_state(c, &state), "free the state");
  free(bytes);
}

static void set_inputs(fmi2Component c, const char *kinds, const double *row) {
  for (fmi2ValueReference i = 0; kinds[i] != 0; i++) {
    const fmi2Integer whole = (fmi2Integer)row[i];
    good(kinds[i] == 'i' ? fmu.set_whole(c, &i, 1, &whole) : fmu.set(c, &i, 1, &row[i]), "set");
  }
}

static long long processor_time(void) {
#if defined(_WIN32)
  return 0;
#else
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (long long)t.tv_sec * 1000000000 + t.tv_nsec;
#endif
}

int main(int count, char **argument) {
  static const fmi2CallbackFunctions callbacks = {NULL, calloc, free, NULL, NULL};
  size_t state_size, inputs_size;
  if (count < 11) return 1;
  fmu = load_library(argument[1]);
  const fmi2Byte *bytes = read_file(argument[4], &state_size);
  const double *inputs = read_file(argument[5], &inputs_size);
  const char *kinds = argument[6];
  const double begin = strtod(argument[7], NULL), h = strtod(argument[8], NULL);
  const int steps = atoi(argument[9]), repeats = atoi(argument[10]);
  const size_t n = strlen(kinds);
  if (steps < 1 || inputs_size != (size_t)steps * n * sizeof *inputs) return 1;
  fmi2Component c = fmu.instantiate("replayed", fmi2CoSimulation, argument[3], argument[2], &callbacks, 0, 0);
  if (c == NULL) return 3;
  fmi2FMUstate state = NULL;
  initialise(&fmu, c);
  good(fmu.from_bytes(c, bytes, state_size, &state), "read the state");
  good(fmu.set_state(c, state), "set the state");
  for (int k = 0; k < steps; k++) {
    if (k == steps - 2 && count > 11) write_state(argument[11], c);
    if (k == steps - 1) good(fmu.get_state(c, &state), "get the state");
    set_inputs(c, kinds, inputs + (size_t)k * n);
    if (k < steps - 1) good(fmu.step(c, begin + k * h, h, 1), "step");
  }
  for (int r = 0; r < repeats; r++) {
    if (r > 0) {
      good(fmu.set_state(c, state), "set the state");
      set_inputs(c, kinds, inputs + (size_t)(steps - 1) * n);
    }
    const long long before = processor_time();
    good(fmu.step(c, begin + (steps - 1) * h, h, 1), "the last step");
    printf("%lld\n", processor_time() - before);
  }
  return 0;
}
