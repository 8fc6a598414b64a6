/* Hard use of the shell, linked with the FMU's own sources: leaks, failing memory, threads, altered bytes.
 *   stress RESOURCES_URI GUID SYSTEM_FILE OUTPUT WHAT COUNT
 * Prints one line per finding; the exit status is 0 when all is well. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ali3.h"
#include "fmi2.h"

const char *fmi2GetVersion(void);
fmi2Component fmi2Instantiate(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions *, fmi2Boolean,
                              fmi2Boolean);
void fmi2FreeInstance(fmi2Component);
fmi2Status fmi2SetupExperiment(fmi2Component, fmi2Boolean, fmi2Real, fmi2Real, fmi2Boolean, fmi2Real);
fmi2Status fmi2EnterInitializationMode(fmi2Component);
fmi2Status fmi2ExitInitializationMode(fmi2Component);
fmi2Status fmi2Reset(fmi2Component);
fmi2Status fmi2DoStep(fmi2Component, fmi2Real, fmi2Real, fmi2Boolean);
fmi2Status fmi2GetReal(fmi2Component, const fmi2ValueReference *, size_t, fmi2Real *);
fmi2Status fmi2SetReal(fmi2Component, const fmi2ValueReference *, size_t, const fmi2Real *);
fmi2Status fmi2GetFMUstate(fmi2Component, fmi2FMUstate *);
fmi2Status fmi2SetFMUstate(fmi2Component, fmi2FMUstate);
fmi2Status fmi2FreeFMUstate(fmi2Component, fmi2FMUstate *);
fmi2Status fmi2SerializedFMUstateSize(fmi2Component, fmi2FMUstate, size_t *);
fmi2Status fmi2SerializeFMUstate(fmi2Component, fmi2FMUstate, fmi2Byte *, size_t);
fmi2Status fmi2DeSerializeFMUstate(fmi2Component, const fmi2Byte *, size_t, fmi2FMUstate *);
fmi2Status fmi2GetDirectionalDerivative(fmi2Component, const fmi2ValueReference *, size_t, const fmi2ValueReference *,
                                        size_t, const fmi2Real *, fmi2Real *);
uint32_t ali3_crc32(const void *, size_t);

static const char *resources, *guid, *system_file;
static fmi2ValueReference output;
static long alive, made, fail_at = -1;
static uint64_t seed = 88172645463325252u;

static uint32_t random_number(void) {
  seed ^= seed << 13;
  seed ^= seed >> 7;
  seed ^= seed << 17;
  return (uint32_t)(seed >> 16);
}

static void *counted_allocate(size_t n, size_t size) {
  if (made++ == fail_at) return NULL;
  alive++;
  return calloc(n, size);
}

static void counted_free(void *p) {
  if (p == NULL) {
    printf("free of a null pointer\n");
    exit(1);
  }
  alive--;
  free(p);
}

static const fmi2CallbackFunctions callbacks = {NULL, counted_allocate, counted_free, NULL, NULL};

static fmi2Component instance(void) {
  return fmi2Instantiate("stress", fmi2CoSimulation, guid, resources, &callbacks, 0, 0);
}

/* A short life with all that takes memory; false when a call was refused. */
static int live(fmi2Component c, int steps, double *out) {
  const fmi2ValueReference input = 0;
  const double u = 1.0;
  fmi2FMUstate state = NULL;
  int good = fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0) == fmi2OK && fmi2EnterInitializationMode(c) == fmi2OK &&
             fmi2ExitInitializationMode(c) == fmi2OK && fmi2SetReal(c, &input, 1, &u) == fmi2OK;
  for (int k = 0; k < steps && good; k++) good = fmi2DoStep(c, 0.01 * k, 0.01, 1) == fmi2OK;
  *out = 0.0;
  const fmi2Status derived = good ? fmi2GetDirectionalDerivative(c, &output, 1, &input, 1, &u, out) : fmi2Error;
  good = good && (derived == fmi2OK || derived == fmi2Error); /* across a kink there is none */
  good = good && fmi2GetFMUstate(c, &state) == fmi2OK && fmi2SetFMUstate(c, state) == fmi2OK;
  good = good && fmi2GetReal(c, &output, 1, out) == fmi2OK;
  fmi2FreeFMUstate(c, &state);
  return good;
}

