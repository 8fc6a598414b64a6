/* A host of FMI 2.0 co-simulation without Python: loads the library of an unpacked FMU and runs it with constant inputs.
 *
 *   host LIBRARY RESOURCES_URI GUID STEPS STEP FIRST LAST [REFERENCE=VALUE | --set NAME=VALUE ...]
 *
 * Prints time and the variables FIRST to LAST after every step as hexadecimal numbers, so that no digit is lost.
 * Assignments are start values of parameters and inputs: real ones by their reference, all by their name, which the
 * host looks up in the modelDescription.xml three folders above the library. Exit codes: 1 wrong argument, 2 library not
 * loaded, 3 function missing, 4 a call failed, 5 not instantiated.
 *
 * It needs library.h beside it and the headers of the FMI 2.0 standard
 * (https://github.com/modelica/fmi-standard/releases). FMPy brings them, in the folder that
 *   python -c "import fmpy; print(fmpy.__path__[0] + '/c-code')"
 * prints:
 *
 *   cc -I FOLDER_OF_THE_HEADERS hosts/c/host.c -ldl -o host */
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2FunctionTypes.h"
#include "library.h"

enum { MAX_VALUES = 4096, MAX_LENGTH = 512 };

typedef struct { /* functions of the library */
  fmi2InstantiateTYPE *instantiate;
  fmi2SetupExperimentTYPE *setup;
  fmi2EnterInitializationModeTYPE *enter;
  fmi2ExitInitializationModeTYPE *leave;
  fmi2DoStepTYPE *step;
  fmi2GetRealTYPE *get;
  fmi2SetRealTYPE *set;
  fmi2SetIntegerTYPE *set_integer;
  fmi2SetBooleanTYPE *set_boolean;
  fmi2SetStringTYPE *set_string;
  fmi2TerminateTYPE *terminate;
  fmi2FreeInstanceTYPE *release;
} functions;

typedef struct { /* a variable as modelDescription.xml has it */
  fmi2ValueReference reference;
  char type[16], causality[24], variability[16];
} variable;

/* Logger: prints a message of the FMU. */
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

/* Ends the program if a call failed; `what`: the call. */
static void good(fmi2Status status, const char *what) {
  if (status > fmi2Warning) stop(4, "%s: status %d", what, (int)status);
}

/* A whole number of the command line, at least `least`; anything else ends the program. */
static long whole(const char *text, const char *what, long least) {
  char *end;
  errno = 0;
  const long value = strtol(text, &end, 10);
  if (end == text || *end != '\0' || errno != 0 || value < least || value > INT_MAX)
    stop(1, "%s is '%s'; it must be a whole number of at least %ld.", what, text, least);
  return value;
}

/* A finite number of the command line. */
static double number(const char *text, const char *what) {
  char *end;
  const double value = strtod(text, &end);
  if (end == text || *end != '\0' || !isfinite(value)) stop(1, "%s is '%s'; it must be a number.", what, text);
  return value;
}

/* The text of modelDescription.xml of the FMU that a library lies in, without comments. */
static char *description_of(const char *library) {
  char path[4096];
  if (strlen(library) + 32 > sizeof path) stop(1, "the path %s is too long", library);
  strcpy(path, library);
  for (int up = 0; up < 3; up++) {
    char *end = path + strlen(path);
    while (end > path && end[-1] != '/' && end[-1] != '\\') end--;
    if (end == path && up < 2) stop(1, "%s does not lie in the folder binaries of an unpacked FMU.", library);
    if (end > path)
      end[-1] = '\0';
    else
      strcpy(path, ".");
  }
  strcat(path, "/modelDescription.xml");
  FILE *file = fopen(path, "rb");
  if (file == NULL || fseek(file, 0, SEEK_END) != 0) stop(1, "%s cannot be read.", path);
  const long size = ftell(file);
  char *text = size < 0 ? NULL : calloc((size_t)size + 1, 1);
  rewind(file);
  if (text == NULL || fread(text, 1, (size_t)size, file) != (size_t)size) stop(1, "%s cannot be read.", path);
  fclose(file);
  for (char *begin = text; (begin = strstr(begin, "<!--")) != NULL;) {
    char *end = strstr(begin, "-->");
    memset(begin, ' ', end == NULL ? strlen(begin) : (size_t)(end + 3 - begin));
  }
  return text;
}

