/* The slave behind the interfaces of both FMI versions: life cycle, values, steps, states and derivatives of one
 * instance. It knows the System file and the table of variables, but neither the FMI version nor the model. */
#ifndef ALI3_SLAVE_H
#define ALI3_SLAVE_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ali3.h"

/* The table of variables, generated with the FMU (table.c); the index of a variable in it is its value reference. */
typedef enum {
  SLAVE_INPUT,
  SLAVE_PARAMETER,
  SLAVE_POSE,
  SLAVE_STEP_SIZE,
  SLAVE_FIDELITY,
  SLAVE_STEP_ITERATIONS,
  SLAVE_SETTLING,
  SLAVE_LEAD, /* time ahead of SLAVE_AHEAD, in communication steps */
  SLAVE_SENSOR,
  SLAVE_SOLVER,          /* a diagnostic of the solver: ali3_solver_value */
  SLAVE_CAPPED_RESIDUAL, /* of the last communication step */
  SLAVE_AHEAD, /* an output extrapolated by its rate over the time ahead */
  SLAVE_CONSTANT /* always its start value */
} slave_source;

/* Roles of inputs at ports: x of the normal of a road, of the point of an answer on the road, of the force on a hub;
 * the other components follow. */
enum { SLAVE_NO_ROLE, SLAVE_NORMAL, SLAVE_ANSWER, SLAVE_HUB };

typedef struct {
  const char *name, *unit; /* the unit as printed after a number */
  slave_source source;
  int32_t index; /* of the input, parameter, sensor, extrapolated variable or ALI3_SOLVER_*; in x, y, z, yaw, speed */
  double start, min, max; /* infinite where open */
  bool whole; /* an integer of FMI */
  bool fixed; /* a parameter that can be set before the first step only */
  bool port; /* an input that another program sets at every step */
  int32_t road; /* road whose built-in form the parameter describes, without effect on a road file; -1: none */
  uint64_t uncomputed; /* bits of the fidelities whose System omits it */
  double least, most; /* range of validity of a parameter; infinite if it is not known */
  int32_t role; /* of an input, SLAVE_NO_ROLE ... */
  int32_t other; /* variable: x of the wheel of an answer, x of the velocity of a hub, rate of SLAVE_AHEAD; -1: none */
  double scale; /* of inputs and sensors: value of the variable divided by the value in the System */
  double figure[4]; /* of a hub, see mbs.model.records.Role */
  ali3_judged judged; /* how two motions are compared by it; unit -1: not */
} slave_variable;

typedef struct {
  const char *name;
  int32_t road; /* number of the road whose file it names */
  const char *start;
} slave_text;

typedef struct {
  const char *token; /* GUID or instantiation token */
  unsigned char identity[16]; /* the same as bytes */
  const slave_variable *variable;
  size_t n_variables, n_known; /* known: inputs and parameters; outputs follow, then constants */
  const char *const *row; /* names of the constraint rows of all Systems */
  const size_t *first_row; /* n_systems + 1 */
  const char *const *element; /* names of the force elements of all Systems */
  const size_t *first_element; /* n_systems + 1 */
  const char *const *coordinate; /* of all Systems: names of coordinates that are arguments of tables; otherwise "" */
  const size_t *first_coordinate; /* n_systems + 1 */
  const char *const *notice; /* warnings at the start of all Systems */
  const size_t *first_notice; /* n_systems + 1 */
  size_t n_systems; /* one for each value of the parameter fidelity */
  const int32_t *follower; /* n_systems: System with ports that computes the outputs that each omits; -1: none */
  const ali3_generated *const *generated; /* n_systems: code for the algebra of each; NULL: none */
  const slave_text *text; /* text variables, with numbers of their own */
  size_t n_texts;
  size_t roll; /* roll angle of the vehicle, an output; n_variables: none */
  size_t ground; /* contact force of the body on the ground, an output; n_variables: none */
  double length; /* characteristic length of the model, m */
} slave_table;

extern const slave_table slave_the_table;

/* Numbers as in both versions of FMI. */
typedef enum { SLAVE_OK, SLAVE_WARNING, SLAVE_DISCARD, SLAVE_ERROR, SLAVE_FATAL } slave_status;