static int leak(long count) {
  double out;
  for (long k = 0; k < count; k++) {
    fmi2Component c = instance();
    if (c == NULL || !live(c, 3, &out)) return printf("instance %ld did not live\n", k), 1;
    fmi2FreeInstance(c);
  }
  printf("%ld allocations, %ld left\n", made, alive);
  return alive != 0;
}

/* Every allocation fails once; then nothing may be left, and the instance that stays must still free. */
static int no_memory(void) {
  double out;
  int finished = 0;
  for (fail_at = 0; !finished && fail_at < 1000; fail_at++) {
    made = 0;
    fmi2Component c = instance();
    if (c != NULL) {
      finished = live(c, 2, &out) && made <= fail_at;
      fmi2FreeInstance(c);
    }
    if (alive != 0) return printf("%ld blocks left after failure %ld\n", alive, fail_at), 1;
  }
  printf("%ld failures survived\n", fail_at - 1);
  return !finished;
}

static void alter(unsigned char *bytes, size_t from, size_t size) {
  const int many = 1 + (int)(random_number() % 4);
  for (int i = 0; i < many; i++) {
    const size_t at = from + random_number() % (size - from);
    switch (random_number() % 4) {
    case 0:
      bytes[at] ^= (unsigned char)(1u << (random_number() % 8));
      break;
    case 1:
      bytes[at] = (unsigned char)random_number();
      break;
    case 2:
      if (at + 8 <= size) memset(bytes + at, random_number() % 2 ? 0xFF : 0, 8);
      break;
    default:
      if (at + 4 <= size) {
        const uint32_t word = random_number();
        memcpy(bytes + at, &word, 4);
      }
    }
  }
}

static void put_crc(unsigned char *bytes, size_t place, size_t from, size_t size) {
  const uint32_t crc = ali3_crc32(bytes + from, size - from);
  memcpy(bytes + place, &crc, 4);
}

/* Altered states with checksums that fit: refused, or a state that steps or refuses to. Never a NaN. */
static int altered_states(long count) {
  fmi2Component c = instance();
  fmi2FMUstate state = NULL, other = NULL;
  size_t size = 0;
  double out;
  long taken = 0, refused = 0;
  if (c == NULL || !live(c, 5, &out) || fmi2GetFMUstate(c, &state) != fmi2OK ||
      fmi2SerializedFMUstateSize(c, state, &size) != fmi2OK)
    return printf("no state\n"), 1;
  unsigned char *bytes = malloc(2 * size), *copy = bytes + size;
  fmi2SerializeFMUstate(c, state, (fmi2Byte *)bytes, size);
  size_t inner = 0;
  while (inner + 8 < size && memcmp(bytes + inner, "ALI3STA\n", 8) != 0) inner++;
  for (long k = 0; k < count; k++) {
    memcpy(copy, bytes, size);
    alter(copy, k % 2 ? inner : 0, size);
    if (k % 3 != 0) {
      put_crc(copy, inner + 24, inner + 28, size);
      put_crc(copy, 12, 16, size);
    }
    if (fmi2DeSerializeFMUstate(c, (const fmi2Byte *)copy, size, &other) != fmi2OK ||
        fmi2SetFMUstate(c, other) != fmi2OK) {
      refused++;
      continue;
    }
    taken++;
    fmi2DoStep(c, 0.05, 0.01, 1);
    if (fmi2GetReal(c, &output, 1, &out) == fmi2OK && !isfinite(out)) return printf("a number is not finite\n"), 1;
  }
  for (size_t n = 0; n < size; n += 1 + n / 16) {
    memcpy(copy, bytes, n);
    if (fmi2DeSerializeFMUstate(c, (const fmi2Byte *)copy, n, &other) == fmi2OK) return printf("short state\n"), 1;
  }
  fmi2FreeFMUstate(c, &state);
  fmi2FreeFMUstate(c, &other);
  fmi2FreeInstance(c);
  free(bytes);
  printf("%ld altered states taken, %ld refused\n", taken, refused);
  return alive != 0 || refused == 0;
}

