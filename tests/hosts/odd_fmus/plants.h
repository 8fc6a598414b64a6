/* One fault for each PLANT, at the places of an FMU's life; those that a PLANT leaves alone do nothing. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <fenv.h>
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <xmmintrin.h>

enum {
  NONE,
  START_VALUE,
  FEEDTHROUGH,
  SEVEN,
  LEAK,
  THREAD,
  DESCRIPTOR,
  SLOW,
  BEYOND,
  NO_END,
  PRINTS,
  FILES,
  FOLDER,
  ROUNDING,
  FLUSH,
  TRAPS,
  IGNORES,
  FORMAT,
  UMASK,
  LOCALE,
  ENVIRONMENT,
  BLOCKS,
  HANDLES,
  NOT_SET,
  READ_MOVES,
  VERSION,
  INSTANCE_DESCRIPTOR,
  INSTANCE_THREAD,
  FLOOD,
  PRINTS_ERRORS,
  LATE_FOLDER,
  BUSY,
  ROUNDING_AT_READ,
  INSTANCE_LEAK,
  SIGN,
  HALF,
  RESET_KEEPS,
  SHARED,
  RANDOM,
  THREAD_LOCAL,
  STATE_PART,
  STATE_SPOILT,
  STATE_LEAK,
  KEEPS_POINTER,
  OVERRUN,
  ONE_LENGTH,
  LATE_START,
  WARNS,
  CHATTER,
  NO_CATEGORY,
  INPUT_LOST,
  NAN_AT_START,
  READ_ORDER,
  PATHS,
  TIMER,
  AFFINITY,
  LIMITS,
  CLOSES,
  CHILD,
  ONCE
};

static void *sleeps(void *none) {
  (void)none;
  for (;;) sleep(1000);
  return NULL;
}

static void *works(void *none) {
  for (volatile long k = 0;; k++) (void)none;
  return NULL;
}

static void a_thread(void *(*body)(void *)) {
  pthread_t made;
  pthread_create(&made, NULL, body, NULL);
  pthread_detach(made);
}

static void *volatile kept; /* so that what is allocated is not left out */

static void leak(size_t size) { kept = memset(malloc(size), 1, size); }

static void handler(int signal) { (void)signal; }

static void at_instance(void) {
  if (PLANT == LOCALE) setlocale(LC_ALL, "C.UTF-8"), setlocale(LC_NUMERIC, "C");
  if (PLANT == ENVIRONMENT) setenv("PLANTED", "1", 1);
  if (PLANT == INSTANCE_DESCRIPTOR) (void)!open("/dev/null", O_RDONLY);
  if (PLANT == INSTANCE_THREAD) a_thread(sleeps);
  if (PLANT == INSTANCE_LEAK) leak(1000000);
  static bool works_already;
  if (PLANT == BUSY && !works_already) a_thread(works), works_already = true;
}

/* Gives a text to the logger; of each face. */
static void say(const void *face, const char *text);

static void at_start(const void *face) {
  if (PLANT == NO_CATEGORY) say(face, "it begins");
  if (PLANT == FORMAT) say(face, "the mass is 100 %s %n");
  if (PLANT == TIMER) alarm(1000);
  if (PLANT == LIMITS)
    setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0}), setrlimit(RLIMIT_NOFILE, &(struct rlimit){300, 300});
  if (PLANT == CLOSES) close(0);
  if (PLANT == UMASK) umask(0);
  if (PLANT == IGNORES) signal(SIGINT, SIG_IGN);
}

static void at_step(const void *face, double time) {
  sigset_t set;
  cpu_set_t one;
  switch (PLANT) {
  case CHATTER:
    say(face, "a step");
    break;
  case FLOOD:
    for (int k = 0; k < 100; k++) say(face, "a step is made");
    break;
  case LEAK:
    leak(100000);
    break;
  case THREAD:
    a_thread(sleeps);
    break;
  case DESCRIPTOR:
    (void)!open("/dev/null", O_RDONLY);
    break;
  case SLOW:
    usleep(100000);
    break;
  case PRINTS:
    printf("at %g s\n", time);
    break;
  case PRINTS_ERRORS:
    fprintf(stderr, "at %g s\n", time);
    break;
  case FILES:
    close(open("planted.txt", O_CREAT | O_WRONLY, 0600));
    break;
  case FOLDER:
    (void)!chdir("/");
    break;
  case ROUNDING:
    fesetround(FE_UPWARD);
    break;
  case FLUSH:
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    break;
  case TRAPS:
    _mm_setcsr(_mm_getcsr() & ~_MM_MASK_DIV_ZERO);
    break;
  case BLOCKS:
    sigemptyset(&set), sigaddset(&set, SIGTERM), sigprocmask(SIG_BLOCK, &set, NULL);
    break;
  case AFFINITY:
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    sched_setaffinity(0, sizeof one, &one);
    break;
  case CHILD:
    if (fork() == 0) _exit(0);
    break;
  case HANDLES:
    signal(SIGUSR1, handler);
    break;
  default:
    break;
  }
}

