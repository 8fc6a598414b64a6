/* Engine, torque converter, automatic gears and differential: equal torques on two wheels, reaction on the frame that
 * carries them. A differential that locks moves up to half of LOCKING times the whole torque from the faster wheel to
 * the slower one, along x/sqrt(1 + x^2) of the difference of their rates over LOCKING_RATE.
 * Signals: chi of the left and right wheel (absolute rates about the axis f x g), f (3), g (3) orthonormal on the
 * frame.
 * Reals: see the enum, then one total ratio per gear, tallest last. Integers: throttle input (0..1), number of gears.
 * States: gear, gear before the last shift, time since it, mean wheel rate at the start of the step. Outputs: engine
 * speed rad/s, gear, mean torque per wheel N m, engine torque N m, power on the left and right wheel W,
 * torque on the left and right wheel N m.
 * With a selector its input is a third integer, ratio of reverse, engage speed and engage time are three more reals, and
 * the states of selector.h follow. Reverse is one gear, with the torque of a first gear of its ratio turned round.
 * A fourth integer is an input that asks for a forward gear, 0: as the drive shifts by itself. A shift that is asked for
 * begins with the step that has the request, once the last one is over. With a fifth integer it may be -1: none.
 * A fifth integer is the input of a clutch pedal, 0 released to 1 pressed: a friction clutch behind the converter, whose
 * torque is at most the part 1 - pedal of the largest that the drive has in its gear. Where the drive has more, it slips.
 *
 * There is no engine inertia: with turbine speed wt = ratio * W and stall speed ws (idle .. stall with the throttle)
 * the engine turns at sqrt(ws^2 + wt^2). Gears change only in `accept`, between steps, and the ratio then moves over
 * in RAMP seconds, so torque is continuous; the clock of a shift starts where the wheel rate crossed the shift speed
 * within the step, so its time does not depend on the step. */
#include "../algebra/small_vectors.h"
#include "element.h"
#include "selector.h"

enum {
  MAX_TORQUE,
  MAX_POWER,
  EFFICIENCY,
  STALL_FACTOR, /* converter torque ratio at stall */
  COUPLING_RATIO, /* speed ratio of the converter from which on the torque ratio is 1 */
  IDLE_SPEED,
  STALL_SPEED,
  LIMIT_SPEED, /* engine speed where the limiter sets in */
  CREEP_TORQUE, /* per wheel, throttle closed */
  CREEP_SPEED, /* wheel speed where creep has faded */
  DRAG_TORQUE, /* of the engine at its limit speed, throttle closed */
  UP_CLOSED, /* shift speeds of the turbine, throttle closed and open */
  UP_OPEN,
  DOWN_CLOSED,
  DOWN_OPEN,
  DWELL,
  RAMP,
  LOCKING,
  RATIOS
};
enum { REVERSE_RATIO, ENGAGE_SPEED, ENGAGE_TIME, OF_SELECTOR }; /* behind the ratios */
enum { STATES = 4 };
#define LIMITER_WIDTH 0.05 /* of the limit speed */
#define LONG_AGO 1e3 /* s */
#define LOCKING_RATE 0.5 /* rad/s */
#define BARELY 1e-6 /* of the stall speed: round-off of a car at rest */
/* Bits of the pieces of its law: the turbine turns forward, the converter raises the torque, the largest power or the
 * limit of speed holds; from GEARS on the gear, 0 for none, one more than there are for reverse; the clutch slips. */
enum { TURNS = 1, CONVERTS = 2, BY_POWER = 4, LIMITED = 8, CUT_OFF = 16, GEARS = 32, SLIPS = 1 << 16 };

static int gear_of(double slot, int gears) { return slot >= gears ? gears : slot >= 1.0 ? (int)slot : 1; }

static double frame_rate(const ali3_element_args *a) {
  return 0.5 * (ali3_dot(a->ud + 2, a->u + 5) - ali3_dot(a->ud + 5, a->u + 2));
}

static double wheel_rate(const ali3_element_args *a) { return 0.5 * (a->ud[0] + a->ud[1]) - frame_rate(a); }