/* Altered System files with checksums that fit. */
static int altered_systems(long count) {
  FILE *file = fopen(system_file, "rb");
  if (file == NULL) return printf("no System file\n"), 1;
  fseek(file, 0, SEEK_END);
  const size_t size = (size_t)ftell(file);
  rewind(file);
  unsigned char *bytes = malloc(2 * size), *copy = bytes + size;
  if (fread(bytes, 1, size, file) != size) return printf("no System file\n"), 1;
  fclose(file);
  long taken = 0, refused = 0;
  for (long k = 0; k < count; k++) {
    char message[256];
    ali3_system *system = NULL;
    ali3_instance *in = NULL;
    memcpy(copy, bytes, size);
    alter(copy, k % 4 == 0 ? 0 : 32, size);
    if (k % 8 != 0) put_crc(copy, 24, 32, size);
    if (ali3_system_load(copy, size, &system, message, sizeof message) != ALI3_OK) {
      refused++;
      continue;
    }
    taken++;
    if (ali3_instance_new(system, &in) == ALI3_OK && ali3_initialise(in, 0.0) == ALI3_OK)
      for (int i = 0; i < 2; i++) ali3_step(in, 0.01);
    ali3_instance_free(in);
    ali3_system_free(system);
  }
  free(bytes);
  printf("%ld altered Systems taken, %ld refused\n", taken, refused);
  return refused == 0;
}

/* Many instances at once, then all of them free. */
static int crowd(long count) {
  double first = 0.0, out = 0.0;
  fmi2Component *all = malloc((size_t)count * sizeof *all);
  for (long k = 0; k < count; k++) all[k] = instance();
  for (long k = 0; k < count; k++) {
    if (all[k] == NULL || !live(all[k], 3, &out)) return printf("instance %ld did not live\n", k), 1;
    if (k == 0) first = out;
    if (memcmp(&first, &out, sizeof out) != 0) return printf("instance %ld differs\n", k), 1;
  }
  for (long k = 0; k < count; k++) fmi2FreeInstance(all[k]);
  free(all);
  printf("%ld instances at once, %ld blocks left\n", count, alive);
  return alive != 0;
}

#if !defined(_WIN32)
#include <pthread.h>

static const fmi2CallbackFunctions plain = {NULL, calloc, free, NULL, NULL};

static void *thread(void *place) {
  double *out = place;
  fmi2Component c = fmi2Instantiate("thread", fmi2CoSimulation, guid, resources, &plain, 0, 0);
  for (int life = 0; life < 20 && c != NULL; life++) {
    if (!live(c, 50, out)) *out = NAN;
    fmi2Reset(c);
  }
  fmi2FreeInstance(c);
  return NULL;
}

static int threads(void) {
  enum { MANY = 8 };
  pthread_t id[MANY];
  double out[MANY];
  for (int i = 0; i < MANY; i++) out[i] = NAN;
  for (int i = 0; i < MANY; i++)
    if (pthread_create(&id[i], NULL, thread, &out[i]) != 0) return printf("no thread\n"), 1;
  for (int i = 0; i < MANY; i++) pthread_join(id[i], NULL);
  for (int i = 0; i < MANY; i++)
    if (!isfinite(out[i]) || memcmp(&out[i], &out[0], sizeof(double)) != 0) return printf("threads differ\n"), 1;
  printf("%d threads agree\n", (int)MANY);
  return 0;
}
#else
static int threads(void) { return 0; }
#endif

int main(int count, char **argument) {
  if (count < 7) return 1;
  resources = argument[1];
  guid = argument[2];
  system_file = argument[3];
  output = (fmi2ValueReference)strtoul(argument[4], NULL, 10);
  const char *what = argument[5];
  const long many = strtol(argument[6], NULL, 10);
  if (strcmp(what, "leak") == 0) return leak(many);
  if (strcmp(what, "memory") == 0) return no_memory();
  if (strcmp(what, "states") == 0) return altered_states(many);
  if (strcmp(what, "systems") == 0) return altered_systems(many);
  if (strcmp(what, "crowd") == 0) return crowd(many);
  if (strcmp(what, "threads") == 0) return threads();
  return 1;
}