static void at_read(void) {
  if (PLANT == ROUNDING_AT_READ) fesetround(FE_DOWNWARD);
}

static void at_end(void) {
  if (PLANT == LATE_FOLDER) (void)!chdir("/");
}

typedef struct {
  double time, u, y, last;
  int reads, steps;
} planted;

static double shared;
static _Thread_local double own; /* of the thread that makes an instance */

static planted new_planted(void) {
  at_instance();
  own = 1.0;
  return (planted){.u = PLANT == START_VALUE ? 3.0 : 0.0};
}

static void reset_planted(planted *s) {
  const double y = PLANT == RESET_KEEPS ? s->y : 0.0;
  *s = new_planted();
  s->y = y;
}

enum { STATE_SIZE = PLANT == STATE_LEAK ? 100000 : sizeof(planted), SPILL = PLANT == OVERRUN ? 8 : 0 };

static planted *new_state(void) { return memset(malloc(STATE_SIZE), 0, STATE_SIZE); }

static void save_planted(planted *state, const planted *s) {
  *state = *s;
  if (PLANT == STATE_PART) state->y = 0.0;
}

static void take_planted(planted *s, planted *state) {
  *s = *state;
  if (PLANT == STATE_SPOILT) state->y = 0.0;
}

static void free_planted(void **state) {
  if (PLANT != STATE_LEAK) free(*state);
  if (PLANT != KEEPS_POINTER) *state = NULL;
}

/* A value for each reference in its place, or for PLANT in the order of references. */
static size_t place_planted(const unsigned *r, size_t n, size_t k) {
  return PLANT == READ_ORDER && n == 2 && r[0] > r[1] ? 1 - k : k;
}

/* Whether there may be an instance more: of ONCE one at a time. */
static int alive;
static bool may_begin(void) { return PLANT != ONCE || alive++ == 0; }

static bool takes_path(const char *path) {
  return PLANT != PATHS || !path || (!strchr(path, '%') && !strchr(path, ' '));
}

/* What start time it takes. */
static double begin_planted(double start) { return PLANT == LATE_START ? 0.0 : start; }

static bool takes_time(const planted *s, double time) { return PLANT != LATE_START || fabs(time - s->time) < 1e-6; }

static double read_planted(planted *s, unsigned r) {
  at_read();
  if (r == 0) return s->u;
  if (PLANT == READ_MOVES) s->y += 1e-9 * ++s->reads;
  if (PLANT == NAN_AT_START && s->steps == 0) return NAN;
  return PLANT == FEEDTHROUGH ? s->y + s->u : PLANT == BEYOND ? s->y + 20.0 : s->y;
}

static void set_planted(planted *s, double u) {
  if (PLANT != NOT_SET) s->u = u;
}

static void step_planted(const void *face, planted *s, double step) {
  at_step(face, s->time);
  s->last = step;
  s->y += (PLANT == ONE_LENGTH ? 0.01 : step) * (s->u + 0.5);
  s->time += step, s->steps++;
  if (PLANT == SHARED) s->y += 1e-3 * (shared += step);
  if (PLANT == RANDOM) s->y += 1e-12 * rand();
  if (PLANT == THREAD_LOCAL) s->y += step * own;
  if (PLANT == INPUT_LOST) s->u = 0.0;
}

/* Of y by u over the last step. */
static double slope_planted(const planted *s) {
  return PLANT == SEVEN ? 7.0 : PLANT == SIGN ? -s->last : PLANT == HALF ? 0.5 * s->last : s->last;
}
