/* The slave behind both faces of FMI: life cycle, values, steps, states, derivatives of one instance. Knows the System
 * file and the table of variables; nothing of the FMI version and nothing of the model. */
#ifndef ALI3_SLAVE_H
#define ALI3_SLAVE_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ali3.h"

/* The table, generated with the FMU (table.c); the place of a variable is its number. */
typedef enum {
  SLAVE_INPUT,
  SLAVE_PARAMETER,
  SLAVE_POSE,
  SLAVE_STEP_SIZE,
  SLAVE_FIDELITY,
  SLAVE_STEP_ITERATIONS,
  SLAVE_SETTLING,
  SLAVE_LEAD, /* of what is ahead, in communication steps */
  SLAVE_SENSOR,
  SLAVE_SOLVER,          /* what the solver says about itself: ali3_solver_value */
  SLAVE_CAPPED_RESIDUAL, /* of the last communication step */
  SLAVE_AHEAD, /* an output communication steps later, by its rate */
  SLAVE_CONSTANT /* the start is its value */
} slave_source;

/* What inputs at ports are: x of the normal of a road, whose y and z follow; x of an answer on the road; x of the force
 * on a hub. */
enum { SLAVE_NO_ROLE, SLAVE_NORMAL, SLAVE_ANSWER, SLAVE_HUB };

typedef struct {
  const char *name, *unit; /* the unit as it stands behind a number */
  slave_source source;
  int32_t index; /* of that input, parameter, sensor, variable ahead or ALI3_SOLVER_*; place in x, y, z, yaw, speed */
  double start, min, max; /* infinite where open */
  bool whole; /* an integer of FMI */
  bool fixed; /* a parameter that can be set before the first step only */
  bool port; /* an input that another program sets at every step */
  int32_t road; /* a parameter of the built-in form of this road, without effect on a file; -1: of none */
  uint64_t uncomputed; /* bits of the fidelities whose System leaves it out */
  double least, most; /* between which a parameter works; infinite where that is not known */
  int32_t role; /* of an input, SLAVE_NO_ROLE ... */
  int32_t
      other; /* variable: of an answer the x of the wheel it is for, of a hub its velocity, ahead: the rate; or -1 */
  double scale; /* of inputs and sensors: the value is this times that of the System */
  double figure[4]; /* of a hub, see mbs.model.records.Role */
  ali3_judged judged; /* how two motions are compared by it; unit -1: not */
} slave_variable;

typedef struct {
  const char *name;
  int32_t road; /* whose file it names */
  const char *start;
} slave_text;

typedef struct {
  const char *token; /* GUID or instantiation token */
  unsigned char identity[16]; /* the same as bytes */
  const slave_variable *variable;
  size_t n_variables, n_known; /* known: inputs and parameters; then come outputs, then constants */
  const char *const *row; /* names of the constraint rows of all Systems */
  const size_t *first_row; /* n_systems + 1 */
  const char *const *element; /* names of the force elements of all Systems */
  const size_t *first_element; /* n_systems + 1 */
  const char *const *coordinate; /* names of the coordinates of all Systems that tables are over; of others "" */
  const size_t *first_coordinate; /* n_systems + 1 */
  const char *const *notice; /* what a start of each System tells beside its numbers */
  const size_t *first_notice; /* n_systems + 1 */
  size_t n_systems; /* to choose from by the fidelity */
  const int32_t *follower; /* n_systems: the one with ports that computes what each leaves out; -1: none */
  const ali3_generated *const *generated; /* n_systems: code for the algebra of each; NULL: there is none */
  const slave_text *text; /* variables that are text; numbered by themselves */
  size_t n_texts;
  size_t
      roll; /* output that is more than a quarter turn when the vehicle lies upside down; n_variables: there is none */
  size_t ground; /* output that is not 0 at the start of a vehicle that does not stand on its wheels alone; the same */
  double length; /* of the model, m */
} slave_table;

extern const slave_table slave_the_table;

/* Numbers as in both versions of FMI. */
typedef enum { SLAVE_OK, SLAVE_WARNING, SLAVE_DISCARD, SLAVE_ERROR, SLAVE_FATAL } slave_status;