typedef enum { /* bits, for masks of allowed calls */
               SLAVE_INSTANTIATED = 1,
               SLAVE_INITIALISING = 2,
               SLAVE_STEPPING = 4,
               SLAVE_STEP_FAILED = 8, /* the state before the failed step is restored; the host may continue from it */
               SLAVE_TERMINATED = 16
} slave_phase;

enum { SLAVE_MAX_ORDERS = 3, SLAVE_TEXT = 1024, SLAVE_PATH = 4096, SLAVE_MAX_TEXT = 1024 };
enum { SLAVE_TERMS = SLAVE_MAX_ORDERS + 1 }; /* Taylor terms of an input, order 0 included, see slopes.c */
typedef char slave_text_value[SLAVE_MAX_TEXT]; /* padded with zeros */

typedef struct slave slave;
typedef void slave_logger(slave *s, slave_status status, const char *category, const char *text);

enum {
  SLAVE_WAS_SET = 1,
  SLAVE_HELD_AT_END = 2,
  SLAVE_HELD_LAST = 4,
  SLAVE_HELD_FLAT = 8,
  SLAVE_HELD_NORMAL = 16,
  SLAVE_FAR = 32, /* of a hub: steps too long for its tyre */
  SLAVE_JUMPED = 64, /* of a hub: constant forces */
  SLAVE_TURNED = 128 /* of y of an answer: curvature of the road */
}; /* bits of an input: set by the host, and warnings that were logged */
enum { SLAVE_NOT_CAPPED, SLAVE_CAPPED, SLAVE_CAPPED_BADLY }; /* logged warnings on limited iterations */
enum { SLAVE_SHORTER_STEPS = 1, SLAVE_LONGER_STEPS }; /* logged warnings on inner steps other than step_size */

typedef struct { /* numbers of a state besides the kernel's bytes */
  slave_phase phase;
  int32_t initialised, step_warned, energy_warned, mode_warned, capped_warned; /* warnings of a run that were logged */
  double start_time, stop_time; /* s; infinite where not given */
  double capped_residual; /* m, largest of the last communication step */
} slave_call_state;

typedef struct { /* the last refused step, while the host has changed nothing since */
  int32_t count; /* of refusals of this step; 0: none, or the host has changed a value */
  double time, step; /* s */
} slave_refusal;

typedef struct { /* the last completed communication step; the fidelity has the snapshot of its start */
  int64_t n; /* inner steps; 0: there is none */
  double h; /* s, of an inner step */
  bool sloped; /* inputs varied along their derivatives */
} slave_completed;

typedef struct { /* inputs that the host set in intermediate updates of the last communication step */
  int64_t n, capacity; /* inner steps that have rows, 0: no input was set; allocated rows */
  double *row, *next; /* (n + 1) x nu: inputs at the start and at the ends of inner steps; the row of the next end */
  double *value; /* n_known: the values set last */
  unsigned char *was_set; /* n_known: whether they were set */
} slave_intermediate;

typedef struct { /* a communication step that the second motion has not computed yet, see half_steps.c */
  int64_t n; /* inner steps */
  double h, end; /* s: length of an inner step; time at the end of the communication step */
  int64_t parts; /* of an inner step in the second motion */
  double ratio; /* mean step of the first motion, halved or not, divided by the step of the second */
  double span; /* s, for which the second motion runs from its start, as a force changed abruptly; 0: it did not */
  double simulated; /* s, as in slave_second_motion */
  double energy_error; /* J, of the first motion at its end */
  int64_t branch_changes; /* likewise */
  double *values; /* inputs at its start, then compared outputs at its end */
  double *parameter;
  bool sloped, starts; /* inputs have slopes; the second motion may start here from `start` */
} slave_pending_step;