/* The gear that is asked for, 0 for none. */
static int asked_gear(const ali3_element_args *a) {
  return a->nint > 3 && a->integer[3] >= 0 ? (int)ali3_clamp(a->input[a->integer[3]], 0.0, a->integer[1]) : 0;
}

static double throttle_of(const ali3_element_args *a) { return ali3_clamp(a->input[a->integer[0]], 0.0, 1.0); }

/* Total wheel torque at mean relative wheel rate W; also its slope dT/dW, engine speed, engine torque and piece. */
static double torque(const double *p, double ratio, double throttle, double W, double *slope, double *speed,
                     double *engine, uint32_t *piece) {
  const double turbine = ratio * W > 0.0 ? ratio * W : 0.0, closed = 1.0 - throttle;
  double stall = p[IDLE_SPEED] + throttle * (p[STALL_SPEED] - p[IDLE_SPEED]);
  if (!(stall > 1.0)) stall = 1.0;
  const double w = sqrt(stall * stall + turbine * turbine), dw = ratio * turbine / w;
  double factor = 1.0, dfactor = 0.0, full = p[MAX_TORQUE], dfull = 0.0;
  if (turbine < p[COUPLING_RATIO] * w) {
    factor += (p[STALL_FACTOR] - 1.0) * (1.0 - turbine / w / p[COUPLING_RATIO]);
    if (W > 0.0) dfactor = -(p[STALL_FACTOR] - 1.0) / p[COUPLING_RATIO] * ratio * (stall / w) * (stall / w) / w;
  }
  if (full * w > p[MAX_POWER]) full = p[MAX_POWER] / w, dfull = -full / w * dw;
  const double over = (w - p[LIMIT_SPEED]) / (LIMITER_WIDTH * p[LIMIT_SPEED]);
  if (over >= 1.0) {
    full = dfull = 0.0;
  } else if (over > 0.0) {
    dfull = dfull * (1.0 - over) - full * dw / (LIMITER_WIDTH * p[LIMIT_SPEED]);
    full *= 1.0 - over;
  }
  if (turbine > BARELY * stall) *piece |= TURNS;
  if (turbine < p[COUPLING_RATIO] * w) *piece |= CONVERTS;
  if (p[MAX_TORQUE] * w > p[MAX_POWER]) *piece |= BY_POWER;
  if (over > 0.0) *piece |= over < 1.0 ? LIMITED : CUT_OFF;
  const double x = ali3_clamp(W / p[CREEP_SPEED], 0.0, 1.0), drag = closed * p[DRAG_TORQUE] / p[LIMIT_SPEED];
  *speed = w;
  *engine = throttle * full - drag * turbine;
  *slope = ratio * p[EFFICIENCY] * throttle * (dfactor * full + factor * dfull) -
           (W > 0.0 ? ratio * ratio * drag : 0.0) -
           2.0 * closed * p[CREEP_TORQUE] * 6.0 * x * (1.0 - x) / p[CREEP_SPEED];
  return ratio * (p[EFFICIENCY] * throttle * factor * full - drag * turbine) +
         2.0 * closed * p[CREEP_TORQUE] * (1.0 - x * x * (3.0 - 2.0 * x));
}

static const double *of_selector(const ali3_element_args *a) { return a->real + RATIOS + a->integer[1]; }

static double selector_input(const ali3_element_args *a) { return a->input[a->integer[2]]; }

/* The part of the torque of a gear that its clutch hands on, 1 where it does not slip. */
static double clutched(ali3_element_args *a, double ratio, double total) {
  const double *p = a->real, pedal = a->nint > 4 ? ali3_clamp(a->input[a->integer[4]], 0.0, 1.0) : 0.0;
  if (!(pedal > 0.0)) return 1.0;
  const double most = (1.0 - pedal) * (ratio * p[EFFICIENCY] * p[STALL_FACTOR] * p[MAX_TORQUE] + 2.0 * p[CREEP_TORQUE]);
  if (fabs(total) <= most) return 1.0;
  a->piece |= SLIPS;
  return most / fabs(total);
}

/* In the direction of the selector with the share of the torque that is engaged; without torque the engine runs up to
 * its limit speed. The torque of a clutch that slips does not change with the speed. */
