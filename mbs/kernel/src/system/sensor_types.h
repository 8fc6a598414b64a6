/* The types of sensors of a System file, in one list. From it come the enumeration below, the loader's checks
 * (check_sensors.c), the functions that sensors.c and sensor_derivative.c must have, `SensorType` in Python and the
 * table of docs/system_file.md; the last two are written by `python mbs/kernel/read_headers.py`. */
#ifndef ALI3_SENSOR_TYPES_H
#define ALI3_SENSOR_TYPES_H
#include <stdint.h>

/* X(number, NAME, name, integers, reals, reals of each item, rate, reads, integers and reals in words, value in words)
 *
 * Each integer is one letter: s signal, S signal or -1, e element, o output of the element before, u input, g driving
 * function, G driving function or -1, T driving function by a table or -1, r row, d order 0 to 2, b 0 or 1, k energy 0
 * to 3, q component of a quaternion 0 to 3, h ALI3_SOLVER_*; n number of items, N at least one, P two or three: as
 * many times come the integers in brackets. `rate`: whether ali3_sensor_rates knows the first time derivative,
 * ALI3_RATE_*; `reads`: ALI3_READS_*. */
/* clang-format off */
#define ALI3_SENSOR_TYPES(X) \
  X(0, SIGNAL, signal, "s", 1, 0, ALWAYS, MOTION, \
    "signal", "scale", "scale * u of a signal") \
  X(1, SIGNAL_RATE, signal_rate, "s", 1, 0, ALWAYS, MOTION, \
    "signal", "scale", "scale * ud of a signal") \
  X(2, SIGNAL_SECOND_RATE, signal_second_rate, "s", 1, 0, NEVER, FORCES, \
    "signal", "scale", "scale * udd of a signal") \
  X(3, COMPONENT, component, "dssssss", 0, 0, BY_FIRST, MOTION, \
    "order (0, 1, 2), 3 signals p, 3 signals axis", "-", \
    "axis . (p, p', p''): a component in moving axes (axis not differentiated)") \
  X(4, ANGLE, angle, "ss", 0, 0, ALWAYS, MOTION, \
    "signal y, signal x", "-", "atan2(y, x)") \
  X(5, PITCH, pitch, "s", 0, 0, ALWAYS, MOTION, \
    "signal", "-", "-asin(u) clamped (pitch from the third component of the forward axis)") \
  X(6, ANGULAR_RATE, angular_rate, "ssssss", 1, 0, ALWAYS, MOTION, \
    "3 signals a, 3 signals b", "scale", \
    "scale * (ad . b - bd . a)/2: angular rate about a x b for orthonormal a, b") \
  X(7, QUATERNION, quaternion, "qsssssssss", 0, 0, ALWAYS, MOTION, \
    "component 0 to 3 (w, x, y, z), 9 signals a, b, c", "-", \
    "quaternion of the frame a, b, c, scalar first, w >= 0") \
  X(8, ELEMENT_OUTPUT, element_output, "eo", 1, 0, NEVER, FORCES, \
    "element, output", "scale", "scale * output of the element") \
  X(9, REACTION, reaction, "n(r)", 0, 1, NEVER, ROWS, \
    "n, then n row numbers", "n weights", "sum weight * lam_user") \
  X(10, ENERGY, energy, "k", 0, 0, BY_FIRST, FORCES, \
    "kind: 0 kinetic, 1 gravity potential, 2 elastic potential, 3 total", "-", "energies, J") \
  X(11, INPUT, input, "u", 0, 0, NEVER, INPUTS, \
    "input", "-", "input as used") \
  X(12, DRIVING, driving, "gd", 1, 0, BY_SECOND, INPUTS, \
    "driving function, order (0, 1, 2)", "scale", "scale * driving function value or rate") \
  X(13, SOLVER, solver, "h", 0, 0, NEVER, SOLVER, \
    "kind: 0 iterations of the last step, 1 max violation m, 2 residual, 3 factorizations since start, 4 halvings since " \
    "start, 5 status of the last step, once a closed loop has changed its assembly mode that of `ALI3_BRANCH_CHANGED` " \
    "where it is good, 6 error of the energy J, 7 the same relative to the motion", "-", "solver health") \
  X(14, NORM, norm, "bP(s)", 0, 0, BY_FIRST, MOTION, \
    "order (0, 1), n (2 or 3), n signals", "-", "norm of (p, p')") \
  X(15, DIRECTION, direction, "dsssssssss", 0, 0, BY_FIRST, MOTION, \
    "order (0, 1, 2), 3 signals p, 3 axis 1, 3 axis 2", "-", \
    "atan2(axis2 . p', axis1 . p'): direction of a velocity in moving axes (order 1), zero below 0.1 m/s") \
  X(16, ANGLE_ABOUT, angle_about, "sssssssss", 0, 0, ALWAYS, MOTION, \
    "3 signals a, 3 signals b, 3 signals c", "-", "angle from b to a about c: atan2((b x a) . c, a . b)") \
  X(17, QUASI_STATIC, quasi_static, "nssssssssssss(rrr)", 15, 3, NEVER, ROWS, \
    "n, 3 signals r, 9 signals a, b, c, 3 n row numbers", "3 gravity g, 3 n weights f, 3 weights s, 9 weights W", \
    "quasi-static output of a structure, A = [a b c]: sum f . A' lam_user + s . A'(r'' - g) + W : A' A''") \
  X(18, REACTION_PRODUCTS, reaction_products, "n(rSSSG)", 0, 1, NEVER, ROWS, \
    "n, then n times: row, 3 signals, driving function (-1: none)", "n weights", \
    "sum weight * lam_user * u * u * u * s: forces along turning lines, of driven distances, moments of joints") \
  X(19, WORK, work, "dN(e)", 0, 0, NEVER, FORCES, \
    "kind: 0 work, 1 nonconservative (with the change of the potentials), 2 of jumps of inputs on these, n, then n elements", "-", \
    "sum of the work of elements since the start, J") \
  X(20, MASS, mass, "", 1, 0, ALWAYS, MOTION, \
    "-", "mass without payloads, kg", "total mass, kg") \
  X(21, DRIVING_EXCESS, driving_excess, "g", 1, 0, NEVER, INPUTS, \
    "driving function", "scale", \
    "scale * (demand of the inputs of a filtered driving function minus what its limits leave of it)") \
  X(22, REACTION_BY_TABLE, reaction_by_table, "n(rSSSGT)", 0, 1, NEVER, ROWS, \
    "n, then n times: row, 3 signals, driving function, driving function by a table (-1: none)", "n weights", \
    "sum weight * lam_user * u * u * u * s * ds/du: the force of a driving function that others follow by a table") \
  X(23, DRIVING_WORK, driving_work, "n(e)", 0, 0, NEVER, FORCES, \
    "n, then n elements", "-", \
    "work of all driving functions and nonconservative work of elements since the start, J") \
  X(24, SCALED_INPUT, scaled_input, "u", 1, 0, NEVER, INPUTS, \
    "input", "scale", "scale * input as used") \
  X(25, CARRIED, carried, "dssssssssssssssssss", 0, 0, BY_FIRST, MOTION, \
    "order (0, 1, 2), 3 signals r, 9 signals a, b, c, 3 signals x, y, z, 3 signals axis", "-", \
    "axis . (p, p', p'') with p = r + a x + b y + c z: a place in moving axes that moves in them (axis not " \
    "differentiated)")
