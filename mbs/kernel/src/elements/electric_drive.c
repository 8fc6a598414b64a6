/* Electric motor with a fixed ratio and an open differential: equal torques on two wheels, reaction on the frame that
 * carries the motor.
 * f and g are orthonormal on the frame, the rates of both wheels absolute about the axis f x g. Integers: throttle
 * input (0..1), and a selector input (-1, 0, 1) or none. States: none, with a selector as in selector.h.
 *
 * With throttle p and the speed w of the motor, both positive in the direction engaged, the motor has the torque
 *   T = p min(MAX_TORQUE, MAX_POWER/|w|) - (1 - p) min(REGENERATION_TORQUE, REGENERATION_POWER/|w|) x (3 - x^2)/2,
 * x = w/REGENERATION_SPEED within -1 to 1; the first part falls to 0 from the limit speed on within LIMITER_WIDTH. Both
 * wheels together have RATIO times T, times GEAR_EFFICIENCY where the motor drives and divided by it where it brakes.
 * The battery gives T w/EFFICIENCY or takes T w EFFICIENCY. The inertia of the rotor is part of the spins, not of this
 * element. */
#include "driven_wheels.h"
#include "electric_drive_fields.h"
#include "element.h"
#include "selector.h"

#define LIMITER_WIDTH 0.05 /* width of the limiter, relative to the limit speed */
#define GEAR_FADE 5.0 /* rad/s of the motor, below which the loss of the gears, a friction, fades */
#define BARELY 1e-3 /* fraction of GEAR_FADE below which the loss of the gears is negligible */

/* Bits of the active smooth pieces of the law. */
enum { BY_POWER = 1, LIMITED = 2, CUT_OFF = 4, TAKES_BY_POWER = 8, DRIVES = 16, DIRECTIONS = 32 };

typedef struct {
  double value, slope; /* N m; derivative by the speed of the motor, N m s/rad */
  uint32_t piece; /* active smooth pieces */
} torque;

/* min(largest, power / |speed|); N m, W, rad/s */
static torque limit_by_power(double largest, double power, double speed) {
  const double w = fabs(speed);
  if (!(largest * w > power)) return (torque){largest, 0.0, 0u};
  return (torque){power / w, -power / w / speed, BY_POWER};
}

/* Largest torque of the motor, which falls to 0 within the width of the limiter. */
static torque find_full_torque(const double *p, double speed, int reverse) {
  const double limit = reverse ? p[REVERSE_SPEED] : p[LIMIT_SPEED], width = LIMITER_WIDTH * limit;
  const double over = (speed - limit) / width;
  if (over >= 1.0) return (torque){0.0, 0.0, CUT_OFF};
  const torque full = limit_by_power(p[MAX_TORQUE] * (reverse ? p[REVERSE_TORQUE] : 1.0), p[MAX_POWER], speed);
  if (!(over > 0.0)) return full;
  return (torque){full.value * (1.0 - over), full.slope * (1.0 - over) - full.value / width, full.piece | LIMITED};
}

/* Torque of the motor against its speed, both positive in the direction engaged. */
static torque find_motor_torque(const double *p, double throttle, double speed, int reverse) {
  const torque full = find_full_torque(p, speed, reverse);
  const torque regeneration = limit_by_power(p[REGENERATION_TORQUE], p[REGENERATION_POWER], speed);
  const double x = ali3_clamp(speed / p[REGENERATION_SPEED], -1.0, 1.0), fade = 0.5 * x * (3.0 - x * x);
  const double fade_slope = 1.5 * (1.0 - x * x) / p[REGENERATION_SPEED], closed = 1.0 - throttle;
  return (torque){throttle * full.value - closed * regeneration.value * fade,
                  throttle * full.slope - closed * (regeneration.slope * fade + regeneration.value * fade_slope),
                  full.piece | (regeneration.piece ? TAKES_BY_POWER : 0u)};
}

/* Torque at the output of the gears, divided by their ratio: they lose power in both directions of the power. */
static torque apply_gear_losses(double efficiency, torque m, double speed) {
  const int drives = m.value > 0.0 ? speed >= 0.0 : speed <= 0.0;
  const double x = ali3_clamp(fabs(speed) / GEAR_FADE, 0.0, 1.0), sign = speed < 0.0 ? -1.0 : 1.0;
  const double change = drives ? efficiency - 1.0 : 1.0 / efficiency - 1.0;
  const double factor = 1.0 + change * x * x * (3.0 - 2.0 * x);
  return (torque){m.value * factor, m.slope * factor + m.value * change * sign * 6.0 * x * (1.0 - x) / GEAR_FADE,
                  m.piece | (drives || x < BARELY ? DRIVES : 0u)};
}

/* -1, 0 or 1: reverse, neutral, drive. */
static double read_selector(const ali3_element_args *a) { return a->input[a->integer[SELECTOR]]; }

static void evaluate(ali3_element_args *a) {
  const double *p = a->real;
  double engaged = 1.0;
  const int direction = a->nint > SELECTOR
                            ? ali3_selector_step(a->y_old, a->y_new, read_selector(a), a->h / p[ENGAGE_TIME], &engaged)
                            : 1;
  const double speed = p[RATIO] * ali3_wheel_rate(a), throttle = ali3_clamp(a->input[a->integer[THROTTLE]], 0.0, 1.0);
  torque m = {0.0, 0.0, 0u};
  if (direction != 0) {
    m = find_motor_torque(p, throttle, direction * speed, direction < 0);
    m = (torque){direction * engaged * m.value, engaged * m.slope, m.piece};
  }
  const torque wheels = apply_gear_losses(p[GEAR_EFFICIENCY], m, speed);
  const double total = p[RATIO] * wheels.value, slope = p[RATIO] * p[RATIO] * wheels.slope;
  const double power = m.value * speed;
  a->piece = wheels.piece + (uint32_t)(DIRECTIONS * (direction + 1));
  ali3_drive_wheels(a, total, slope);
  a->potential = 0.0;
  a->out[ELECTRIC_DRIVE_OUT_MOTOR_SPEED] = speed;
  a->out[ELECTRIC_DRIVE_OUT_MOTOR_TORQUE] = m.value;
  a->out[ELECTRIC_DRIVE_OUT_WHEEL_TORQUE] = 0.5 * total;
  a->out[ELECTRIC_DRIVE_OUT_ELECTRIC_POWER] = power > 0.0 ? power / p[EFFICIENCY] : power * p[EFFICIENCY];
  a->out[ELECTRIC_DRIVE_OUT_GEAR] = direction;
  for (int i = 0; i < 2; i++) a->out[ELECTRIC_DRIVE_OUT_LEFT_POWER + i] = 0.5 * total * (a->ud[i] - ali3_frame_rate(a));
}

static void accept(ali3_element_args *a) {
  if (a->nint > SELECTOR)
    ali3_selector_accept(a->y_new, read_selector(a), ali3_wheel_rate(a), a->real[ENGAGE_SPEED], !(a->h > 0.0));
}

const ali3_element_type ali3_electric_drive = {
    ALI3_ELECTRIC_DRIVE,
    .evaluate = evaluate,
    .accept = accept,
};