/* An attribute of the tag that begins at `tag`, its entities replaced; false if it has none. */
static bool attribute(const char *tag, const char *name, char *value, size_t size) {
  static const struct {
    const char *entity;
    char character;
  } known[] = {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  const size_t length = strlen(name);
  char quote = '\0';
  for (const char *cursor = tag; *cursor != '\0' && (quote != '\0' || *cursor != '>'); cursor++) {
    if (quote != '\0') {
      if (*cursor == quote) quote = '\0';
      continue;
    }
    if (*cursor == '"' || *cursor == '\'') quote = *cursor;
    if (strchr(" \t\r\n", *cursor) == NULL || strncmp(cursor + 1, name, length) != 0 || cursor[1 + length] != '=')
      continue;
    const char *source = cursor + length + 3, end = cursor[length + 2];
    size_t n = 0;
    while (*source != '\0' && *source != end && n + 1 < size) {
      value[n] = *source;
      size_t used = 1;
      for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strncmp(source, known[k].entity, strlen(known[k].entity)) == 0)
          value[n] = known[k].character, used = strlen(known[k].entity);
      n++, source += used;
    }
    value[n] = '\0';
    return *source == end;
  }
  return false;
}

/* The variable of a name; ends the program if there is none that may be set. */
static variable look_up(const char *description, const char *name) {
  static const char *const types[] = {"Real", "Integer", "Boolean", "String", "Enumeration"};
  char text[MAX_LENGTH];
  for (const char *tag = description; (tag = strstr(tag, "<ScalarVariable")) != NULL; tag++) {
    if (!attribute(tag, "name", text, sizeof text) || strcmp(text, name) != 0) continue;
    variable v = {0, "", "local", "continuous"};
    if (attribute(tag, "valueReference", text, sizeof text)) v.reference = (fmi2ValueReference)strtoul(text, NULL, 10);
    attribute(tag, "causality", v.causality, sizeof v.causality);
    attribute(tag, "variability", v.variability, sizeof v.variability);
    const char *inner = strchr(tag + 1, '<');
    for (size_t k = 0; inner != NULL && k < sizeof types / sizeof *types; k++) {
      const size_t length = strlen(types[k]);
      if (strncmp(inner + 1, types[k], length) == 0 && strchr(" \t\r\n/>", inner[1 + length]) != NULL)
        strcpy(v.type, types[k]);
    }
    if (strcmp(v.variability, "constant") == 0) stop(1, "'%s' is a constant; it cannot be set.", name);
    if (strcmp(v.causality, "parameter") != 0 && strcmp(v.causality, "input") != 0)
      stop(1, "'%s' is of the causality %s; only a parameter or an input can be set.", name, v.causality);
    if (v.type[0] == '\0') stop(1, "'%s' is of a type that this host does not know.", name);
    return v;
  }
  stop(1, "the FMU has no variable '%s'.", name);
  return (variable){0, "", "", ""};
}

/* Sets a variable by its name. */
static void set_by_name(const functions *f, fmi2Component c, const char *library, const char *assignment) {
  const char *equals = strchr(assignment, '=');
  if (equals == NULL || equals == assignment) stop(1, "'%s' is not of the form NAME=VALUE.", assignment);
  char name[MAX_LENGTH];
  if ((size_t)(equals - assignment) >= sizeof name) stop(1, "the name in '%s' is too long.", assignment);
  memcpy(name, assignment, (size_t)(equals - assignment));
  name[equals - assignment] = '\0';
  char *description = description_of(library);
  const variable v = look_up(description, name);
  const char *text = equals + 1;
  fmi2Status status;
  if (strcmp(v.type, "Real") == 0) {
    const fmi2Real value = number(text, name);
    status = f->set(c, &v.reference, 1, &value);
  } else if (strcmp(v.type, "Boolean") == 0) {
    const fmi2Boolean value = strcmp(text, "true") == 0 || strcmp(text, "1") == 0;
    if (!value && strcmp(text, "false") != 0 && strcmp(text, "0") != 0)
      stop(1, "%s is '%s'; it must be true or false.", name, text);
    status = f->set_boolean(c, &v.reference, 1, &value);
  } else if (strcmp(v.type, "String") == 0) {
    status = f->set_string(c, &v.reference, 1, &text);
  } else {
    const fmi2Integer value = (fmi2Integer)whole(text, name, INT_MIN);
    status = f->set_integer(c, &v.reference, 1, &value);
  }
  free(description);
  good(status, assignment);
}

