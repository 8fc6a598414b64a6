/* A host without Python that ends in one of many ways: ends END LIBPYTHON (LIBRARY RESOURCES_URI GUID)...
 * LIBPYTHON is loaded first, as the loader's path would have it. */
#define _GNU_SOURCE
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fmi2_library.h"

enum { MOST = 8 };

static fmi2_library fmu[MOST];
static fmi2Component instance[MOST];
static int made;
static char **place; /* library, resources and GUID of the first */
static const fmi2CallbackFunctions callbacks = {NULL, calloc, free, NULL, NULL};

static void make(int i) {
  char **own = place + 3 * i;
  fmi2FMUstate state = NULL;
  fmu[i] = load_library(own[0]);
  instance[i] = fmu[i].instantiate("ends", fmi2CoSimulation, own[2], own[1], &callbacks, 0, 0);
  if (instance[i] == NULL) exit(3);
  initialise(&fmu[i], instance[i]);
  good(fmu[i].step(instance[i], 0.0, 0.01, 1), "step");
  good(fmu[i].get_state(instance[i], &state), "get state");
}

static void release(void) {
  for (int i = 0; i < made; i++) {
    good(fmu[i].step(instance[i], 0.01, 0.01, 1), "late step");
    fmu[i].release(instance[i]);
  }
}

static void unload(void) {
  for (int i = 0; i < made; i++) {
    void *library = open_library(place[3 * i]);
    dlclose(library);
    dlclose(library);
  }
}

static void *step_for_ever(void *which) {
  const int i = *(int *)which;
  for (double time = 0.01;; time += 0.01) good(fmu[i].step(instance[i], time, 0.01, 1), "step");
  return NULL;
}

int main(int count, char **argument) {
  static int number[MOST];
  const char *end = argument[1];
  void *python = dlopen(argument[2], RTLD_NOW | RTLD_GLOBAL), *thread = NULL;
  const int own = strcmp(end, "interpreter ended") == 0;
  pthread_t id;
  if (python == NULL) return 2;
  place = argument + 3;
  if (strcmp(end, "handler") == 0) atexit(release);
  if (own) {
    ((void (*)(int))find(python, "Py_InitializeEx"))(0);
    thread = ((void *(*)(void))find(python, "PyEval_SaveThread"))();
  }
  for (; made < (count - 3) / 3; made++) make(made);
  if (strcmp(end, "freed") == 0 || strcmp(end, "unloaded") == 0) release();
  if (strcmp(end, "unloaded") == 0 || strcmp(end, "unloaded alone") == 0) unload();
  if (strcmp(end, "threads") == 0) {
    for (int i = 0; i < made; i++) number[i] = i, pthread_create(&id, NULL, step_for_ever, &number[i]);
    usleep(100000);
  }
  if (own) {
    ((void (*)(void *))find(python, "PyEval_RestoreThread"))(thread);
    if (((int (*)(void))find(python, "Py_FinalizeEx"))() != 0) return 7;
    release();
    make(0);
  }
  if (strcmp(end, "fork") == 0 && fork() != 0) {
    int status = 0;
    wait(&status);
    return status == 0 ? 0 : 8;
  }
  return 0;
}
