/* A host of FMI 2.0 co-simulation without Python: loads the library of an unpacked FMU and runs it with constant inputs.
 *
 *   host LIBRARY RESOURCES_URI GUID STEPS STEP FIRST LAST [REFERENCE=VALUE ...]
 *
 * Prints time and the variables FIRST to LAST after every step as hexadecimal numbers, so that no digit is lost.
 *
 * It needs the headers of the FMI 2.0 standard (https://github.com/modelica/fmi-standard/releases). FMPy brings them, in
 * the folder that  python -c "import fmpy; print(fmpy.__path__[0] + '/c-code')"  prints:
 *
 *   cc -I FOLDER_OF_THE_HEADERS hosts/c/host.c -ldl -o host */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#include <windows.h>
static void *open_library(const char *path) { return (void *)LoadLibraryA(path); }
static void *find(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }
#else
#include <dlfcn.h>
static void *open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *find(void *library, const char *name) { return dlsym(library, name); }
#endif

#include "fmi2FunctionTypes.h"

enum { MOST_VALUES = 4096 };

static void say(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                fmi2String format, ...) {
  va_list list;
  (void)environment, (void)status;
  va_start(list, format);
  fprintf(stderr, "%s [%s] ", name, category);
  vfprintf(stderr, format, list);
  fputc('\n', stderr);
  va_end(list);
}

static void *function(void *library, const char *name) {
  void *found = find(library, name);
  if (found == NULL) {
    fprintf(stderr, "the library has no %s\n", name);
    exit(3);
  }
  return found;
}

static void good(fmi2Status status, const char *what) {
  if (status <= fmi2Warning) return;
  fprintf(stderr, "%s: status %d\n", what, (int)status);
  exit(4);
}

int main(int count, char **argument) {
  static fmi2ValueReference reference[MOST_VALUES];
  static double value[MOST_VALUES];
  if (count < 8) {
    fprintf(stderr, "usage: %s LIBRARY RESOURCES_URI GUID STEPS STEP FIRST LAST [REFERENCE=VALUE ...]\n", argument[0]);
    return 1;
  }
  void *library = open_library(argument[1]);
  if (library == NULL) {
    fprintf(stderr, "%s cannot be loaded\n", argument[1]);
    return 2;
  }
  fmi2InstantiateTYPE *instantiate;
  fmi2SetupExperimentTYPE *setup;
  fmi2EnterInitializationModeTYPE *enter;
  fmi2ExitInitializationModeTYPE *leave;
  fmi2DoStepTYPE *step;
  fmi2GetRealTYPE *get;
  fmi2SetRealTYPE *set;
  fmi2TerminateTYPE *terminate;
  fmi2FreeInstanceTYPE *release;
  *(void **)&instantiate = function(library, "fmi2Instantiate");
  *(void **)&setup = function(library, "fmi2SetupExperiment");
  *(void **)&enter = function(library, "fmi2EnterInitializationMode");
  *(void **)&leave = function(library, "fmi2ExitInitializationMode");
  *(void **)&step = function(library, "fmi2DoStep");
  *(void **)&get = function(library, "fmi2GetReal");
  *(void **)&set = function(library, "fmi2SetReal");
  *(void **)&terminate = function(library, "fmi2Terminate");
  *(void **)&release = function(library, "fmi2FreeInstance");

  const fmi2CallbackFunctions callbacks = {say, calloc, free, NULL, NULL};
  const long steps = strtol(argument[4], NULL, 10);
  const double h = strtod(argument[5], NULL);
  const unsigned first = (unsigned)strtoul(argument[6], NULL, 10), last = (unsigned)strtoul(argument[7], NULL, 10);
  if (last < first || last - first >= MOST_VALUES) return 1;
  const size_t n = last - first + 1;
  for (size_t i = 0; i < n; i++) reference[i] = first + (unsigned)i;
  fmi2Component c = instantiate("car", fmi2CoSimulation, argument[3], argument[2], &callbacks, 0, 0);
  if (c == NULL) return 5;
  good(setup(c, 0, 0.0, 0.0, 0, 0.0), "setup");
  for (int i = 8; i < count; i++) {
    char *end;
    const fmi2ValueReference vr = (fmi2ValueReference)strtoul(argument[i], &end, 10);
    const double given = strtod(end + 1, NULL);
    good(set(c, &vr, 1, &given), "set");
  }
  good(enter(c), "enter initialisation");
  good(leave(c), "exit initialisation");
  for (long k = 0; k < steps; k++) {
    good(step(c, (double)k * h, h, 1), "step");
    good(get(c, reference, n, value), "get");
    printf("%a", (double)(k + 1) * h);
    for (size_t i = 0; i < n; i++) printf(" %a", value[i]);
    printf("\n");
  }
  good(terminate(c), "terminate");
  release(c);
  return 0;
}