typedef struct { /* numbers of the second motion, which states have beside its snapshot; 8 bytes each */
  double remaining, spent, simulated; /* s: still to run by the second motion, 0: it rests; run by it; by the first */
  double scheduled; /* s: time up to which the second motion runs at least */
  double difference, time; /* largest unreported relative difference; its time, s */
  double h, ratio; /* inner step, s, and ratio of the pending step with `difference` */
  int64_t parts; /* of that step in the second motion */
  double early_difference, late_difference; /* largest in the second quarter of a start, and after it; relative */
  double checked, predicted; /* s: end of the comparison of a start; time at which the growing error is large */
  double shared; /* s: since when both motions have a wrong energy; HUGE_VAL: they do not */
  int64_t worst; /* compared output that has late_difference */
} slave_second_motion;

typedef struct { /* the second motion, with at most half the step, see half_steps.c */
  slave_second_motion *saved; /* NULL: nothing is compared; `compared` and `second` follow it */
  void *second, *end, *start; /* snapshots: the second motion, the first one after the step, the next start */
  double *input; /* work: nu */
  /* n compared outputs: how they are compared, differences so far, sensor, variable; work: values, reference sizes */
  int32_t n, *sensor;
  ali3_judged *judged;
  ali3_compared *compared;
  size_t *variable;
  double *output, *size;
  slave_pending_step *pending; /* ring of n_pending pending steps; the oldest is `first` */
  size_t first, n_pending;
  int64_t n_made; /* inner steps of the second motion in the first pending step */
  int64_t iterations, cost; /* of the first motion so far; of the last inner step of the second motion */
  int64_t abrupt, halvings; /* of the first motion so far: abrupt steps, halvings */
  bool start_needed; /* a pending step may use `start` */
} slave_half_steps;

typedef struct { /* times at which an input at a port was set */
  double last_set, longest; /* s: the last time; longest interval between two of them */
  double changed, span,
      held; /* s: last change of the value; interval before it; the shorter one of the last two intervals */
  double seen, path; /* of a hub: time of the last check, s; path of its wheel under constant forces, m */
  double times; /* number of times, up to a limit; negative: a warning was logged that it is no longer set */
} slave_port_times;

typedef struct { /* a loaded System of the FMU and its instance */
  size_t number;
  ali3_system *system;
  ali3_instance *kernel;
  void *snapshot; /* of the kernel before the step, to undo it */
  void *start; /* of the kernel before the last completed communication step */
} slave_fidelity;

/* Computed outputs of the present state: none, those that were read, all but the omitted ones. */
typedef enum { SLAVE_STALE, SLAVE_SOME, SLAVE_FRESH } slave_freshness;

struct slave {
  void *host; /* the instance of the FMI interface */
  slave_logger *logger;
  ali3_memory memory;
  char *name, *resources;
  bool logging, all_categories;
  unsigned categories; /* bits, see category_of in log.c */
  slave_fidelity fidelity, follower; /* the second is loaded when an omitted output is first read */
  slave_call_state calls;
  slave_refusal refusal;
  slave_completed completed;
  slave_half_steps half_steps;
  slave_intermediate intermediate;
  void (*request_inputs)(slave *s, double time); /* intermediate update of the host at a time, s; NULL: none */
  bool early_return, returned_early; /* the host allows early return; the last step did so */
  slave_status last_step; /* status of the last step */
  double *value; /* per variable; outputs are computed when they are read */
  double *slope; /* per variable and order: derivatives of the inputs after the communication point */
  double *completed_slope; /* the same of the last completed communication step */
  slave_port_times *port_times; /* per known variable, of ports */
  unsigned char *pending; /* per known variable: set and not yet passed to the kernel */
  unsigned char *input_flags; /* per known variable: SLAVE_WAS_SET and logged warnings */
  slave_text_value *text; /* per text variable: file of the road that the kernel has */
  slave_freshness outputs;
  bool follower_current; /* the follower has the present state */
  bool uncomputed_warned; /* warning of a run logged: an output that is not computed was read */
  /* warnings of a run logged: rollover, a rim on the road, steps too long for a contact or a stop */
  bool overturned_warned, rim_warned, error_warned, unchecked_logged; /* and the end of the second motion */
  double *sensors, *direction; /* work: n_variables, nu */
  int32_t *sensor; /* work: n_variables, sensors to evaluate */
  uint32_t *output; /* work: n_variables, their variables */
  unsigned char *fresh; /* per variable: an output of the present state, with SLAVE_SOME */
  unsigned char *known; /* work: ns */
  size_t step_reference, iterations_reference, lead_reference;
  size_t fidelity_reference; /* n_variables: there is one System only */
  int64_t work_left; /* of the present call, see work.c */
};

