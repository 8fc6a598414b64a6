/* A thin shell around PythonFMU's export library, which lies beside it as <this library>-pythonfmu.
 *
 * PythonFMU knows OK, Discard and Fatal only, decodes nothing of the resource URI but %20, takes any GUID and needs
 * the host to have loaded Python. The shell passes every call on and
 * - answers with the worst status the slave logged during the call, so a refused value is fmi2Error and a clamped one
 *   fmi2Warning;
 * - hands PythonFMU a decoded path;
 * - refuses a wrong GUID and null pointers;
 * - loads libpython for hosts that are no Python programs. */
#if !defined(_WIN32)
#define _GNU_SOURCE
#include <dlfcn.h>
#include <sys/stat.h>
#else
#include <windows.h>
#endif
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2.h"

enum { PATH_SIZE = 4096 };

typedef struct {
  fmi2CallbackFunctions host;
  fmi2CallbackFunctions own; /* what PythonFMU gets; it keeps a pointer to it */
  fmi2Component inner;
  fmi2Status worst, last_step;
  int logging;
  unsigned categories; /* bits of those that are heard; 0: all */
  double last_time;
  struct { /* a step that was refused, if the count is not 0, and nothing was changed since */
    int count;
    double time, step;
  } refusal;
} shell;

static const char *const category_name[] = {"logStatusWarning", "logStatusDiscard", "logStatusError", "logStatusFatal",
                                            "logAll"};
enum { CATEGORIES = sizeof category_name / sizeof *category_name };

typedef fmi2Component (*instantiate_f)(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions *,
                                       fmi2Boolean, fmi2Boolean);
typedef void (*free_f)(fmi2Component);
typedef fmi2Status (*plain_f)(fmi2Component);
typedef fmi2Status (*setup_f)(fmi2Component, fmi2Boolean, fmi2Real, fmi2Real, fmi2Boolean, fmi2Real);
typedef fmi2Status (*step_f)(fmi2Component, fmi2Real, fmi2Real, fmi2Boolean);
typedef fmi2Status (*get_real_f)(fmi2Component, const fmi2ValueReference *, size_t, fmi2Real *);
typedef fmi2Status (*set_real_f)(fmi2Component, const fmi2ValueReference *, size_t, const fmi2Real *);
typedef fmi2Status (*get_integer_f)(fmi2Component, const fmi2ValueReference *, size_t, fmi2Integer *);
typedef fmi2Status (*set_integer_f)(fmi2Component, const fmi2ValueReference *, size_t, const fmi2Integer *);
typedef fmi2Status (*state_f)(fmi2Component, fmi2FMUstate *);
typedef fmi2Status (*set_state_f)(fmi2Component, fmi2FMUstate);
typedef fmi2Status (*state_size_f)(fmi2Component, fmi2FMUstate, size_t *);
typedef fmi2Status (*serialize_f)(fmi2Component, fmi2FMUstate, fmi2Byte *, size_t);
typedef fmi2Status (*deserialize_f)(fmi2Component, const fmi2Byte *, size_t, fmi2FMUstate *);

/* PythonFMU's functions; it stays loaded, as the interpreter does. */
static struct {
  instantiate_f instantiate;
  free_f free_instance;
  setup_f setup;
  plain_f enter, exit, terminate, reset;
  step_f step;
  get_real_f get_real;
  set_real_f set_real;
  get_integer_f get_integer;
  set_integer_f set_integer;
  state_f get_state, free_state;
  set_state_f set_state;
  state_size_f state_size;
  serialize_f serialize;
  deserialize_f deserialize;
} py;

/* What is wrong is always told, what is well only to who asked; a host that named categories hears those. The text goes
 * out as the format itself, with every % doubled: hosts that do not format show it all the same. */
static void shell_log(shell *s, fmi2String name, fmi2Status status, fmi2String text) {
  const int category = status == fmi2OK || status > fmi2Fatal ? CATEGORIES - 1 : (int)status - 1;
  const unsigned bit = 1u << category, all = 1u << (CATEGORIES - 1);
  char format[2048];
  size_t n = 0;
  if (!s->host.logger) return;
  if (s->categories ? !(s->categories & (bit | all)) : !s->logging && status == fmi2OK) return;
  for (; *text && n + 2 < sizeof format; text++) {
    if (*text == '%') format[n++] = '%';
    format[n++] = *text;
  }
  format[n] = 0;
  s->host.logger(s->host.componentEnvironment, name, status, category_name[category], format);
}