typedef enum { /* bits, for masks of allowed calls */
               SLAVE_INSTANTIATED = 1,
               SLAVE_INITIALISING = 2,
               SLAVE_STEPPING = 4,
               SLAVE_STEP_FAILED = 8, /* the last good state is kept; the host may go on from it */
               SLAVE_TERMINATED = 16
} slave_phase;

enum { SLAVE_MOST_ORDERS = 3, SLAVE_TEXT = 1024, SLAVE_PATH = 4096, SLAVE_MOST_TEXT = 1024 };
enum { SLAVE_TERMS = SLAVE_MOST_ORDERS + 1 }; /* of an input along its derivatives, from order 0 on, see slopes.c */
typedef char slave_text_value[SLAVE_MOST_TEXT]; /* with zeros behind its end */

typedef struct slave slave;
typedef void slave_logger(slave *s, slave_status status, const char *category, const char *text);

enum {
  SLAVE_GIVEN = 1,
  SLAVE_HELD_AT_END = 2,
  SLAVE_HELD_LAST = 4,
  SLAVE_HELD_FLAT = 8,
  SLAVE_HELD_NORMAL = 16,
  SLAVE_FAR = 32, /* also of a hub: that it is slow for the step */
  SLAVE_JUMPED = 64, /* also of a hub: that its forces stay what they are */
  SLAVE_TURNED = 128 /* also of y of an answer: that the road bends too much */
}; /* bits of an input: set by the host, said once */
enum { SLAVE_NOT_CAPPED, SLAVE_CAPPED, SLAVE_CAPPED_BADLY }; /* what was said of limited iterations */
enum { SLAVE_SHORTER_STEPS = 1, SLAVE_LONGER_STEPS }; /* and of inner steps that are not step_size */

typedef struct { /* what a state is beside the kernel's bytes; numbers only */
  slave_phase phase;
  int32_t initialised, step_warned, energy_warned, mode_warned,
      capped_warned; /* said once a run, the first and the last twice */
  double start_time, stop_time; /* infinite where not given */
  double capped_residual; /* m, largest of the last communication step */
} slave_call_state;

typedef struct { /* a step that was refused and what the host did since: nothing, or count is 0 */
  int32_t count; /* how often the same step was refused */
  double time, step;
} slave_refusal;

typedef struct { /* the last good communication step, whose start the fidelity keeps */
  int64_t n; /* inner steps; 0: there is none */
  double h; /* s */
  bool sloped; /* along derivatives of the inputs, which are kept */
} slave_made;

typedef struct { /* inputs that the host gave within the last communication step, see intermediate_update.c */
  int64_t n, room; /* inner steps that rows are kept of, 0: none were given; that there is room for */
  double *row, *next; /* (n + 1) x nu: at the ends of inner steps, from the start on; the one that is asked for */
  double *value; /* n_known: what was given last */
  unsigned char *given; /* n_known */
} slave_asked;

typedef struct { /* a communication step that waits to be made a second time, see half_steps.c */
  int64_t n; /* inner steps */
  double h, end; /* s: one of them; time at its end */
  double span; /* s from its start on for which the other motion follows, as it was abrupt; 0: it was not */
  double driven; /* that of slave_half_steps, then */
  double *number; /* inputs; what is compared at its end */
  double *parameter;
  bool sloped, starts; /* inputs have slopes; the other motion starts here from `start` if it rests */
} slave_late_step;

typedef struct { /* of a motion that is made a second time with half the step, see half_steps.c */
  void *end, *other, *start; /* snapshots: this motion after the communication step, the other one, where it starts
                                next; NULL: not needed yet */
  double *input; /* work */
  /* what is compared, n: how; what was seen; by which sensor, as which variable; work, what it is held against */
  int32_t n, *sensor;
  ali3_judged *what;
  ali3_compared *seen;
  size_t *variable;
  double *shown, *size;
  slave_late_step *late; /* communication steps that wait, a ring of n_late from first on */
  size_t first, n_late;
  double sure; /* s: time up to which the other motion will go at least */
  int64_t made; /* inner steps of the other motion in the one that waits longest */
  int64_t iterations, cost; /* of this motion so far; of the other one in its last step */
  double left, spent, driven; /* s: of the time that is made twice, 0: nothing is; made twice so far; of all steps */
  double apart, time, h; /* largest difference that is not judged yet, of its size; when, s; inner step there, s */
  double origin; /* s: what was driven when the state was set that the run goes on from */
  double before, then; /* largest difference in the second quarter of a start, and since, of its size */
  double checked, foretold; /* s: up to when steps were made twice, and when by its growth the error is large */
  int32_t worst; /* of what is compared: where it is `then` */
  int64_t abrupt; /* abrupt steps that were seen */
  bool started; /* a step that waits may need `start` */
  bool begins; /* no step was made since the start */
} slave_half_steps;

