/* Hands a state on: relay LIBRARY RESOURCES_URI GUID (save | load) FILE
 * "save" makes 30 steps, writes the state to FILE, goes on; "load" goes on from FILE. Both print the outputs after. */
#include "fmi2_library.h"

enum { STEPS = 30, FIRST = 4, LAST = 8, MOST_BYTES = 1 << 20 };

static fmi2_library fmu;

static void go_on(fmi2Component c, int from, int print) {
  fmi2ValueReference reference[LAST - FIRST + 1];
  double value[LAST - FIRST + 1];
  for (int i = FIRST; i <= LAST; i++) reference[i - FIRST] = (fmi2ValueReference)i;
  for (int k = from; k < from + STEPS; k++) {
    good(fmu.step(c, 0.01 * k, 0.01, 1), "step");
    good(fmu.get(c, reference, LAST - FIRST + 1, value), "get");
    for (int i = 0; print && i <= LAST - FIRST; i++) printf("%a%c", value[i], i < LAST - FIRST ? ' ' : '\n');
  }
}

int main(int count, char **argument) {
  static fmi2Byte bytes[MOST_BYTES];
  const fmi2CallbackFunctions callbacks = {NULL, calloc, free, NULL, NULL};
  const fmi2ValueReference input = 0;
  const double u = 3.5;
  fmi2FMUstate state = NULL;
  size_t size = 0;
  if (count < 6) return 1;
  fmu = load_library(argument[1]);
  fmi2Component c = fmu.instantiate("relay", fmi2CoSimulation, argument[3], argument[2], &callbacks, 0, 0);
  if (c == NULL) return 3;
  const int saves = strcmp(argument[4], "save") == 0;
  FILE *file = fopen(argument[5], saves ? "wb" : "rb");
  if (file == NULL) return 5;
  if (saves) {
    initialise(&fmu, c);
    good(fmu.set(c, &input, 1, &u), "set");
    go_on(c, 0, 0);
    good(fmu.get_state(c, &state), "get state");
    good(fmu.state_size(c, state, &size), "size");
    if (size > MOST_BYTES) return 6;
    good(fmu.to_bytes(c, state, bytes, size), "serialise");
    if (fwrite(bytes, 1, size, file) != size) return 7;
  } else {
    size = fread(bytes, 1, MOST_BYTES, file);
    good(fmu.from_bytes(c, bytes, size, &state), "deserialise");
    good(fmu.set_state(c, state), "set state");
  }
  fclose(file);
  go_on(c, STEPS, 1);
  return 0;
}