/* PythonFMU hands over finished text, so there is nothing to format. A warning that is no answer of a call comes as
 * good, with the category of warnings. */
static void inner_log(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                      fmi2String text, ...) {
  shell *s = environment;
  const int told = status == fmi2OK && category && strcmp(category, category_name[0]) == 0;
  if (status > s->worst && status <= fmi2Fatal) s->worst = status;
  shell_log(s, name, told ? fmi2Warning : status, text);
}

#if defined(_WIN32)
static int here(char *path) {
  static const int anchor;
  HMODULE module;
  DWORD n;
  if (!GetModuleHandleExA(GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT,
                          (LPCSTR)&anchor, &module))
    return 0;
  n = GetModuleFileNameA(module, path, PATH_SIZE);
  return n > 0 && n < PATH_SIZE;
}

static void *open_library(const char *path) {
  return (void *)LoadLibraryExA(path, NULL, LOAD_WITH_ALTERED_SEARCH_PATH);
}

static void *find(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }

static const char *ensure_python(void) { return NULL; }
#else
static int here(char *path) {
  static const int anchor;
  Dl_info info;
  if (!dladdr(&anchor, &info) || !info.dli_fname || strlen(info.dli_fname) >= PATH_SIZE) return 0;
  strcpy(path, info.dli_fname);
  return 1;
}

static void *open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }

static void *find(void *library, const char *name) { return dlsym(library, name); }

/* PythonFMU's library leaves Python's symbols to the host; a host without them gets the newest libpython the loader
 * finds. */
static const char *ensure_python(void) {
  char name[32];
  if (dlsym(RTLD_DEFAULT, "Py_IsInitialized")) return NULL;
  for (int minor = 16; minor >= 10; minor--) {
    snprintf(name, sizeof name, "libpython3.%d.so.1.0", minor);
    if (dlopen(name, RTLD_NOW | RTLD_GLOBAL)) return NULL;
  }
  return "This FMU runs in Python, and no libpython3.so was found; install Python's shared library (Debian: "
         "libpython3-dev) or add its folder "
         "to LD_LIBRARY_PATH.";
}
#endif

static const char *load_inner(void) {
  char path[PATH_SIZE + 16];
  void *library;
  char *dot;
  const char *problem = ensure_python();
  if (problem) return problem;
  if (!here(path)) return "The FMU's own library has no readable path.";
  dot = strrchr(path, '.');
  if (!dot) return "The FMU's own library has no file extension.";
#if defined(_WIN32)
  strcpy(dot, "-pythonfmu.dll");
#else
  strcpy(dot, "-pythonfmu.so");
#endif
  library = open_library(path);
  if (!library)
    return "PythonFMU's library beside the FMU's own could not be loaded; on Windows python3.dll must be on PATH.";
  py.free_instance = (free_f)find(library, "fmi2FreeInstance");
  py.setup = (setup_f)find(library, "fmi2SetupExperiment");
  py.enter = (plain_f)find(library, "fmi2EnterInitializationMode");
  py.exit = (plain_f)find(library, "fmi2ExitInitializationMode");
  py.terminate = (plain_f)find(library, "fmi2Terminate");
  py.reset = (plain_f)find(library, "fmi2Reset");
  py.step = (step_f)find(library, "fmi2DoStep");
  py.get_real = (get_real_f)find(library, "fmi2GetReal");
  py.set_real = (set_real_f)find(library, "fmi2SetReal");
  py.get_integer = (get_integer_f)find(library, "fmi2GetInteger");
  py.set_integer = (set_integer_f)find(library, "fmi2SetInteger");
  py.get_state = (state_f)find(library, "fmi2GetFMUstate");
  py.free_state = (state_f)find(library, "fmi2FreeFMUstate");
  py.set_state = (set_state_f)find(library, "fmi2SetFMUstate");
  py.state_size = (state_size_f)find(library, "fmi2SerializedFMUstateSize");
  py.serialize = (serialize_f)find(library, "fmi2SerializeFMUstate");
  py.deserialize = (deserialize_f)find(library, "fmi2DeSerializeFMUstate");
  py.instantiate = (instantiate_f)find(library, "fmi2Instantiate");
  return py.instantiate ? NULL : "PythonFMU's library beside the FMU's own is not complete.";
}