typedef struct { /* when an input at a port was set */
  double given, longest; /* s: the last time; most of what lay between two of them */
  double changed, span,
      held; /* s: the last time to another value; from the one before to it; the less of the last two */
  double seen, way; /* of a hub: when its wheel was looked at last, s; how far it went under forces that stay, m */
  double times; /* how often, as far as it is counted; below 0: it was said that it is no more */
} slave_rhythm;

typedef struct { /* a System of the FMU at work */
  size_t number;
  ali3_system *system;
  ali3_instance *kernel;
  void *snapshot; /* of the kernel before the step, which may be taken back */
  void *start; /* the same of the last good communication step */
} slave_fidelity;

/* Outputs of the present state: none, those that were read, all but those that the System at work leaves out. */
typedef enum { SLAVE_STALE, SLAVE_SOME, SLAVE_FRESH } slave_freshness;

struct slave {
  void *host; /* what the face needs for its logger */
  slave_logger *logger;
  ali3_memory memory;
  char *name, *resources;
  bool logging, all_categories;
  unsigned categories; /* bits, see category_of in log.c */
  slave_fidelity fidelity, follower; /* the second is loaded when it is first needed */
  slave_call_state calls;
  slave_refusal refusal;
  slave_made made;
  slave_half_steps half_steps;
  slave_asked asked;
  void (*ask)(slave *s, double time); /* of the host for the inputs at a time within a step; NULL: it is not asked */
  bool early, returned_early; /* a step may end before its end; the last one did */
  slave_status last_step; /* what the last step was answered with */
  double *value; /* per variable; the outputs are filled when they are asked for */
  double *slope; /* per variable and order: derivatives of the inputs from the communication point on */
  double *made_slope; /* those of the last communication step */
  slave_rhythm *rhythm; /* per known variable, of ports */
  unsigned char *pending; /* per known variable: set and not yet with the kernel */
  unsigned char *said; /* per known variable: SLAVE_GIVEN and what was said once */
  slave_text_value *text; /* per text variable: the one whose road the kernel has */
  slave_freshness outputs;
  bool followed; /* the follower is at the present state */
  bool uncomputed_said; /* that an output was read which is not computed, once a run */
  /* once a run: that the vehicle lies upside down, that a rim was pressed in, that a contact or a stop was too quick */
  bool overturned_said, rim_said, event_said, unchecked_said; /* and that steps are not made twice */
  double *sensors, *direction; /* work: n_variables, nu */
  int32_t *number; /* work: n_variables, sensors that are evaluated */
  uint32_t *place; /* work: n_variables, the outputs that they are */
  unsigned char *fresh; /* per variable: an output of the present state, where SLAVE_SOME are */
  unsigned char *known; /* work: ns */
  size_t step_reference, iterations_reference, lead_reference;
  size_t fidelity_reference; /* n_variables where there is no choice */
  int64_t work_left; /* of the present call, see work.c */
};

/* float_control.c: the face of an instance begins with the control of its host */
ali3_float_control slave_call_begins(void *instance); /* result: that of the host; 0: the same, and nothing was done */
void slave_call_ends(void *instance, ali3_float_control host);
ali3_float_control slave_call_leaves(void *instance); /* into a function of the host */
void slave_call_returns(void *instance, ali3_float_control host);

/* A function of a face around what it does, whose body follows; compiled apart, so that no arithmetic leaves it. */
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

