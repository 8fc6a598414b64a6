/* Engine, torque converter, automatic gearbox and differential: equal torques on two wheels, reaction on the frame that
 * carries them.
 *
 * With throttle p, total ratio i of the gear and mean rate W of the wheels relative to the frame, the turbine of the
 * converter turns at wt = max(i W, 0), the engine at w = sqrt(ws^2 + wt^2), ws between idle and stall speed by p (there
 * is no engine inertia), and both wheels together have the torque
 *   T = i (EFFICIENCY p mu Te - (1 - p) DRAG_TORQUE wt/LIMIT_SPEED) + 2 (1 - p) CREEP_TORQUE (1 - 3 x^2 + 2 x^3),
 *   Te = min(MAX_TORQUE, MAX_POWER/w), which falls to 0 from the limit speed on within LIMITER_WIDTH,
 *   mu = 1 + (STALL_FACTOR - 1)(1 - (wt/w)/COUPLING_RATIO) >= 1, x = W/CREEP_SPEED within 0 to 1.
 * A locking differential transfers up to half of LOCKING times |T| from the faster wheel to the slower one, by
 * x/sqrt(1 + x^2) of the difference of their rates over LOCKING_RATE.
 *
 * The rates of the wheels are absolute about the axis f x g; f, g are orthonormal on the frame. The reals are followed
 * by the total ratio of each gear, the highest gear last.
 * States: gear, gear before the last shift, time since it, mean wheel rate at the start of the step, then the states of
 * selector.h. Reverse is one gear, with the torque of a first gear of its ratio, reversed.
 * A requested shift begins with the step of the request, once the last shift has ended. The clutch is a friction clutch
 * after the converter, whose torque is at most 1 - pedal times the largest one of the drive in its gear; it slips above
 * that.
 *
 * Gears change only in `accept`, between steps, and the ratio then changes over RAMP seconds, so that the torque is
 * continuous; the time of a shift starts where the wheel rate crossed the shift speed within the step, independent of
 * the length of the step. */
#include "automatic_drive_fields.h"
#include "driven_wheels.h"
#include "element.h"
#include "selector.h"

enum { STATES = 4 };
#define LIMITER_WIDTH 0.05 /* of the limit speed */
#define SETTLED 1e3 /* s */
#define LOCKING_RATE 0.5 /* rad/s */
#define ROUND_OFF 1e-6 /* of the stall speed: round-off at rest */
/* Bits of the pieces of the law: forward turbine speed, converter range, power limit, speed limiter, cut-off; from
 * IN_GEAR on the gear, 0 for none, the number of gears + 1 for reverse; slipping clutch. */
enum { TURNS = 1, CONVERTS = 2, BY_POWER = 4, LIMITED = 8, CUT_OFF = 16, IN_GEAR = 32, SLIPS = 1 << 16 };

/* Gear, 1 to `gears`, of a state. */
static int read_gear(double slot, int gears) { return slot >= gears ? gears : slot >= 1.0 ? (int)slot : 1; }

/* Requested gear, 0 for none. */
static int read_requested_gear(const ali3_element_args *a) {
  return a->nint > REQUEST && a->integer[REQUEST] >= 0
             ? (int)ali3_clamp(a->input[a->integer[REQUEST]], 0.0, a->integer[GEARS])
             : 0;
}

/* Throttle, 0 to 1. */
static double read_throttle(const ali3_element_args *a) { return ali3_clamp(a->input[a->integer[THROTTLE]], 0.0, 1.0); }

/* Total wheel torque at mean relative wheel rate W; also its slope dT/dW, engine speed, engine torque and piece. */
static double find_wheel_torque(const double *p, double ratio, double throttle, double W, double *slope, double *speed,
                                double *engine, uint32_t *piece) {
  const double turbine = ratio * W > 0.0 ? ratio * W : 0.0, closed = 1.0 - throttle;
  double stall = p[IDLE_SPEED] + throttle * (p[STALL_SPEED] - p[IDLE_SPEED]);
  if (!(stall > 1.0)) stall = 1.0;
  const double w = sqrt(stall * stall + turbine * turbine), dw = ratio * turbine / w;
  double factor = 1.0, dfactor = 0.0, max_torque = p[MAX_TORQUE], dmax_torque = 0.0;
  if (turbine < p[COUPLING_RATIO] * w) {
    factor += (p[STALL_FACTOR] - 1.0) * (1.0 - turbine / w / p[COUPLING_RATIO]);
    if (W > 0.0) dfactor = -(p[STALL_FACTOR] - 1.0) / p[COUPLING_RATIO] * ratio * (stall / w) * (stall / w) / w;
  }
  if (max_torque * w > p[MAX_POWER]) max_torque = p[MAX_POWER] / w, dmax_torque = -max_torque / w * dw;
  const double over = (w - p[LIMIT_SPEED]) / (LIMITER_WIDTH * p[LIMIT_SPEED]);
  if (over >= 1.0) {
    max_torque = dmax_torque = 0.0;
  } else if (over > 0.0) {
    dmax_torque = dmax_torque * (1.0 - over) - max_torque * dw / (LIMITER_WIDTH * p[LIMIT_SPEED]);
    max_torque *= 1.0 - over;
  }
  if (turbine > ROUND_OFF * stall) *piece |= TURNS;
  if (turbine < p[COUPLING_RATIO] * w) *piece |= CONVERTS;
  if (p[MAX_TORQUE] * w > p[MAX_POWER]) *piece |= BY_POWER;
  if (over > 0.0) *piece |= over < 1.0 ? LIMITED : CUT_OFF;
  const double x = ali3_clamp(W / p[CREEP_SPEED], 0.0, 1.0), drag = closed * p[DRAG_TORQUE] / p[LIMIT_SPEED];
  *speed = w;
  *engine = throttle * max_torque - drag * turbine;
  *slope = ratio * p[EFFICIENCY] * throttle * (dfactor * max_torque + factor * dmax_torque) -
           (W > 0.0 ? ratio * ratio * drag : 0.0) -
           2.0 * closed * p[CREEP_TORQUE] * 6.0 * x * (1.0 - x) / p[CREEP_SPEED];
  return ratio * (p[EFFICIENCY] * throttle * factor * max_torque - drag * turbine) +
         2.0 * closed * p[CREEP_TORQUE] * (1.0 - x * x * (3.0 - 2.0 * x));
}