static int hex(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/* The scheme of a URI may be written in any case (RFC 3986, 3.1). */
static int is_file_uri(const char *uri) {
  static const char scheme[] = "file:";
  size_t n = 0;
  while (scheme[n] && (uri[n] == scheme[n] || uri[n] == scheme[n] - ('a' - 'A'))) n++;
  return scheme[n] == 0;
}

/* file URI -> path with every %xx decoded; 0 if it does not fit. */
static int path_of_uri(const char *uri, char *path) {
  size_t n = 0;
  if (is_file_uri(uri)) {
    uri += 5;
    if (strncmp(uri, "//", 2) == 0) {
      uri += 2;
      while (*uri && *uri != '/') uri++; /* localhost */
    }
#if defined(_WIN32)
    if (uri[0] == '/' && uri[1] && uri[2] == ':') uri++;
#endif
  }
  for (; *uri; uri++, n++) {
    if (n + 1 >= PATH_SIZE) return 0;
    if (uri[0] == '%' && hex(uri[1]) >= 0 && hex(uri[2]) >= 0) {
      path[n] = (char)(16 * hex(uri[1]) + hex(uri[2]));
      uri += 2;
    } else {
      path[n] = *uri;
    }
  }
  while (n > 1 && path[n - 1] == '/') n--;
  path[n] = 0;
  return 1;
}

static int guid_agrees(const char *resources, const char *guid, char *expected, size_t size) {
  char path[PATH_SIZE + 16];
  FILE *file;
  size_t n;
  snprintf(path, sizeof path, "%s/guid.txt", resources);
#if !defined(_WIN32)
  struct stat kind; /* a named pipe would wait for its writer */
  if (stat(path, &kind) != 0 || !S_ISREG(kind.st_mode)) return -1;
#endif
  file = fopen(path, "rb");
  if (!file) return -1;
  n = fread(expected, 1, size - 1, file);
  fclose(file);
  expected[n] = 0;
  return strcmp(expected, guid) == 0;
}

FMI2_EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }

FMI2_EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

FMI2_EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                          const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                                          fmi2Boolean logging) {
  char path[PATH_SIZE], uri[PATH_SIZE + 16], expected[64], text[PATH_SIZE + 256];
  const char *problem = NULL;
  shell *s;
  if (!functions || !(s = calloc(1, sizeof *s))) return NULL;
  s->host = *functions;
  s->own = *functions;
  s->own.logger = inner_log;
  s->own.componentEnvironment = s;
  s->logging = logging;
  if (name && !name[0]) {
    problem = "An instance needs a name.";
  } else if (!name || !guid || !resources) {
    problem = "fmi2Instantiate needs an instance name, a GUID and the location of the resources.";
  } else if (type != fmi2CoSimulation) {
    problem = "This FMU is for co-simulation only.";
  } else if (!path_of_uri(resources, path)) {
    problem = "The location of the resources is too long.";
  } else {
    int agrees = guid_agrees(path, guid, expected, sizeof expected);
    if (agrees < 0) {
      snprintf(text, sizeof text, "The resources of the FMU cannot be read at %s.", path);
      problem = text;
    } else if (!agrees) {
      snprintf(text, sizeof text, "The GUID %.64s does not belong to this FMU; its GUID is %s.", guid, expected);
      problem = text;
    } else {
      problem = py.instantiate ? NULL : load_inner();
    }
  }
  if (!problem) {
#if defined(_WIN32)
    snprintf(uri, sizeof uri, "file:///%s", path);
#else
    snprintf(uri, sizeof uri, "file://%s", path);
#endif
    s->inner = py.instantiate(name, type, guid, uri, &s->own, visible, 1);
    if (s->inner) return s;
    problem = "PythonFMU could not make the instance.";
  }
  shell_log(s, name ? name : "", fmi2Error, problem);
  free(s);
  return NULL;
}

FMI2_EXPORT void fmi2FreeInstance(fmi2Component c) {
  shell *s = c;
  if (!s) return;
  py.free_instance(s->inner);
  free(s);
}