static double selected(ali3_element_args *a, double ratio, double *slope, double *speed, double *engine,
                       int *direction) {
  const double *p = a->real, *q = of_selector(a), throttle = throttle_of(a), W = wheel_rate(a);
  double share;
  *direction =
      ali3_selector_step(a->y_old + STATES, a->y_new + STATES, selector_input(a), a->h / q[ENGAGE_TIME], &share);
  const double free = p[IDLE_SPEED] + throttle * (p[LIMIT_SPEED] - p[IDLE_SPEED]);
  *slope = *engine = 0.0;
  *speed = free;
  if (*direction == 0) return 0.0;
  const double sign = *direction, geared = sign < 0.0 ? q[REVERSE_RATIO] : ratio;
  const double total = torque(p, geared, throttle, sign * W, slope, speed, engine, &a->piece);
  const double held = clutched(a, geared, total);
  if (held < 1.0) *slope = 0.0;
  share *= held;
  *slope *= share;
  *engine *= share;
  *speed = share * *speed + (1.0 - share) * free;
  return sign * share * total;
}

/* Moves up to a torque from the faster wheel to the slower one. */
static void lock(ali3_element_args *a, double most) {
  const double x = (a->ud[0] - a->ud[1]) / LOCKING_RATE, w = sqrt(1.0 + x * x), moved = most * x / w;
  const double b[8] = {1.0, -1.0};
  for (int i = 0; i < 2; i++) {
    a->f[i] -= moved * b[i];
    a->out[6 + i] -= moved * b[i];
    a->out[4 + i] -= moved * b[i] * (a->ud[i] - frame_rate(a));
  }
  if (a->S) ali3_add_outer(a->S, 8, a->wC * most / (LOCKING_RATE * w * w * w), b);
}

static void evaluate(ali3_element_args *a) {
  const double *p = a->real, *ratios = p + RATIOS;
  const int gears = a->integer[1], gear = gear_of(a->y_old[0], gears), before = gear_of(a->y_old[1], gears);
  for (int i = 0; i < STATES; i++) a->y_new[i] = a->y_old[i];
  if (a->h > 0.0) a->y_new[2] = ali3_clamp(a->y_old[2] + a->h, 0.0, LONG_AGO);
  const double x = p[RAMP] > 0.0 ? ali3_clamp(a->y_new[2] / p[RAMP], 0.0, 1.0) : 1.0;
  const double ratio = ratios[before - 1] + (ratios[gear - 1] - ratios[before - 1]) * x * x * (3.0 - 2.0 * x);
  double slope, speed, engine;
  int direction = 1;
  const double total = a->nint > 2
                           ? selected(a, ratio, &slope, &speed, &engine, &direction)
                           : torque(p, ratio, throttle_of(a), wheel_rate(a), &slope, &speed, &engine, &a->piece);
  a->piece |= (uint32_t)(GEARS * (direction > 0 ? gear : direction < 0 ? gears + 1 : 0));
  double b[8] = {0.5, 0.5}; /* the mean relative rate is b . ud */
  for (int i = 0; i < 3; i++) b[2 + i] = -0.5 * a->u[5 + i], b[5 + i] = 0.5 * a->u[2 + i];
  for (int i = 0; i < 8; i++) a->f[i] = total * b[i];
  if (a->S && slope < 0.0) ali3_add_outer(a->S, 8, -a->wC * slope, b); /* turning of f, g within the step is left out */
  a->potential = 0.0;
  a->out[0] = speed;
  a->out[1] = direction > 0 ? gear : direction;
  a->out[2] = 0.5 * total;
  a->out[3] = engine;
  for (int i = 0; i < 2; i++) {
    a->out[4 + i] = 0.5 * total * (a->ud[i] - frame_rate(a));
    a->out[6 + i] = 0.5 * total;
  }
  if (p[LOCKING] > 0.0) lock(a, 0.5 * p[LOCKING] * fabs(total));
}

/* Wheel rates of the shift up and down from a gear. */
static void shift_rates(const double *p, int gear, double throttle, double *up, double *down) {
  *up = (p[UP_CLOSED] + throttle * (p[UP_OPEN] - p[UP_CLOSED])) / p[RATIOS + gear - 1];
  *down = (p[DOWN_CLOSED] + throttle * (p[DOWN_OPEN] - p[DOWN_CLOSED])) / p[RATIOS + gear - 1];
}

