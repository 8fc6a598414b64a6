/* A host of FMI 3.0 co-simulation without Python, which gives inputs within a step: loads the library of an unpacked FMU
 * and runs it with inputs on straight lines.
 *
 *   host3 [--early] LIBRARY RESOURCES_FOLDER TOKEN STEPS STEP FIRST LAST [REFERENCE=VALUE | REFERENCE=VALUE+RATE ...]
 *
 * Prints time and the Float64 variables FIRST to LAST after every step as hexadecimal numbers, so that no digit is lost.
 * REFERENCE=VALUE is a start value of a parameter or input; REFERENCE=VALUE+RATE an input that is VALUE + RATE t: at
 * communication points it is set, within a step it is given where the FMU asks for it (intermediate update). With
 * --early a step may return before its end; its row is then the last one, and the exit code is 6.
 *
 * It needs library.h beside it and the headers of the FMI 3.0 standard
 * (https://github.com/modelica/fmi-standard/releases). FMPy brings them, in the folder that
 *   python -c "import fmpy; print(fmpy.__path__[0] + '/c-code')"
 * prints:
 *
 *   cc -I FOLDER_OF_THE_HEADERS hosts/c/host3.c -ldl -o host3 */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi3FunctionTypes.h"
#include "library.h"

enum { MAX_VALUES = 4096, MAX_LINES = 64 };

typedef struct { /* functions of the library */
  fmi3InstantiateCoSimulationTYPE *instantiate;
  fmi3EnterInitializationModeTYPE *enter;
  fmi3ExitInitializationModeTYPE *leave;
  fmi3DoStepTYPE *step;
  fmi3GetFloat64TYPE *get;
  fmi3SetFloat64TYPE *set;
  fmi3TerminateTYPE *terminate;
  fmi3FreeInstanceTYPE *release;
} functions;

typedef struct { /* what the callback needs */
  functions f;
  fmi3Instance instance;
  size_t n; /* inputs on lines */
  fmi3ValueReference reference[MAX_LINES];
  double value[MAX_LINES], rate[MAX_LINES];
} host;

/* Logger: prints a message of the FMU. */
static void say(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message) {
  (void)environment, (void)status;
  fprintf(stderr, "[%s] %s\n", category, message);
}

/* Ends the program if a call failed. */
static void good(fmi3Status status, const char *call) {
  if (status > fmi3Warning) stop(4, "%s: status %d", call, (int)status);
}

/* All inputs that are on lines, at a time. */
static fmi3Status set_lines(const host *h, double time) {
  double now[MAX_LINES];
  for (size_t i = 0; i < h->n; i++) now[i] = h->value[i] + h->rate[i] * time;
  return h->n > 0 ? h->f.set(h->instance, h->reference, h->n, now, h->n) : fmi3OK;
}

/* Intermediate update: sets the inputs on lines if the FMU asks for them. */
static void update(fmi3InstanceEnvironment environment, fmi3Float64 time, fmi3Boolean asked, fmi3Boolean readable,
                   fmi3Boolean finished, fmi3Boolean may_return, fmi3Boolean *early, fmi3Float64 *early_time) {
  const host *h = environment;
  (void)readable, (void)finished, (void)may_return;
  *early = false;
  *early_time = time;
  if (asked) good(set_lines(h, time), "set within a step");
}

/* The functions of FMI 3.0 that the host calls. */
static functions functions_of(void *library) {
  functions f;
  *(void **)&f.instantiate = function(library, "fmi3InstantiateCoSimulation");
  *(void **)&f.enter = function(library, "fmi3EnterInitializationMode");
  *(void **)&f.leave = function(library, "fmi3ExitInitializationMode");
  *(void **)&f.step = function(library, "fmi3DoStep");
  *(void **)&f.get = function(library, "fmi3GetFloat64");
  *(void **)&f.set = function(library, "fmi3SetFloat64");
  *(void **)&f.terminate = function(library, "fmi3Terminate");
  *(void **)&f.release = function(library, "fmi3FreeInstance");
  return f;
}

/* A number at the start of a text; `end`: the text after it. */
static double number(const char *text, char **end) {
  const double value = strtod(text, end);
  if (*end == text) stop(1, "'%s' is not a number.", text);
  return value;
}

/* REFERENCE=VALUE or REFERENCE=VALUE+RATE; those with a rate are kept in the host. */
static void take(host *h, const char *text, fmi3ValueReference *reference, double *value) {
  char *end;
  *reference = (fmi3ValueReference)strtoul(text, &end, 10);
  if (end == text || *end != '=') stop(1, "'%s' is not of the form REFERENCE=VALUE or REFERENCE=VALUE+RATE.", text);
  *value = number(end + 1, &end);
  if (*end == 0) return;
  if (h->n == MAX_LINES) stop(1, "More than %d inputs have a rate.", MAX_LINES);
  h->reference[h->n] = *reference;
  h->value[h->n] = *value;
  h->rate[h->n++] = number(end, &end);
  if (*end != 0) stop(1, "'%s' ends with '%s'; it must end with a rate.", text, end);
}

int main(int count, char **argument) {
  static fmi3ValueReference reference[MAX_VALUES];
  static double value[MAX_VALUES];
  static host h;
  char *end;
  const bool may_return = count > 1 && strcmp(argument[1], "--early") == 0;
  count -= may_return, argument += may_return;
  if (count < 8)
    stop(1, "usage: host3 [--early] LIBRARY RESOURCES_FOLDER TOKEN STEPS STEP FIRST LAST [REFERENCE=VALUE[+RATE] ...]");
  const long steps = strtol(argument[4], NULL, 10), first = strtol(argument[6], NULL, 10);
  const double length = number(argument[5], &end);
  const long last = strtol(argument[7], NULL, 10);
  if (length <= 0.0) stop(1, "STEP is '%s'; it must be positive.", argument[5]);
  if (first < 0 || last < first || last - first >= MAX_VALUES || count - 8 > MAX_VALUES)
    stop(1, "FIRST to LAST must be 1 to %d variables.", MAX_VALUES);
  void *library = open_library(argument[1]);
  if (library == NULL) stop(2, "%s cannot be loaded", argument[1]);
  h.f = functions_of(library);
  for (int i = 8; i < count; i++) take(&h, argument[i], &reference[i - 8], &value[i - 8]);
  h.instance = h.f.instantiate("car", argument[3], argument[2], false, false, false, may_return, h.reference, h.n, &h,
                               say, h.n > 0 ? update : NULL);
  if (h.instance == NULL) return 5;
  const size_t n_start = (size_t)(count - 8), n = (size_t)(last - first + 1);
  if (n_start > 0) good(h.f.set(h.instance, reference, n_start, value, n_start), "set");
  good(h.f.enter(h.instance, false, 0.0, 0.0, false, 0.0), "enter initialisation");
  good(h.f.leave(h.instance), "exit initialisation");
  for (size_t i = 0; i < n; i++) reference[i] = (fmi3ValueReference)first + (fmi3ValueReference)i;
  for (long k = 0; k < steps; k++) {
    bool event, ends, early;
    double reached;
    good(set_lines(&h, (double)k * length), "set");
    good(h.f.step(h.instance, (double)k * length, length, true, &event, &ends, &early, &reached), "step");
    good(h.f.get(h.instance, reference, n, value, n), "get");
    printf("%a", reached);
    for (size_t i = 0; i < n; i++) printf(" %a", value[i]);
    printf("\n");
    if (early) stop(6, "the step to %g s returned early at %g s", (double)(k + 1) * length, reached);
  }
  good(h.f.terminate(h.instance), "terminate");
  h.f.release(h.instance);
  return 0;
}