/* log.c */
slave_status slave_say(slave *s, slave_status status, const char *format, ...);
void slave_say_uncomputed(slave *s, const slave_variable *v);
slave_status slave_set_logging(slave *s, bool on, size_t n, const char *const *categories);
const char *slave_phase_name(slave_phase phase);
bool slave_allowed(slave *s, const char *function, unsigned mask);

/* resource.c */
bool slave_path_of_uri(const char *uri, char *path, size_t size);
unsigned char *slave_read(const char *folder, const char *name, const ali3_memory *memory, size_t *size,
                          const char **why);

/* fidelity.c */
bool slave_fidelity_load(slave *s, size_t number, slave_fidelity *loaded);
void slave_fidelity_take(slave *s, const slave_fidelity *loaded);
void slave_fidelity_free(const slave *s, slave_fidelity *loaded);
bool slave_fidelity_choose(slave *s);

/* read_sensors.c */
void slave_will_read(slave *s, size_t *n, uint32_t reference);
bool slave_read_sensors(slave *s, ali3_instance *kernel, size_t n);

/* omitted_outputs.c */
bool slave_left_out(const slave *s, const slave_variable *v);
bool slave_has_follower(const slave *s);
bool slave_follow(slave *s, const uint32_t *reference, size_t n);

/* texts.c: n numbers of text variables, the first of which is `first`, and as many texts */
slave_status slave_get_text(slave *s, uint32_t first, const uint32_t *reference, size_t n, const char **value);
slave_status slave_set_text(slave *s, uint32_t first, const uint32_t *reference, size_t n, const char *const *value);
bool slave_texts_to(slave *s, ali3_instance *kernel, const slave_text_value *value);
bool slave_texts_start(slave *s);
void slave_texts_remark(slave *s);
bool slave_without_effect(const slave *s, const slave_variable *v);

/* life_cycle.c */
slave *slave_new(const ali3_memory *memory, void *host, slave_logger *logger, bool logging, const char *name,
                 const char *token, const char *resources);
void slave_free(slave *s);
slave_status slave_setup(slave *s, double start_time, bool stop_defined, double stop_time);
slave_status slave_enter(slave *s);
slave_status slave_exit(slave *s);
slave_status slave_terminate(slave *s);
slave_status slave_reset(slave *s);

/* What was computed is no longer that of the values: the start is sought again, outputs are computed again. */
static inline void slave_stale(slave *s) {
  s->calls.initialised = 0;
  s->outputs = SLAVE_STALE;
}

/* work.c: the bound of a call; the kernel takes what it does off it */
#define SLAVE_MOST_WORK 2000000 /* a million steps of one iteration each: half a minute of a rigid car */
void slave_work_begins(slave *s);
double slave_steps_left(const slave *s); /* inner steps of one iteration each */
const slave_variable *slave_settling(const slave *s); /* the time that a start settles for; NULL: it does not */
double slave_settling_steps(const slave *s); /* inner steps that settle a start */
double slave_settling_left(const slave *s, double starts); /* how many so many starts may have each; below 0: none */
void slave_work_of_start(slave *s);
const char *slave_reason(const slave *s, ali3_status status); /* the text of the status, or that the bound is reached */

/* initial.c */
bool slave_initialise(slave *s);
const char *slave_worst_row(slave *s, char *text, size_t size);
/* " 'wheel travel FL' is ..." or nothing. */
void slave_beyond_table(slave *s, char *text, size_t size);

/* values.c: n numbers of variables and as many values */
slave_status slave_get(slave *s, const uint32_t *reference, size_t n, double *value);
slave_status slave_set(slave *s, const uint32_t *reference, size_t n, const double *value);
bool slave_outputs(slave *s);
void slave_ahead(const slave *s, double *derivative);
bool slave_is_output(uint32_t reference);

slave_status slave_taken(slave *s, uint32_t reference, double value, double *taken); /* of an input, and said once */
slave_status slave_may_set(slave *s, uint32_t reference, double value); /* the answer it would get; nothing is set */

/* integers.c: the same of whole numbers */
slave_status slave_get_whole(slave *s, const uint32_t *reference, size_t n, int32_t *value);
slave_status slave_set_whole(slave *s, const uint32_t *reference, size_t n, const int32_t *value);

/* step.c */
slave_status slave_step(slave *s, double time, double step);

