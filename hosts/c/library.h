/* Opens shared libraries, and ends the program with a message; for the hosts in C. */
#ifndef HOSTS_LIBRARY_H
#define HOSTS_LIBRARY_H
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#if defined(_WIN32)
#include <windows.h>
static void *open_library(const char *path) { return (void *)LoadLibraryA(path); }
static void *find(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }
#else
#include <dlfcn.h>
static void *open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *find(void *library, const char *name) { return dlsym(library, name); }
#endif

/* Ends the program with a message. */
static void stop(int status, const char *format, ...) {
  va_list list;
  va_start(list, format);
  vfprintf(stderr, format, list);
  fputc('\n', stderr);
  va_end(list);
  exit(status);
}

/* A function of the library, without which the program ends. */
static void *function(void *library, const char *name) {
  void *found = find(library, name);
  if (found == NULL) stop(3, "the library has no %s", name);
  return found;
}
#endif