/* Reals of the selector, which follow the ratios. */
static const double *find_selector_reals(const ali3_element_args *a) { return a->real + a->integer[GEARS]; }

/* -1, 0 or 1: reverse, neutral, drive. */
static double read_selector(const ali3_element_args *a) { return a->input[a->integer[SELECTOR]]; }

/* Fraction of the torque of a gear that its clutch transmits, 1 if it does not slip. */
static double find_clutch_fraction(ali3_element_args *a, double ratio, double wheel_torque) {
  const double *p = a->real, pedal = a->nint > CLUTCH ? ali3_clamp(a->input[a->integer[CLUTCH]], 0.0, 1.0) : 0.0;
  if (!(pedal > 0.0)) return 1.0;
  const double limit =
      (1.0 - pedal) * (ratio * p[EFFICIENCY] * p[STALL_FACTOR] * p[MAX_TORQUE] + 2.0 * p[CREEP_TORQUE]);
  if (fabs(wheel_torque) <= limit) return 1.0;
  a->piece |= SLIPS;
  return limit / fabs(wheel_torque);
}

/* Wheel torque in the direction of the selector, by the fraction that is engaged; without torque the engine runs up to
 * its limit speed. The torque of a slipping clutch does not depend on the speed. */
static double find_selected_torque(ali3_element_args *a, double ratio, double *slope, double *speed, double *engine,
                                   int *direction) {
  const double *p = a->real, *q = find_selector_reals(a), throttle = read_throttle(a), W = ali3_wheel_rate(a);
  double engaged;
  *direction =
      ali3_selector_step(a->y_old + STATES, a->y_new + STATES, read_selector(a), a->h / q[ENGAGE_TIME], &engaged);
  const double unloaded = p[IDLE_SPEED] + throttle * (p[LIMIT_SPEED] - p[IDLE_SPEED]);
  *slope = *engine = 0.0;
  *speed = unloaded;
  if (*direction == 0) return 0.0;
  const double sign = *direction, geared = sign < 0.0 ? q[REVERSE_RATIO] : ratio;
  const double wheel_torque = find_wheel_torque(p, geared, throttle, sign * W, slope, speed, engine, &a->piece);
  const double transmitted = find_clutch_fraction(a, geared, wheel_torque);
  if (transmitted < 1.0) *slope = 0.0;
  engaged *= transmitted;
  *slope *= engaged;
  *engine *= engaged;
  *speed = engaged * *speed + (1.0 - engaged) * unloaded;
  return sign * engaged * wheel_torque;
}

/* Transfers torque up to `limit` from the faster wheel to the slower one. */
static void apply_locking(ali3_element_args *a, double limit) {
  const double x = (a->ud[0] - a->ud[1]) / LOCKING_RATE, w = sqrt(1.0 + x * x), transferred = limit * x / w;
  const double b[ALI3_DRIVEN_SIGNALS] = {1.0, -1.0};
  for (int i = 0; i < 2; i++) {
    a->f[i] -= transferred * b[i];
    a->out[AUTOMATIC_DRIVE_OUT_LEFT_TORQUE + i] -= transferred * b[i];
    a->out[AUTOMATIC_DRIVE_OUT_LEFT_POWER + i] -= transferred * b[i] * (a->ud[i] - ali3_frame_rate(a));
  }
  if (a->S) ali3_add_outer(a->S, ALI3_DRIVEN_SIGNALS, a->wC * limit / (LOCKING_RATE * w * w * w), b);
}

