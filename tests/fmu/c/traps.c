/* Drives an FMU with the traps of floating point on: a program with feenableexcept would be ended by the first one.
 *   traps LIBRARY RESOURCES_URI GUID INPUTS KINDS STEP OUTPUTS [ZERO | KINDREFERENCE=VALUE ...]
 * INPUTS: file of doubles, a row for each step. KINDS: a letter for each input, numbered from 0: r real, i whole.
 * OUTPUTS: FIRST-LAST, read after each step. ZERO: the host divides by zero in each step. VALUE: of a parameter, before
 * the start. Prints the place in the library of each instruction that raised invalid, division by zero or overflow,
 * once, and how many steps were made. x86-64 Linux. */
#define _GNU_SOURCE
#include <fenv.h>
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <ucontext.h>

#include "fmi2_library.h"

enum { MOST_PLACES = 256, MOST_OUTPUTS = 1024, MASKS = 0x1f80, FLAGS = 0x3f, SINGLE_STEP = 0x100 };
static const int WATCHED = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;

static fmi2_library fmu;
static void *place[MOST_PLACES];
static int places;

/* Notes the instruction, lets it pass without a trap, and asks to be called behind it. */
static void trapped(int signal, siginfo_t *info, void *context) {
  ucontext_t *c = context;
  (void)signal;
  int k = 0;
  while (k < places && place[k] != info->si_addr) k++;
  if (k == places && places < MOST_PLACES) place[places++] = info->si_addr;
  c->uc_mcontext.fpregs->mxcsr |= MASKS;
  c->uc_mcontext.gregs[REG_EFL] |= SINGLE_STEP;
}

static void passed(int signal, siginfo_t *info, void *context) {
  ucontext_t *c = context;
  (void)signal, (void)info;
  c->uc_mcontext.fpregs->mxcsr &= ~(unsigned)(WATCHED << 7 | FLAGS);
  c->uc_mcontext.gregs[REG_EFL] &= ~SINGLE_STEP;
}

static void handle(int signal, void (*by)(int, siginfo_t *, void *)) {
  struct sigaction action = {.sa_sigaction = by, .sa_flags = SA_SIGINFO};
  sigaction(signal, &action, NULL);
}

static void set(fmi2Component c, char kind, fmi2ValueReference reference, double value) {
  const fmi2Integer whole = (fmi2Integer)value;
  good(kind == 'i' ? fmu.set_whole(c, &reference, 1, &whole) : fmu.set(c, &reference, 1, &value), "set");
}

int main(int count, char **argument) {
  static const fmi2CallbackFunctions callbacks = {NULL, calloc, free, NULL, NULL};
  static double row[64], value[MOST_OUTPUTS];
  static fmi2ValueReference output[MOST_OUTPUTS];
  if (count < 8) return 1;
  fmu = load_library(argument[1]);
  FILE *inputs = fopen(argument[4], "rb");
  const char *kinds = argument[5];
  const double h = strtod(argument[6], NULL);
  char *end;
  const unsigned long first = strtoul(argument[7], &end, 10), n_outputs = strtoul(end + 1, NULL, 10) + 1 - first;
  const size_t n = strlen(kinds);
  if (inputs == NULL || n > 64 || n_outputs > MOST_OUTPUTS) return 1;
  for (unsigned long k = 0; k < n_outputs; k++) output[k] = (fmi2ValueReference)(first + k);
  handle(SIGFPE, trapped);
  handle(SIGTRAP, passed);
  feenableexcept(WATCHED);
  fmi2Component c = fmu.instantiate("trapped", fmi2CoSimulation, argument[3], argument[2], &callbacks, 0, 0);
  if (c == NULL) return 3;
  bool by_zero = false;
  for (int k = 8; k < count; k++) {
    const fmi2ValueReference reference = (fmi2ValueReference)strtoul(argument[k] + 1, &end, 10);
    if (*end == '=')
      set(c, argument[k][0], reference, strtod(end + 1, NULL));
    else
      by_zero = true;
  }
  initialise(&fmu, c);
  good(fmu.get(c, output, n_outputs, value), "get");
  int k = 0;
  volatile double zero = 0.0, quotient = 0.0;
  for (; fread(row, sizeof *row, n, inputs) == n; k++) {
    for (fmi2ValueReference i = 0; i < n; i++) set(c, kinds[i], i, row[i]);
    if (by_zero) quotient = 1.0 / zero;
    good(fmu.step(c, k * h, h, 1), "step");
    good(fmu.get(c, output, n_outputs, value), "get");
  }
  fmu.release(c);
  (void)quotient;
  fedisableexcept(WATCHED);
  for (int i = 0; i < places; i++) {
    Dl_info in;
    const int found = dladdr(place[i], &in) != 0;
    printf("%s 0x%zx\n", found ? strrchr(in.dli_fname, '/') + 1 : "?",
           (size_t)((char *)place[i] - (found ? (char *)in.dli_fbase : (char *)0)));
  }
  printf("%d steps\n", k);
  return 0;
}