/* slopes.c */
void slave_add_slope(const double *slope, size_t variable, double elapsed, double *input);
void slave_add_slopes(const double *slope, double elapsed, double *input);
void slave_asked_at(const slave *s, double elapsed, double h, double *input);
void slave_inputs_at(const slave *s, double elapsed, double *input);

/* intermediate_update.c */
bool slave_asked_room(slave *s, int64_t n);
void slave_asked_free(slave *s);
slave_status slave_set_asked(slave *s, const uint32_t *reference, size_t n, const double *value);
ali3_status slave_asked_steps(slave *s, int64_t *n, double h, double *left);
void slave_asked_taken(slave *s);

/* Turn of unit normals: sums of ground and edge stay below it, see docs/decisions/0091. */
static const double SLAVE_EDGE = 0.3;

/* road_ramps.c: answers on the road for the end of a step go there from the last ones */
double slave_reached(const slave *s, size_t i);
bool slave_is_answer(size_t i);
bool slave_is_ramp(const double *slope, size_t i);
void slave_begin_ramps(slave *s, double step);
void slave_end_ramps(slave *s);

/* half_steps.c */
slave_status slave_halve_steps(slave *s);
void slave_half_steps_begin(slave *s);
void slave_half_steps_look(slave *s);
void slave_half_steps_end(slave *s);
void slave_half_steps_free(slave *s);

/* repeated_step.c: parameters and inputs of the step that was made; the same set in the state of its start */
void slave_look_at_step(const slave *s, double *parameter, double *input);
ali3_status slave_set_step(const slave *s, const double *parameter, const double *input);

/* replay.c */
slave_status slave_step_derivative(slave *s, const double *direction, bool left_out, double *out);

/* kinks.c: pieces of the elements' laws along replays of a step, ne each */
typedef struct {
  uint32_t *now, *begin, *other; /* in this replay, at its begin, at that of the one before */
  unsigned char *passed; /* whether it changes */
  int32_t ne;
} slave_kinks;
void slave_kinks_begin(slave_kinks *k, ali3_instance *kernel, bool beside);
void slave_kinks_after(slave_kinks *k, ali3_instance *kernel);
slave_status slave_kinks_say(slave *s, const slave_kinks *k);

/* refused_step.c: a host that asks for a refused step again is stopped */
slave_status slave_refuse_step(slave *s, ali3_status status, double time, double step, const char *worst,
                               const slave_variable *jumped);
void slave_forget_refusal(slave *s);
bool slave_wants_end(const slave *s);
bool slave_is_of_step(ali3_status status); /* a smaller step_size may pass */

/* run_warnings.c: what a run says about itself, once */
slave_status slave_watch(slave *s);
void slave_watch_outputs(slave *s);
void slave_watch_start(slave *s);

/* ports.c */
void slave_port_given(slave *s, size_t i, bool changed);
void slave_watch_ports(slave *s, double begin);

/* wheel_answers.c: normals that are none hold the last ones; answers that jump or are far from a wheel, and steps that
 * are long for a tyre, are told */
void slave_hold_normals(slave *s);
const slave_variable *slave_watch_jumps(slave *s);
void slave_bad_normal(const slave *s, char *text, size_t size);
void slave_watch_answers(slave *s);

/* derivatives.c */
slave_status slave_set_slopes(slave *s, const uint32_t *reference, size_t n, const int32_t *order, const double *value);
slave_status slave_output_rates(slave *s, const uint32_t *reference, size_t n, const int32_t *order, double *value);
slave_status slave_directional(slave *s, const uint32_t *unknown, size_t n_unknown, const uint32_t *known,
                               size_t n_known, const double *seed, double *out);

/* state.c */
typedef struct slave_state slave_state;
slave_status slave_state_get(slave *s, slave_state **state);
slave_status slave_state_set(slave *s, const slave_state *state);
slave_status slave_state_free(slave *s, slave_state **state);
slave_status slave_state_size(slave *s, const slave_state *state, size_t *size);
slave_status slave_state_write(slave *s, const slave_state *state, unsigned char *bytes, size_t size);
slave_status slave_state_read(slave *s, const unsigned char *bytes, size_t size, slave_state **state);
#endif