static void evaluate(ali3_element_args *a) {
  const double *p = a->real, *ratios = p + AUTOMATIC_DRIVE_REALS;
  const int gears = a->integer[GEARS], gear = read_gear(a->y_old[0], gears), before = read_gear(a->y_old[1], gears);
  for (int i = 0; i < STATES; i++) a->y_new[i] = a->y_old[i];
  if (a->h > 0.0) a->y_new[2] = ali3_clamp(a->y_old[2] + a->h, 0.0, SETTLED);
  const double x = p[RAMP] > 0.0 ? ali3_clamp(a->y_new[2] / p[RAMP], 0.0, 1.0) : 1.0;
  const double ratio = ratios[before - 1] + (ratios[gear - 1] - ratios[before - 1]) * x * x * (3.0 - 2.0 * x);
  double slope, speed, engine;
  int direction = 1;
  const double wheel_torque = a->nint > SELECTOR ? find_selected_torque(a, ratio, &slope, &speed, &engine, &direction)
                                                 : find_wheel_torque(p, ratio, read_throttle(a), ali3_wheel_rate(a),
                                                                     &slope, &speed, &engine, &a->piece);
  a->piece |= (uint32_t)(IN_GEAR * (direction > 0 ? gear : direction < 0 ? gears + 1 : 0));
  ali3_drive_wheels(a, wheel_torque, slope);
  a->potential = 0.0;
  a->out[AUTOMATIC_DRIVE_OUT_ENGINE_SPEED] = speed;
  a->out[AUTOMATIC_DRIVE_OUT_GEAR] = direction > 0 ? gear : direction;
  a->out[AUTOMATIC_DRIVE_OUT_WHEEL_TORQUE] = 0.5 * wheel_torque;
  a->out[AUTOMATIC_DRIVE_OUT_ENGINE_TORQUE] = engine;
  for (int i = 0; i < 2; i++) {
    a->out[AUTOMATIC_DRIVE_OUT_LEFT_POWER + i] = 0.5 * wheel_torque * (a->ud[i] - ali3_frame_rate(a));
    a->out[AUTOMATIC_DRIVE_OUT_LEFT_TORQUE + i] = 0.5 * wheel_torque;
  }
  if (p[LOCKING] > 0.0) apply_locking(a, 0.5 * p[LOCKING] * fabs(wheel_torque));
}

/* Wheel rates, rad/s, at which the drive shifts up and down from a gear. */
static void find_shift_rates(const double *p, int gear, double throttle, double *up, double *down) {
  *up = (p[UP_CLOSED] + throttle * (p[UP_OPEN] - p[UP_CLOSED])) / p[AUTOMATIC_DRIVE_REALS + gear - 1];
  *down = (p[DOWN_CLOSED] + throttle * (p[DOWN_OPEN] - p[DOWN_CLOSED])) / p[AUTOMATIC_DRIVE_REALS + gear - 1];
}

/* Selects the gear for the speed without a shift; the search begins at `gear`. */
static void choose_gear(ali3_element_args *a, int gear, double rate) {
  const double *p = a->real, throttle = read_throttle(a);
  double up, down;
  for (find_shift_rates(p, gear, throttle, &up, &down); rate > up && gear < a->integer[GEARS];)
    find_shift_rates(p, ++gear, throttle, &up, &down);
  a->y_new[0] = a->y_new[1] = gear;
  a->y_new[2] = SETTLED;
}

static void accept(ali3_element_args *a) {
  const double *p = a->real, throttle = read_throttle(a), now = ali3_wheel_rate(a), before = a->y_new[3];
  const int gears = a->integer[GEARS], start = !(a->h > 0.0);
  int gear = read_gear(a->y_new[0], gears), engaged = 0;
  double up, down, limit;
  a->y_new[3] = now;
  if (a->nint > SELECTOR) {
    engaged =
        ali3_selector_accept(a->y_new + STATES, read_selector(a), now, find_selector_reals(a)[ENGAGE_SPEED], start);
    if (engaged && !start) gear = 1;
  }
  const int requested = read_requested_gear(a);
  if (start || engaged) {
    choose_gear(a, gear, now);
    if (requested > 0) a->y_new[0] = a->y_new[1] = requested;
    return;
  }
  if (requested > 0) {
    if (requested == gear || a->y_new[2] < p[RAMP]) return;
    a->y_new[1] = gear;
    a->y_new[0] = requested;
    a->y_new[2] = a->h;
    return;
  }
  if (a->y_new[2] < p[DWELL]) return;
  find_shift_rates(p, gear, throttle, &up, &down);
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

static const char *check(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint) {
  (void)nsig, (void)nreal, (void)nint;
  for (int i = 0; i < integer[GEARS]; i++)
    if (real[AUTOMATIC_DRIVE_REALS + i] < 0.0) return "the ratios of an automatic drive must not be negative";
  if (!(real[IDLE_SPEED] > 0.0 && real[STALL_SPEED] >= real[IDLE_SPEED] && real[LIMIT_SPEED] > real[STALL_SPEED]))
    return "the engine speeds of an automatic drive must be positive and in the order idle, stall, limit";
  if (real[DWELL] < real[RAMP]) return "the dwell time of an automatic drive must not be shorter than its ramp";
  return 0;
}

const ali3_element_type ali3_automatic_drive = {
    ALI3_AUTOMATIC_DRIVE,
    .evaluate = evaluate,
    .accept = accept,
    .check = check,
};