/* Sets the floating-point control of the kernel when a call begins and the one of the host, the first
 * member of `instance`, when it ends; likewise around a callback. */
ali3_float_control slave_call_begins(void *instance); /* returns that of the host; 0: it is the same */
void slave_call_ends(void *instance, ali3_float_control host);
ali3_float_control slave_call_leaves(void *instance); /* before a callback of the host */
void slave_call_returns(void *instance, ali3_float_control host);

/* Defines a function of the interface, whose body follows; it is not inlined, to keep arithmetic inside the control. */
#define SLAVE_ENTRY(function, type, name, instance, parameters, arguments)                                             \
  static __attribute__((noinline)) type name##_inside parameters;                                                      \
  function parameters {                                                                                                \
    if (ali3_float_control_is_usual()) return name##_inside arguments;                                                 \
    const ali3_float_control host = slave_call_begins(instance);                                                       \
    const type status = name##_inside arguments;                                                                       \
    slave_call_ends(instance, host);                                                                                   \
    return status;                                                                                                     \
  }                                                                                                                    \
  static type name##_inside parameters

/* Statuses: SLAVE_OK; SLAVE_WARNING, the call has its effect; SLAVE_DISCARD, a step was refused and may be repeated in
 * another way; SLAVE_ERROR, nothing changed. Each but SLAVE_OK comes with a message in the log. */

/* Logs a formatted message if the host wants its category; returns the status. */
slave_status slave_log(slave *s, slave_status status, const char *format, ...);
/* Logs that an output is not computed, in a category of its own, which hosts that read all outputs may ignore. */
void slave_log_uncomputed(slave *s, const slave_variable *v);
/* Switches logging, of n categories or, with n = 0, of all. */
slave_status slave_set_logging(slave *s, bool on, size_t n, const char *const *categories);
/* Words for a phase in messages, such as "after termination". */
const char *slave_phase_name(slave_phase phase);
/* Whether the phase is in the mask; if not, an error is logged. Resets the limit of work, as a call begins. */
bool slave_is_allowed(slave *s, const char *function, unsigned mask);

/* Converts a file URI to a path in UTF-8; a plain path is copied. False: it is too long. */
bool slave_path_of_uri(const char *uri, char *path, size_t size);
/* Reads a file of a folder into allocated memory of *size bytes; NULL on failure, with a short reason in *why. */
unsigned char *slave_read_resource(const char *folder, const char *name, const ali3_memory *memory, size_t *size,
                                   const char **why);

/* Loads the System of a fidelity. False: an error was logged and `loaded` is empty. */
bool slave_fidelity_load(slave *s, size_t number, slave_fidelity *loaded);
/* Frees the present System and takes another one. */
void slave_fidelity_replace(slave *s, const slave_fidelity *loaded);
/* Frees a loaded System. */
void slave_fidelity_free(const slave *s, slave_fidelity *loaded);
/* Loads the System that the parameter fidelity selects, if another one is loaded. False: an error was logged. */
bool slave_fidelity_choose(slave *s);

/* Appends an output that is a sensor to the *n sensors to evaluate, if it is out of date. */
void slave_request_sensor(slave *s, size_t *n, uint32_t reference);
/* Evaluates these n sensors; false: it failed, and they stay out of date. */
bool slave_read_sensors(slave *s, ali3_instance *kernel, size_t n);

/* Whether the loaded System does not compute the output. */
bool slave_is_omitted(const slave *s, const slave_variable *v);
/* Whether another System can compute the outputs that the loaded one omits. */
bool slave_has_follower(const slave *s);
/* Computes the omitted ones of n outputs, NULL: of all, at the present state; the others are computed already. False:
 * an error was logged. Without a follower they keep the values of the loaded System. */
bool slave_omitted_outputs(slave *s, const uint32_t *reference, size_t n);

