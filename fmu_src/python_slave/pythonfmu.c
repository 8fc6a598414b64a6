/* Finds and loads PythonFMU's export library. */
#if !defined(_WIN32)
#define _GNU_SOURCE
#include <dlfcn.h>
#else
#include <windows.h>
#endif
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pythonfmu.h"

enum { PATH_SIZE = 4096 };

#if defined(_WIN32)
/* Path of this library; false if it is not found or too long. */
static bool own_path(char *path) {
  static const int anchor;
  HMODULE module;
  if (!GetModuleHandleExA(GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT,
                          (LPCSTR)&anchor, &module))
    return false;
  const DWORD n = GetModuleFileNameA(module, path, PATH_SIZE);
  return n > 0 && n < PATH_SIZE;
}

static void *open_library(const char *path) {
  return (void *)LoadLibraryExA(path, NULL, LOAD_WITH_ALTERED_SEARCH_PATH);
}

/* Address of a function of a library; NULL: there is none. */
static void *find_function(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }

static bool python_is_there(void) { return true; } /* else the library does not load, which is said */

/* The library that has Python's functions. */
static void *python_library(void) { return (void *)GetModuleHandleA("python3.dll"); }

static void keep_python(const pythonfmu *py) { (void)py; } /* PythonFMU leaves it alone there */

static const char *const SUFFIX = "-pythonfmu.dll";
#else
/* Path of this library; false if it is not found or too long. */
static bool own_path(char *path) {
  static const int anchor;
  Dl_info info;
  if (!dladdr(&anchor, &info) || info.dli_fname == NULL || strlen(info.dli_fname) >= PATH_SIZE) return false;
  strcpy(path, info.dli_fname);
  return true;
}

static void *open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }

/* Address of a function of a library; NULL: there is none. */
static void *find_function(void *library, const char *name) { return dlsym(library, name); }

/* The library that has Python's functions. */
static void *python_library(void) { return RTLD_DEFAULT; }

/* PythonFMU's library leaves Python's symbols to the host; a host without them gets the newest libpython the loader
 * finds. */
static bool python_is_there(void) {
  char name[32];
  if (find_function(python_library(), "Py_IsInitialized") != NULL) return true;
  for (int minor = 16; minor >= 10; minor--) {
    snprintf(name, sizeof name, "libpython3.%d.so.1.0", minor);
    if (dlopen(name, RTLD_NOW | RTLD_GLOBAL) != NULL) return true;
  }
  return false;
}

/* PythonFMU ends an interpreter that it started, under instances and threads that are still there, and releases its own
 * record of that twice: when the process deletes what is static and when it unloads the library. So the interpreter is
 * started here, for good, and the record is released before both. */
static void keep_python(const pythonfmu *py) {
  void (*const initialize)(int) = (void (*)(int))find_function(python_library(), "Py_InitializeEx");
  void *(*const unlock)(void) = (void *(*)(void))find_function(python_library(), "PyEval_SaveThread");
  if (!py->is_initialized()) {
    initialize(0); /* signals are the host's */
    unlock();
  }
  atexit(py->release_record); /* registered last, so called before what the library does at the end */
}

static const char *const SUFFIX = "-pythonfmu.so";
#endif

/* Fills the table of functions; false if one is missing. */
static bool find_functions(pythonfmu *py, void *library) {
  const struct {
    void **function;
    const char *name;
  } all[] = {
      {(void **)&py->instantiate, "fmi2Instantiate"},
      {(void **)&py->free_instance, "fmi2FreeInstance"},
      {(void **)&py->setup, "fmi2SetupExperiment"},
      {(void **)&py->enter, "fmi2EnterInitializationMode"},
      {(void **)&py->exit, "fmi2ExitInitializationMode"},
      {(void **)&py->terminate, "fmi2Terminate"},
      {(void **)&py->reset, "fmi2Reset"},
      {(void **)&py->step, "fmi2DoStep"},
      {(void **)&py->get_real, "fmi2GetReal"},
      {(void **)&py->set_real, "fmi2SetReal"},
      {(void **)&py->get_integer, "fmi2GetInteger"},
      {(void **)&py->set_integer, "fmi2SetInteger"},
      {(void **)&py->release_record, "finalizePythonInterpreter"},
      {(void **)&py->is_initialized, "Py_IsInitialized"},
      {(void **)&py->enter_python, "PyGILState_Ensure"},
      {(void **)&py->leave_python, "PyGILState_Release"},
  };
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    const bool of_python = strncmp(all[i].name, "Py", 2) == 0;
    if ((*all[i].function = find_function(of_python ? python_library() : library, all[i].name)) == NULL) return false;
  }
  return true;
}

const pythonfmu *pythonfmu_load(char *problem, size_t size) {
  static pythonfmu py;
  char path[PATH_SIZE + 16];
  char *dot = own_path(path) ? strrchr(path, '.') : NULL;
  void *library = NULL;
  problem[0] = 0;
  if (!python_is_there())
    snprintf(problem, size,
             "This FMU runs in Python, and no libpython3.so was found; install Python's shared library (Debian: "
             "libpython3-dev) or add its folder to LD_LIBRARY_PATH.");
  else if (dot == NULL)
    snprintf(problem, size, "The path of the FMU's own library could not be found.");
  else
    library = open_library(strcpy(dot, SUFFIX) != NULL ? path : NULL);
  if (library == NULL && problem[0] == 0)
    snprintf(problem, size,
             "PythonFMU's library beside the FMU's own could not be loaded; on Windows python3.dll must be on PATH.");
  if (library == NULL) return NULL;
  if (find_functions(&py, library)) {
    keep_python(&py);
    return &py;
  }
  snprintf(problem, size, "PythonFMU's library beside the FMU's own is not complete.");
  return NULL;
}