/* After an exception the slave still holds its last good state, so fatal is too strong a word. */
static fmi2Status answer(shell *s, fmi2Status status) {
  if (s->worst > status) status = s->worst;
  s->worst = fmi2OK;
  return status == fmi2Fatal ? fmi2Error : status;
}

#define CALL(...)                                                                                                      \
  shell *s = c;                                                                                                        \
  if (!s) return fmi2Error;                                                                                            \
  s->worst = fmi2OK;                                                                                                   \
  return answer(s, __VA_ARGS__)

FMI2_EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[]) {
  shell *s = c;
  unsigned chosen = 0;
  char text[256];
  if (!s || (n && !categories)) return fmi2Error;
  for (size_t i = 0; i < n; i++) {
    int k = 0;
    while (k < CATEGORIES && (!categories[i] || strcmp(categories[i], category_name[k]) != 0)) k++;
    if (k == CATEGORIES) {
      snprintf(text, sizeof text, "There is no log category '%.64s'; see modelDescription.xml for their names.",
               categories[i] ? categories[i] : "");
      shell_log(s, "", fmi2Error, text);
      return fmi2Error;
    }
    chosen |= 1u << k;
  }
  s->logging = on;
  s->categories = on ? chosen : 0;
  return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance,
                                           fmi2Real start, fmi2Boolean stop_defined, fmi2Real stop) {
  CALL(py.setup(s->inner, tolerance_defined, tolerance, start, stop_defined, stop));
}

FMI2_EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component c) { CALL(py.enter(s->inner)); }

FMI2_EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component c) { CALL(py.exit(s->inner)); }

FMI2_EXPORT fmi2Status fmi2Terminate(fmi2Component c) { CALL(py.terminate(s->inner)); }

FMI2_EXPORT fmi2Status fmi2Reset(fmi2Component c) {
  if (c) ((shell *)c)->refusal.count = 0, ((shell *)c)->last_step = fmi2OK;
  CALL(py.reset(s->inner));
}

/* A host that asks for a refused step again, with nothing changed, is stopped: first by the wish to end, then by an
 * error. */
static fmi2Status refused(shell *s, double time, double step) {
  char text[256];
  const int again = s->refusal.count > 0 && s->refusal.time == time && s->refusal.step == step;
  s->refusal.count = again ? s->refusal.count + 1 : 1;
  s->refusal.time = time;
  s->refusal.step = step;
  if (!again) return fmi2Discard;
  snprintf(
      text, sizeof text,
      "The step from %.6g s over %.6g s was refused %d times with nothing changed in between; the simulation should "
      "end here. Run it anew with a smaller step_size, or go on from another state.",
      time, step, s->refusal.count);
  shell_log(s, "", s->refusal.count == 2 ? fmi2Discard : fmi2Error, text);
  return s->refusal.count == 2 ? fmi2Discard : fmi2Error;
}

FMI2_EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean no_set_state_prior) {
  shell *s = c;
  fmi2Status status;
  if (!s) return fmi2Error;
  s->worst = fmi2OK;
  status = answer(s, py.step(s->inner, time, step, no_set_state_prior));
  if (status == fmi2Discard)
    status = refused(s, time, step);
  else if (status <= fmi2Warning)
    s->refusal.count = 0;
  if (status <= fmi2Warning) s->last_time = time + step;
  s->last_step = status;
  return status;
}

FMI2_EXPORT fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[]) {
  if (n && (!vr || !value)) return fmi2Error;
  CALL(py.get_real(s->inner, vr, n, value));
}

/* After a refused step: whether a value is another one than before. */
static int differs(shell *s, const fmi2ValueReference *vr, size_t n, const fmi2Real *value) {
  fmi2Real present;
  for (size_t i = 0; i < n; i++)
    if (py.get_real(s->inner, vr + i, 1, &present) != fmi2OK || present != value[i]) return 1;
  return 0;
}

FMI2_EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Real value[]) {
  if (n && (!vr || !value)) return fmi2Error;
  if (c && ((shell *)c)->refusal.count && differs(c, vr, n, value)) ((shell *)c)->refusal.count = 0;
  CALL(py.set_real(s->inner, vr, n, value));
}

FMI2_EXPORT fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Integer value[]) {
  if (n && (!vr || !value)) return fmi2Error;
  CALL(py.get_integer(s->inner, vr, n, value));
}

