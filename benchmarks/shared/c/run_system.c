/* Continues a saved state of a System, with rows of inputs or none, and says what it took.
 *   run_system SYSTEM STATE INPUTS STEP STEPS [REPEATS [CODE]]
 * INPUTS holds the values at the end of each step as doubles, a row a step; an empty file leaves the inputs as they are.
 * Prints the status and the iterations, factorizations and solves of these steps; with REPEATS also the least processor
 * time, s, of so many runs from the same state. CODE is a library of code that was generated for the System. Exit
 * codes: 2 wrong arguments, 3 a file cannot be read, 4 no System, 5 no memory, 6 the state is of another System, 7 the
 * code is of another System. */
#ifndef _WIN32
#include <dlfcn.h>
#endif
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "ali3.h"

/* The bytes of a file, which are not freed before the program ends; NULL: it cannot be read. */
static void *contents(const char *name, size_t *size) {
  FILE *file = fopen(name, "rb");
  if (file == NULL || fseek(file, 0, SEEK_END) != 0) return NULL;
  *size = (size_t)ftell(file);
  rewind(file);
  void *bytes = malloc(*size + 1);
  if (bytes == NULL || fread(bytes, 1, *size, file) != *size) return NULL;
  fclose(file);
  return bytes;
}

static int attach(ali3_system *system, const char *name, char *message, size_t size) {
#ifdef _WIN32
  (void)system, (void)name, (void)message, (void)size;
  return 1;
#else
  void *library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  const void *table = library != NULL ? dlsym(library, "ali3_generated_code") : NULL;
  return ali3_system_attach(system, table, message, size) != ALI3_OK;
#endif
}

int main(int count, char **words) {
  if (count < 6 || count > 8) return 2;
  size_t system_size, state_size, input_size;
  void *bytes = contents(words[1], &system_size), *state = contents(words[2], &state_size);
  double *inputs = contents(words[3], &input_size);
  if (bytes == NULL || state == NULL || inputs == NULL) return 3;
  char message[256];
  ali3_system *system;
  ali3_instance *in;
  ali3_report before, after;
  ali3_status status = ALI3_OK;
  int64_t done;
  clock_t least = 0;
  if (ali3_system_load(bytes, system_size, &system, message, sizeof message) != ALI3_OK) return 4;
  if (count > 7 && attach(system, words[7], message, sizeof message)) return 7;
  if (ali3_instance_new(system, &in) != ALI3_OK) return 5;
  const long repeats = count > 6 ? atol(words[6]) : 1;
  for (long k = 0; k < repeats && status == ALI3_OK; k++) {
    if (ali3_state_restore(in, state, state_size) != ALI3_OK) return 6;
    ali3_report_get(in, &before);
    const clock_t start = clock();
    status = ali3_run(in, atof(words[4]), atoll(words[5]), input_size > 0 ? inputs : NULL, 1, NULL, NULL, &done);
    const clock_t taken = clock() - start;
    if (k == 0 || taken < least) least = taken;
    ali3_report_get(in, &after);
  }
  printf("%d %" PRId64 " %" PRId64 " %" PRId64, (int)status, after.iterations - before.iterations,
         after.factorizations - before.factorizations, after.solves - before.solves);
  if (count > 6) printf(" %.9f", (double)least / CLOCKS_PER_SEC);
  printf("\n");
  return 0;
}
