/* At 0.05 s it does what the input u says; the output is the time before. */
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "small.h"

enum { QUIET, LEAVE, CRASH, NOT_A_NUMBER, MOVE, PRINT, FORK, CLOSE, EAT, WRITE };

/* Starts three processes whose parents have ended. */
static void fork_away(void) {
  for (int k = 0; k < 3; k++) {
    pid_t parent = fork();
    if (parent > 0) waitpid(parent, NULL, 0);
    if (!parent) {
      setsid();
      if (!fork()) {
        char name[] = "odd_child";
        execlp("sleep", name, "1000", (char *)NULL);
      }
      _exit(0);
    }
  }
}

static fmi2Status advance(small *s, double end) {
  s->time = s->y = end;
  if (end < 0.045 || end > 0.055) return fmi2OK;
  switch ((int)s->u) {
  case LEAVE:
    exit(0);
  case CRASH:
    raise(SIGSEGV);
    break;
  case NOT_A_NUMBER:
    s->y = NAN;
    break;
  case MOVE:
    if (chdir("/")) return fmi2Error;
    break;
  case PRINT:
    for (int k = 0; k < 20000000; k++) printf("a line of a library that says more than anybody reads\n");
    break;
  case FORK:
    fork_away();
    break;
  case CLOSE:
    for (int k = 0; k < 256; k++) close(k);
    break;
  case EAT:
    for (long k = 0; k < 1000000; k++) {
      volatile char *block = malloc(100000000);
      if (!block) return fmi2Error;
      for (long i = 0; i < 100000000; i += 4096) block[i] = 1;
    }
    break;
  case WRITE: {
    int file = open("left_behind", O_CREAT | O_WRONLY, 0600);
    if (file < 0 || write(file, "x", 1) != 1) return fmi2Error;
    break;
  }
  default:
    break;
  }
  return fmi2OK;
}