/* The gear that fits the speed from `gear` on, long engaged. */
static void fitting_gear(ali3_element_args *a, int gear, double rate) {
  const double *p = a->real, throttle = throttle_of(a);
  double up, down;
  for (shift_rates(p, gear, throttle, &up, &down); rate > up && gear < a->integer[1];)
    shift_rates(p, ++gear, throttle, &up, &down);
  a->y_new[0] = a->y_new[1] = gear;
  a->y_new[2] = LONG_AGO;
}

static void accept(ali3_element_args *a) {
  const double *p = a->real, throttle = throttle_of(a), now = wheel_rate(a), before = a->y_new[3];
  const int gears = a->integer[1], start = !(a->h > 0.0);
  int gear = gear_of(a->y_new[0], gears), engaged = 0;
  double up, down, limit;
  a->y_new[3] = now;
  if (a->nint > 2) {
    engaged = ali3_selector_accept(a->y_new + STATES, selector_input(a), now, of_selector(a)[ENGAGE_SPEED], start);
    if (engaged && !start) gear = 1;
  }
  const int asked = asked_gear(a);
  if (start || engaged) {
    fitting_gear(a, gear, now);
    if (asked > 0) a->y_new[0] = a->y_new[1] = asked;
    return;
  }
  if (asked > 0) {
    if (asked == gear || a->y_new[2] < p[RAMP]) return;
    a->y_new[1] = gear;
    a->y_new[0] = asked;
    a->y_new[2] = a->h;
    return;
  }
  if (a->y_new[2] < p[DWELL]) return;
  shift_rates(p, gear, throttle, &up, &down);
  a->y_new[1] = gear;
  if (now > up && gear < gears) {
    limit = up;
    gear++;
  } else if (now < down && gear > 1) {
    limit = down;
    gear--;
  } else {
    return;
  }
  const double crossed = fabs(now - before) > 0.0 ? ali3_clamp((now - limit) / (now - before), 0.0, 1.0) : 0.0;
  a->y_new[0] = gear;
  a->y_new[2] = ali3_clamp(crossed * a->h, 0.0, a->y_new[2] - p[DWELL]);
}

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                         int32_t n_inputs, int32_t n_roads) {
  (void)nsig, (void)n_roads;
  if (nint < 2 || nint > 5)
    return "an automatic drive has two integers, with a selector three, a request four, a clutch five";
  const int32_t more = nint > 2 ? OF_SELECTOR : 0;
  for (int i = 0; i < nint; i++)
    if (i != 1 && (integer[i] < (i == 3 && nint > 4 ? -1 : 0) || integer[i] >= n_inputs))
      return "an automatic drive names an input that does not exist";
  if (integer[1] < 1 || integer[1] != nreal - RATIOS - more)
    return "an automatic drive needs one ratio per gear, at least one";
  for (int i = 0; i < nreal; i++)
    if (real[i] < 0.0) return "the numbers of an automatic drive must not be negative";
  if (!(real[IDLE_SPEED] > 0.0 && real[STALL_SPEED] >= real[IDLE_SPEED] && real[LIMIT_SPEED] > real[STALL_SPEED]))
    return "the engine speeds of an automatic drive must be positive and in the order idle, stall, limit";
  if (!(real[COUPLING_RATIO] > 0.0 && real[CREEP_SPEED] > 0.0))
    return "coupling ratio and creep speed of an automatic drive must be positive";
  if (real[DWELL] < real[RAMP]) return "the dwell time of an automatic drive must not be shorter than its ramp";
  if (more > 0 && !(real[nreal - OF_SELECTOR + REVERSE_RATIO] > 0.0 && real[nreal - OF_SELECTOR + ENGAGE_TIME] > 0.0))
    return "the ratio of reverse and the engage time of an automatic drive must be positive";
  return 0;
}

static int32_t states(int32_t nint) { return nint > 2 ? STATES + ALI3_SELECTOR_STATES : STATES; }

const ali3_element_type ali3_automatic_drive = {
    .evaluate = evaluate,
    .accept = accept,
    .nsig = 8,
    .nreal = -1,
    .nint = -1,
    .nstate = -1,
    .states = states,
    .nout = 8,
    .check = check,
};