FMI2_EXPORT fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                      const fmi2Integer value[]) {
  if (n && (!vr || !value)) return fmi2Error;
  CALL(py.set_integer(s->inner, vr, n, value));
}

/* All variables are real or whole, so the other types have nothing to get or set. */
static fmi2Status other_type(fmi2Component c, size_t n) {
  shell *s = c;
  if (!s) return fmi2Error;
  if (n == 0) return fmi2OK;
  shell_log(s, "", fmi2Error, "All variables of this FMU are of type Real or Integer.");
  return fmi2Error;
}

#define OTHER_TYPE(function, type)                                                                                     \
  FMI2_EXPORT fmi2Status function(fmi2Component c, const fmi2ValueReference vr[], size_t n, type value[]) {            \
    (void)vr, (void)value;                                                                                             \
    return other_type(c, n);                                                                                           \
  }

OTHER_TYPE(fmi2GetBoolean, fmi2Boolean)
OTHER_TYPE(fmi2GetString, fmi2String)
OTHER_TYPE(fmi2SetBoolean, const fmi2Boolean)
OTHER_TYPE(fmi2SetString, const fmi2String)

FMI2_EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
  shell *s = c;
  fmi2Status status;
  if (!s) return fmi2Error;
  if (!state || !*state) return fmi2OK;
  s->worst = fmi2OK;
  status = answer(s, py.free_state(s->inner, state));
  *state = NULL;
  return status;
}

FMI2_EXPORT fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
  if (!c || !state) return fmi2Error;
  if (*state) fmi2FreeFMUstate(c, state);
  CALL(py.get_state(s->inner, state));
}

FMI2_EXPORT fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  if (!state) return fmi2Error;
  if (c) ((shell *)c)->refusal.count = 0;
  CALL(py.set_state(s->inner, state));
}

FMI2_EXPORT fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
  if (!state || !size) return fmi2Error;
  CALL(py.state_size(s->inner, state, size));
}

FMI2_EXPORT fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  if (!state || !bytes) return fmi2Error;
  CALL(py.serialize(s->inner, state, bytes, size));
}

FMI2_EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                               fmi2FMUstate *state) {
  if (!state || !bytes) return fmi2Error;
  CALL(py.deserialize(s->inner, bytes, size, state));
}

static fmi2Status not_supported(fmi2Component c, const char *text) {
  if (c) shell_log(c, "", fmi2Error, text);
  return fmi2Error;
}

FMI2_EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[],
                                                    size_t n_unknown, const fmi2ValueReference known[], size_t n_known,
                                                    const fmi2Real seed[], fmi2Real value[]) {
  (void)unknown, (void)n_unknown, (void)known, (void)n_known, (void)seed, (void)value;
  return not_supported(c, "Directional derivatives are not provided.");
}

FMI2_EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                                   const fmi2Integer order[], const fmi2Real value[]) {
  (void)vr, (void)n, (void)order, (void)value;
  return not_supported(c, "Inputs are held over a step; their derivatives are not used.");
}

FMI2_EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                                    const fmi2Integer order[], fmi2Real value[]) {
  (void)vr, (void)n, (void)order, (void)value;
  return not_supported(c, "Derivatives of outputs are not provided.");
}

FMI2_EXPORT fmi2Status fmi2CancelStep(fmi2Component c) {
  return not_supported(c, "Steps are finished when fmi2DoStep returns; there is nothing to cancel.");
}

/* What the last step was answered with, the end of the last accepted one and the wish to end can be asked for. */
FMI2_EXPORT fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value) {
  shell *s = c;
  if (!s || !value) return fmi2Error;
  if (kind != fmi2DoStepStatus) return fmi2Discard;
  *value = s->last_step;
  return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
  shell *s = c;
  if (!s || !value) return fmi2Error;
  if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
  *value = s->last_time;
  return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value) {
  (void)kind, (void)value;
  return c ? fmi2Discard : fmi2Error;
}

FMI2_EXPORT fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
  const shell *s = c;
  if (!s || !value) return fmi2Error;
  if (kind != fmi2Terminated) return fmi2Discard;
  *value = s->refusal.count > 1;
  return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value) {
  (void)kind, (void)value;
  return c ? fmi2Discard : fmi2Error;
}