/* Text variables: n value references and texts; `first`: value reference of the first text variable */
slave_status slave_get_text(slave *s, uint32_t first, const uint32_t *reference, size_t n, const char **value);
/* Sets text variables; on an error none changes. */
slave_status slave_set_text(slave *s, uint32_t first, const uint32_t *reference, size_t n, const char *const *value);
/* Loads the roads of all text variables into a kernel. False: an error was logged. */
bool slave_texts_apply(slave *s, ali3_instance *kernel, const slave_text_value *value);
/* Sets all text variables to their start values. False: an error was logged. */
bool slave_texts_reset(slave *s);
/* Warnings after the start: on a road from a file, of a start that has not settled, of parameters without effect. */
void slave_texts_warn(slave *s);
/* Whether a parameter describes a built-in road that a file replaces. */
bool slave_has_no_effect(const slave *s, const slave_variable *v);

/* Makes an instance; NULL: an error was logged. host: argument of the logger; resources: folder. */
slave *slave_new(const ali3_memory *memory, void *host, slave_logger *logger, bool logging, const char *name,
                 const char *token, const char *resources);
/* NULL is allowed. */
void slave_free(slave *s);
/* Whether the tolerance of an experiment is a number; if not, an error is logged. No step depends on it. */
bool slave_check_tolerance(slave *s, bool defined, double tolerance);
/* Sets start and stop time, s. */
slave_status slave_setup(slave *s, double start_time, bool stop_defined, double stop_time);
/* Enters the initialisation mode. */
slave_status slave_enter(slave *s);
/* Computes the initial state, if values have changed since, and leaves the mode. */
slave_status slave_exit(slave *s);
/* Ends the run; outputs can still be read. */
slave_status slave_terminate(slave *s);
/* Sets all variables to their start values, as in a new instance. */
slave_status slave_reset(slave *s);

/* Marks the initial state and the outputs as out of date. */
static inline void slave_invalidate(slave *s) {
  s->calls.initialised = 0;
  s->outputs = SLAVE_STALE;
}

/* The limit of work in a call, from which the kernel subtracts its own. */
#define SLAVE_MAX_WORK 2000000 /* a million steps of one iteration each: half a minute of a rigid car */
void slave_reset_work(slave *s);
double slave_steps_left(const slave *s); /* inner steps of one iteration each */
const slave_variable *slave_settling(const slave *s); /* settling time of the start; NULL: it is zero */
double slave_settling_steps(const slave *s); /* inner steps that settle a start */
double slave_settling_left(const slave *s, double starts); /* inner steps for each of `starts` starts; negative: none */
void slave_count_start(slave *s);
const char *slave_reason_text(const slave *s, ali3_status status); /* text of the status or of the limit of work */

/* Computes the initial state from the values set so far. False: an error was logged. */
bool slave_initialise(slave *s);
/* Writes " Worst constraint: ..." or nothing to `text` and returns it. */
const char *slave_worst_row_text(slave *s, char *text, size_t size);
/* Writes " 'wheel travel FL' is ..." or nothing to `text`. */
void slave_beyond_table_text(slave *s, char *text, size_t size);

/* Values of n variables by their value references. */
slave_status slave_get(slave *s, const uint32_t *reference, size_t n, double *value);
/* Sets variables; a bad value changes nothing, a value outside the range of an input is clamped with a warning. */
slave_status slave_set(slave *s, const uint32_t *reference, size_t n, const double *value);
/* Computes all outputs of the present state but the omitted ones. False: there is no valid state. */
bool slave_compute_outputs(slave *s);
/* Fills the derivatives (n_variables) of SLAVE_AHEAD variables from those of sensors. */
void slave_fill_ahead_rates(const slave *s, double *derivative);
/* Whether a value reference is that of an output. */
bool slave_is_output(uint32_t reference);

slave_status slave_clamp(slave *s, uint32_t reference, double value, double *clamped); /* of an input, with a warning */
slave_status slave_check_set(slave *s, uint32_t reference, double value); /* status of setting; nothing is set */

/* Values of n integer variables. */
slave_status slave_get_whole(slave *s, const uint32_t *reference, size_t n, int32_t *value);
/* Sets them; a bad value changes nothing. */
slave_status slave_set_whole(slave *s, const uint32_t *reference, size_t n, const int32_t *value);