/* Sets a real variable by its reference. */
static void set_by_reference(const functions *f, fmi2Component c, const char *assignment) {
  char *end;
  const fmi2ValueReference reference = (fmi2ValueReference)strtoul(assignment, &end, 10);
  if (end == assignment || *end != '=') stop(1, "'%s' is not of the form REFERENCE=VALUE.", assignment);
  const double value = number(end + 1, assignment);
  good(f->set(c, &reference, 1, &value), "set");
}

/* The functions of FMI 2.0 that the host calls. */
static functions functions_of(void *library) {
  functions f;
  *(void **)&f.instantiate = function(library, "fmi2Instantiate");
  *(void **)&f.setup = function(library, "fmi2SetupExperiment");
  *(void **)&f.enter = function(library, "fmi2EnterInitializationMode");
  *(void **)&f.leave = function(library, "fmi2ExitInitializationMode");
  *(void **)&f.step = function(library, "fmi2DoStep");
  *(void **)&f.get = function(library, "fmi2GetReal");
  *(void **)&f.set = function(library, "fmi2SetReal");
  *(void **)&f.set_integer = function(library, "fmi2SetInteger");
  *(void **)&f.set_boolean = function(library, "fmi2SetBoolean");
  *(void **)&f.set_string = function(library, "fmi2SetString");
  *(void **)&f.terminate = function(library, "fmi2Terminate");
  *(void **)&f.release = function(library, "fmi2FreeInstance");
  return f;
}

int main(int count, char **argument) {
  static fmi2ValueReference reference[MAX_VALUES];
  static double value[MAX_VALUES];
  if (count < 8)
    stop(1, "usage: %s LIBRARY RESOURCES_URI GUID STEPS STEP FIRST LAST [REFERENCE=VALUE | --set NAME=VALUE ...]",
         argument[0]);
  const long steps = whole(argument[4], "STEPS", 0), first = whole(argument[6], "FIRST", 0);
  const double h = number(argument[5], "STEP");
  const long last = whole(argument[7], "LAST", first);
  if (h <= 0.0) stop(1, "STEP is '%s'; it must be positive.", argument[5]);
  if (last - first >= MAX_VALUES) stop(1, "FIRST to LAST are more than %d variables.", MAX_VALUES);
  void *library = open_library(argument[1]);
  if (library == NULL) stop(2, "%s cannot be loaded", argument[1]);
  const functions f = functions_of(library);
  const fmi2CallbackFunctions callbacks = {say, calloc, free, NULL, NULL};
  const size_t n = (size_t)(last - first + 1);
  for (size_t i = 0; i < n; i++) reference[i] = (fmi2ValueReference)first + (fmi2ValueReference)i;
  fmi2Component c = f.instantiate("car", fmi2CoSimulation, argument[3], argument[2], &callbacks, 0, 0);
  if (c == NULL) return 5;
  good(f.setup(c, 0, 0.0, 0.0, 0, 0.0), "setup");
  for (int i = 8; i < count; i++) {
    if (strcmp(argument[i], "--set") != 0)
      set_by_reference(&f, c, argument[i]);
    else if (++i < count)
      set_by_name(&f, c, argument[1], argument[i]);
    else
      stop(1, "--set needs NAME=VALUE.");
  }
  good(f.enter(c), "enter initialisation");
  good(f.leave(c), "exit initialisation");
  for (long k = 0; k < steps; k++) {
    good(f.step(c, (double)k * h, h, 1), "step");
    good(f.get(c, reference, n, value), "get");
    printf("%a", (double)(k + 1) * h);
    for (size_t i = 0; i < n; i++) printf(" %a", value[i]);
    printf("\n");
  }
  good(f.terminate(c), "terminate");
  f.release(c);
  return 0;
}