/* clang-format on */

enum {
#define ALI3_SENSOR_TYPE(number, NAME, ...) ALI3_SENSOR_##NAME = number,
  ALI3_SENSOR_TYPES(ALI3_SENSOR_TYPE)
#undef ALI3_SENSOR_TYPE
      ALI3_SENSOR_TYPE_COUNT
};

/* ALI3_RATE_*: whether the rate of a sensor depends only on positions, velocities and accelerations: never, always, or
 * if its first or second integer, an order or a kind, is below 2. */
enum { ALI3_RATE_NEVER = 0, ALI3_RATE_ALWAYS, ALI3_RATE_BY_FIRST, ALI3_RATE_BY_SECOND };

/* ALI3_READS_*: quantities that the value depends on: positions and velocities; inputs; forces or accelerations; counts
 * of the solver; multipliers, which include forces. */
enum { ALI3_READS_MOTION = 0, ALI3_READS_INPUTS, ALI3_READS_FORCES, ALI3_READS_SOLVER, ALI3_READS_ROWS };

typedef struct {
  const char *integers; /* letters of the list above */
  int32_t reals, reals_each; /* number of reals, and of further ones per item */
  int32_t rate, reads; /* ALI3_RATE_*, ALI3_READS_* */
} ali3_sensor_type;

extern const ali3_sensor_type ali3_sensor_types[ALI3_SENSOR_TYPE_COUNT];
#endif