/* Makes a communication step of `step` from `time`, s. */
slave_status slave_step(slave *s, double time, double step);

/* Adds the Taylor terms of a variable, `elapsed` s after the communication point, to its input. */
void slave_add_slope(const double *slope, size_t variable, double elapsed, double *input);
/* Adds those of all variables to their inputs (nu). */
void slave_add_slopes(const double *slope, double elapsed, double *input);
/* Inputs (nu) at `elapsed` s after the communication point of the last step with intermediate updates and inner steps
 * of h, s. */
void slave_intermediate_at(const slave *s, double elapsed, double h, double *input);
/* Inputs (nu) at `elapsed` s after the communication point; the kernel clamps them to their ranges. */
void slave_inputs_at(const slave *s, double elapsed, double *input);

/* Allocates rows of n inner steps; false if there is no memory. */
bool slave_intermediate_reserve(slave *s, int64_t n);
/* Frees them. */
void slave_intermediate_free(slave *s);
/* Sets inputs in an intermediate update of the host. */
slave_status slave_set_intermediate(slave *s, const uint32_t *reference, size_t n, const double *value);
/* Makes up to *n inner steps of h, s; *n becomes their number if the step returns early. *largest_residual: m, of
 * steps at the limit of their iterations. */
ali3_status slave_intermediate_steps(slave *s, int64_t *n, double h, double *largest_residual);
/* After a completed step: inputs that the host set within it keep their last value, and their slopes are cleared. */
void slave_intermediate_accept(slave *s);

/* Largest difference of unit normals of two answers on a road without an edge, see docs/decisions/0091. */
static const double SLAVE_EDGE = 0.3;

/* Value of a variable that is an input at the end of the last step, with its derivatives. */
double slave_reached_input(const slave *s, size_t i);
/* Whether variable i is the first of an answer on the road. */
bool slave_is_answer(size_t i);
/* Whether the answer at i changes linearly from the one before, by the slopes of its step. */
bool slave_is_ramp(const double *slope, size_t i);
/* Before a step, s, after normals are held: sets slopes of answers that hold at its end. */
void slave_begin_ramps(slave *s, double step);
/* After a refused step: clears them. */
void slave_end_ramps(slave *s);

/* After a completed communication step, before its slopes are cleared: advances the second motion; warns of a large
 * error. */
slave_status slave_half_steps_advance(slave *s);
/* After a start: forgets the second motion; the next step begins it. */
void slave_half_steps_begin(slave *s);
/* Whether the second motion may still follow the first one in a change of its assembly mode at `time`, s. */
bool slave_half_steps_may_follow(const slave *s, double time);
/* Before a state is saved and at the end: computes the pending steps. */
void slave_half_steps_settle(slave *s);
/* Bytes of `saved` that are part of a state, from which the second motion goes on as it was; writes it into bytes that
 * are zero, checks and reads it. */
size_t slave_half_steps_size(const slave_fidelity *f);
void slave_half_steps_write(const slave *s, unsigned char *bytes);
ali3_status slave_half_steps_check(const slave_fidelity *f, const unsigned char *bytes);
void slave_half_steps_read(slave *s, const unsigned char *bytes);
/* Updates the ranges of the compared outputs. */
void slave_half_steps_observe(slave *s);
/* At the end of the run, also where the host resets or frees the instance without termination. */
void slave_half_steps_end(slave *s);
/* Frees its memory. */
void slave_half_steps_free(slave *s);

/* Parameters (np) and inputs (nu) of the kernel in the last step: reads them, sets them again. */
void slave_read_step(const slave *s, double *parameter, double *input);
ali3_status slave_restore_step(const slave *s, const double *parameter, const double *input);

/* out (n_variables): derivative of the outputs that are sensors, after the last communication step, along a direction
 * of its inputs (nu); left_out: also of the omitted outputs. The instance stays unchanged. */
slave_status slave_step_derivative(slave *s, const double *direction, bool left_out, double *out);

/* Pieces of the elements' laws along replays of a step, ne each. */
typedef struct {
  uint32_t *now, *begin, *other; /* now, at the start of this replay, at the start of the replay before */
  unsigned char *passed; /* whether the piece changes */
  int32_t ne;
} slave_kinks;
/* At the start of a replay; `beside`: it is compared with the start of the replay before. */
void slave_kinks_begin(slave_kinks *k, ali3_instance *kernel, bool beside);
/* After an inner step: marks the elements whose piece has changed. */
void slave_kinks_after(slave_kinks *k, ali3_instance *kernel);
/* Logs the first element with a kink and the number of others as an error; SLAVE_OK without a kink. */
slave_status slave_kinks_report(slave *s, const slave_kinks *k);

/* Logs a refused step and returns SLAVE_DISCARD or, after two repetitions, SLAVE_ERROR. worst: details or ""; jumped:
 * the answer that jumped, or NULL. */
slave_status slave_refuse_step(slave *s, ali3_status status, double time, double step, const char *worst,
                               const slave_variable *jumped);
/* The host has changed a value since the last refused step. */
void slave_forget_refusal(slave *s);
/* Whether the simulation should end, as a refused step was repeated unchanged. */
bool slave_requests_end(const slave *s);
bool slave_is_of_step(ali3_status status); /* a smaller step_size may pass */

/* Warnings after a step; returns the worst status. */
slave_status slave_watch(slave *s);
/* Warning of a rollover, after outputs are computed. */
void slave_watch_outputs(slave *s);
/* Warnings of the System at the start; of a vehicle that is too heavy for its springs or stands on uneven ground. */
void slave_watch_start(slave *s);

/* Records that a port was set to a finite number, and whether it changed. */
void slave_record_port_set(slave *s, size_t i, bool changed);
/* After a step that began at `begin`, s: warns of ports that the host has not set, or has ceased to set. Integer ports
 * are exempt from the second, as they change at events only. */
void slave_watch_ports(slave *s, double begin);

/* Replaces invalid normals before a step or a start by the last ones of the kernel, at a start by those of the
 * table. */
void slave_hold_normals(slave *s);
/* Before a step, after normals are held: warns of an answer that lifts its wheel suddenly or drops the road below it;
 * the plane of an edge, which turns about the centre of the wheel, does neither. Returns the answer with the largest
 * jump, which may cause a refused step, or NULL. */
const slave_variable *slave_watch_jumps(slave *s);
/* After ALI3_BAD_NORMAL: writes the port whose normal became invalid by its derivatives, from the inputs of the inner
 * step in s->direction. */
void slave_bad_normal_text(const slave *s, char *text, size_t size);
/* After the outputs are computed: warns of answers far from their wheel, and of steps too long for a tyre. */
void slave_watch_answers(slave *s);

/* Sets derivatives of order 1 to SLAVE_MAX_ORDERS of n inputs for the next step. */
slave_status slave_set_slopes(slave *s, const uint32_t *reference, size_t n, const int32_t *order, const double *value);
/* First time derivatives of n outputs. */
slave_status slave_output_rates(slave *s, const uint32_t *reference, size_t n, const int32_t *order, double *value);
/* out (n_unknown): derivatives of outputs by n_known variables along the seed; before the first step by start values,
 * afterwards by inputs of the last step. */
slave_status slave_directional_derivative(slave *s, const uint32_t *unknown, size_t n_unknown, const uint32_t *known,
                                          size_t n_known, const double *seed, double *out);

typedef struct slave_state slave_state;
/* Stores the state in *state, which is allocated if it is NULL. */
slave_status slave_state_get(slave *s, slave_state **state);
/* Continues from a stored state. */
slave_status slave_state_set(slave *s, const slave_state *state);
/* Frees a state and sets *state to NULL. */
slave_status slave_state_free(slave *s, slave_state **state);
/* Size of a state as bytes. */
slave_status slave_state_size(slave *s, const slave_state *state, size_t *size);
/* Writes a state as bytes with a checksum. */
slave_status slave_state_write(slave *s, const slave_state *state, unsigned char *bytes, size_t size);
/* Checks bytes and makes a state of them. */
slave_status slave_state_read(slave *s, const unsigned char *bytes, size_t size, slave_state **state);
#endif
