/* ALi3 kernel: loads a System, steps a State, evaluates sensors. C11, libc and libm only.
 *
 * A system is immutable and may be shared by threads; an instance belongs to one thread at a time.
 * After ali3_instance_new nothing allocates. A call that fails leaves the last accepted state untouched.
 */
#ifndef ALI3_H
#define ALI3_H
#include <stddef.h>
#include <stdint.h>

#if defined(ALI3_INSIDE) /* part of another library, which exports its own functions only */
#define ALI3_API
#elif defined(_WIN32)
#define ALI3_API __declspec(dllexport)
#else
#define ALI3_API __attribute__((visibility("default")))
#endif

#define ALI3_SYSTEM_VERSION 3
#define ALI3_STATE_VERSION 10

/* How calls end, numbers in this order: X(NAME, cause, words, remedy). Cause of a refusal: CALL, what was given; START,
 * whose worst row is named; STEP: too long a step; EQUATIONS: their worst row is named, and a shorter step may pass. */
/* clang-format off */
#define ALI3_STATUSES(X) \
  X(OK, CALL, "ok", "") \
  X(BAD_ARGUMENT, CALL, \
    "an argument is missing, not finite or out of range", \
    "Give every argument as a finite number within its range.") \
  X(BAD_FILE, CALL, "the bytes are not a valid System file", "Compile the model again and save its System.") \
  X(BAD_STATE, CALL, \
    "the bytes are not a state of this System", \
    "Restore a state that this version saved of this System.") \
  X(NO_MEMORY, CALL, "there is not enough memory", "Create fewer instances at a time, or close other programs.") \
  X(NOT_INITIALISED, CALL, "the instance must be initialised first", "Initialise it, then call again.") \
  X(NOT_ASSEMBLED, START, \
    "the assembly cannot be closed", \
    "Start nearer to a position in which all joints close.") \
  X(NOT_CONVERGED, EQUATIONS, \
    "the iteration did not converge, not even in smaller steps", \
    "A shorter step may succeed.") \
  X(SINGULAR, EQUATIONS, "the tangent is singular", "A shorter step may succeed.") \
  X(NOT_FINITE, EQUATIONS, "the motion or a force became infinite", "A shorter step may succeed.") \
  X(WRONG_METHOD, CALL, "the method does not accept this System", "'ali3p' accepts every System.") \
  X(START_REFUSED, CALL, "an element refuses the start", "Choose a start that is clear of it.") \
  X(UNRESOLVED, STEP, \
    "the motion is too fast for the step: the energy balance is violated, even in smaller steps", \
    "A shorter step may succeed.") \
  X(NO_TREE, CALL, \
    "this method needs a System of rigid bodies that revolute and prismatic joints connect to the ground", \
    "'ali3p' accepts every System.") \
  X(TOO_STIFF, CALL, \
    "the step is too long for an explicit method, which must follow the fastest motion", \
    "Implicit methods ('ali3p', 'radau_5') need not follow it.") \
  X(TOO_FAR, CALL, \
    "the start is too far away or too fast: positions must stay within 1e8 m, speeds and yaw within 1e6 m/s, rad", \
    "Start nearer to the origin, or slower.") \
  X(NO_EQUILIBRIUM, START, \
    "with these parameters there is no static equilibrium near the drawing to start from", \
    "Set parameters nearer to the values that the model was compiled with.") \
  X(BRANCH_CHANGED, STEP, "a closed loop changed its assembly mode", "A shorter step may stay in the mode.") \
  X(FIXED_PARAMETER, CALL, "a fixed parameter can be set before the start only", "Set it before the start.") \
  X(BAD_ROAD, CALL, "the file is not a valid road", "Write the road file again.") \
  X(ROAD_LOST, CALL, \
    "a part of the road cannot be read from its file", \
    "Restore the road file; no step length helps.") \
  X(TOO_MUCH_WORK, STEP, \
    "the step and its parts took more than 1000 iterations, the limit of a step", \
    "A shorter step may succeed.") \
  X(WHEEL_IN_ROAD, CALL, \
    "the centre of a wheel is below the road, where its contact is lost", \
    "Continue from another state.") \
  X(BAD_NORMAL, CALL, \
    "the normal of a road at a port must be a unit vector that points up", \
    "Give it at shorter intervals, or with derivatives that turn it less, whatever the inner step.") \
  X(BEYOND_TABLE, CALL, \
    "a coordinate has left the range of its table", \
    "Continue from another state, or give the coordinate a table that covers what the run can reach.") \
  X(BAD_INERTIA, CALL, \
    "the parameters give a body moments of inertia that are not positive, or one above the other two", \
    "Set the moments nearer to those that the model was compiled with.") \
  X(TURNS_TOO_FAR, STEP, \
    "a part with a gear or an armature turns by more than 0.52 rad in the step, even in its parts", \
    "A shorter step succeeds.")
/* clang-format on */
typedef enum {
#define ALI3_STATUS(NAME, cause, words, remedy) ALI3_##NAME,
  ALI3_STATUSES(ALI3_STATUS)
#undef ALI3_STATUS
      ALI3_STATUS_COUNT
} ali3_status;
typedef enum { ALI3_CAUSE_CALL = 0, ALI3_CAUSE_START, ALI3_CAUSE_STEP, ALI3_CAUSE_EQUATIONS } ali3_cause;

/* How the processor rounds, whether it takes denormal numbers for 0, and which exceptions trap: MXCSR without its
 * flags, FPCR. ali3_float_control_set: to the nearest, denormal numbers kept, no trap; the result is what was before, 0
 * where that is usual already. ali3_float_control_restore: nothing for 0. Flags of exceptions stay. */
typedef uint64_t ali3_float_control;
ali3_float_control ali3_float_control_set(void);
void ali3_float_control_restore(ali3_float_control previous);
/* Whether it is usual; inlined, as every call of an FMU asks. */
static inline int ali3_float_control_is_usual(void) {
#if defined(__x86_64__)
  uint32_t now;
  __asm__ volatile("stmxcsr %0" : "=m"(now));
  return (now & ~0x3fu) == 0x1f80;
#elif defined(__aarch64__)
  uint64_t now;
  __asm__ volatile("mrs %0, fpcr" : "=r"(now));
  return now == 0;
#else
  return 1; /* there is no such register */
#endif
}

typedef struct ali3_system ali3_system;
typedef struct ali3_instance ali3_instance;
typedef struct ali3_generated ali3_generated; /* src/generated.h */

enum { ALI3_UPDATE_LINEARISED = 0, ALI3_UPDATE_PAPER = 1 };

/* Methods, numbers of ali3_settings.method in this order: X(NAME, name, order of steps that change). */
/* clang-format off */
#define ALI3_METHODS(X) \
  X(ALI3P, ali3p, 2)                         /* trapezoidal rule with projections */ \
  X(GENERALISED_ALPHA, generalised_alpha, 1) /* the same with generalised-alpha, rho_infinity */ \
  X(ENERGY_MOMENTUM, energy_momentum, 2)     /* discrete derivatives of rows and potentials; keeps energy */ \
  X(ENERGY_MOMENTUM_4, energy_momentum_4, 3) /* five of them, order four; conservative Systems only */ \
  X(RUNGE_KUTTA_8, runge_kutta_8, 8)         /* explicit, index one, order eight; no element states */ \
  X(SEMI_RECURSIVE, semi_recursive, 8)       /* explicit, relative coordinates, order eight; no element states */ \
  X(SEMI_RECURSIVE_4, semi_recursive_4, 4)   /* the same of order four, for coarse errors */ \
  X(RADAU_5, radau_5, 5)                     /* implicit collocation, index three; no element states */
/* clang-format on */
enum {
#define ALI3_METHOD_NUMBER(NAME, name, order) ALI3_METHOD_##NAME,
  ALI3_METHODS(ALI3_METHOD_NUMBER)
#undef ALI3_METHOD_NUMBER
      ALI3_METHOD_COUNT
};

typedef enum {
  ALI3_PREDICTOR_PARABOLA = 0, /* through the accelerations and multipliers of past steps if they are smooth */
  ALI3_PREDICTOR_ACCELERATION = 1, /* the present ones stay: the paper's */
  ALI3_PREDICTOR_COUNT
} ali3_predictor;

typedef struct {
  double alpha; /* penalty, 1/s^2; 0: rule alpha = 1/(eps_rel h^2) */
  double eps_rel; /* used by the rule */
  double tolerance_r; /* on max_i |r_i| / m_i, coordinate units (m) */
  double tolerance_phi; /* on the constraint violation, m */
  double rho_infinity; /* generalised-alpha: spectral radius at infinite frequency, 0 to 1 */
  int32_t max_iterations; /* of Newton's method in a step or a part of one; it fails beyond */
  int32_t max_halvings; /* depth of step bisection; 0: never */
  int32_t project; /* 1: velocity and acceleration projections (24), (25) */
  int32_t update; /* ALI3_UPDATE_* */
  int32_t geometric; /* 1: exact geometric term sum lam_k H_k in the tangent */
  int32_t method; /* ALI3_METHOD_* */
  int32_t predictor; /* ALI3_PREDICTOR_*: start value of a step of ALi3-P */
  int32_t step_iterations; /* of ALi3-P and generalised-alpha: most iterations of a step, whose iterate is then accepted
                              as it is; 0: no such limit */
  double part_ratio; /* step over that of the run that this one checks: parts of divided steps have the same ratio, so
                        that both do not share the error of equal parts; 1: checks none */
} ali3_settings;

typedef struct {
  int64_t steps, iterations, factorizations, solves, halvings, failures; /* since the last initialise */
  int32_t last_iterations, max_iterations; /* of the last step; the most of a step since then */
  int32_t last_status, negative_pivots; /* ali3_status of the last step; pivots of the last factorization,
                                         after a static equilibrium directions in which it is unstable */
  double residual, violation; /* of the last step: max |r_i|/m_i, max |Phi| in m */
  double velocity_violation; /* max |Phi_q qd + Phi_t| * row_measure after projection */
  int32_t worst_row, worst_coordinate; /* indices of the row and the coordinate that have these residuals */
  double energy_jump; /* change of the kinetic energy by the last switching, J */
  double energy_error; /* work of constraint forces and projections, J; 0: exact, or not measured */
  /* what says whether the run is right, see ali3_energy_balance; the first three of methods with an energy balance */
  double energy; /* kinetic and potential energy of the state, J */
  double work; /* what inputs and forces without a potential gave and took: sum over the steps, J */
  double kinetic_peak; /* largest kinetic energy, at least that at ALI3_REST_SPEED, J */
  /* in the metric of the diagonal of M, sqrt(kg) m/s: largest velocity, length of the path of the velocity (over the
   * largest: radians that the motion has turned), sum of the errors of v + h a over the steps, of methods of order
   * above two the larger of what start and end of a step give */
  double speed_peak, velocity_path, predictor_path;
  double velocity_squares, predictor_squares; /* sums of the squares of what the steps add to both paths */
  double fastest_rate; /* if a step was refused as too stiff: largest rate of change of the motion there, 1/s; if
                          what is geared turns too far, its rate, rad/s */
  double open_power; /* of forces at the state that (25) left without balance, W; they work in the next step */
  double energy_floor; /* work of gravity along tolerance_r, J: a smaller energy_error tells nothing */
  /* Systems on which nothing acts but forces with a potential, whose energy stays: states that were looked at, set to 0
   * where it may jump; the energy of the first, J, means of their number of steps and of their energy, J, and sums of
   * the squares and products of what they are off these: 1, J^2, J */
  int64_t free_states;
  double free_start, free_steps, free_energy, free_steps_squares, free_energy_squares, free_product;
  /* how much deeper than it holds a rim was pressed into a road at the start of a step, m, 0: never; when, s; centre of
   * its wheel, m, earth axes; index of the element */
  double rim_pressed, rim_time, rim_x, rim_y;
  int64_t rim_element;
  double largest_force, largest_load; /* of a tyre, a contact or a spring with end stops; load of a tyre, N */
  int64_t abrupt_steps; /* in which one of these changed by more than a tenth of the largest; without roads of springs
                           beyond a stop; and those that end at a point of a force's table */
  int64_t divisions; /* of steps where such a force changes quickly, a stop is met or left, at breaks of inputs, or at a
                        point of a force's table */
  double change_rate; /* change of such a force in the last part of a step over its limit and the part's length, 1/s */
  int64_t branch_changes; /* changes of the assembly mode of closed loops; the first one: */
  double branch_time; /* s */
  int32_t branch_kind, branch_loop, branch_triad; /* ALI3_BRANCH_*, number of the loop, of the joint within it */
  int32_t balance; /* ALI3_BALANCE_*, as ali3_report_get finds it */
  int64_t capped; /* steps that ended at settings.step_iterations, or stayed whole for it */
  double capped_residual; /* the largest they left: max |r_i|/m_i or max |Phi|, m */
} ali3_report;

enum { ALI3_BRANCH_NONE = 0, ALI3_BRANCH_LEFT, ALI3_BRANCH_JUMP }; /* ali3_report.branch_kind */
/* ali3_report.balance. The energy balance is open if ali3_energy_balance is above ALI3_WRONG_ERROR, by more than what
 * the tolerance of the residual leaves open. It decides that the run is wrong if the method says so and no row is
 * driven: a drive takes up what the rows err, and one whose rate jumps adds energy instantly. A run whose balance is
 * kept may be wrong too. */
enum { ALI3_BALANCE_KEPT = 0, ALI3_BALANCE_OPEN, ALI3_BALANCE_WRONG };

/* Numbers of the parts of a System, by which the lengths of its vectors are named. */
typedef struct {
  int32_t nq, nc, nu, ng; /* coordinates, rows, inputs, driving functions */
  int32_t ne, ny, ns, np; /* force elements, their states, sensors, parameters */
  int32_t nout, nf; /* outputs of all elements, fronts */
  int32_t front_size, nnz_mass, nnz_rows; /* numbers in front storage, entries of M and of Phi_q */
  int32_t nsig, has_pose, n_switch; /* signals; 1: a pose may place the scene, otherwise 0; switches */
} ali3_sizes;

/* Words of a status, a sentence without its point; its remedy, a sentence; its cause. */
ALI3_API const char *ali3_status_text(ali3_status s);
ALI3_API const char *ali3_status_remedy(ali3_status s);
ALI3_API ali3_cause ali3_status_cause(ali3_status s);
ALI3_API uint32_t ali3_version(void);
/* Bytes of a structure of this header by its name, for callers in other languages; 0: there is none of that name. */
ALI3_API size_t ali3_structure_size(const char *name);

ALI3_API ali3_status ali3_system_load(const void *bytes, size_t size, ali3_system **out, char *message,
                                      size_t message_size);
/* The same with memory of the caller's, for the system and its instances; allocate gives zeroed memory, as calloc. */
typedef struct {
  void *(*allocate)(size_t count, size_t size); /* NULL: there is no memory */
  void (*release)(void *block); /* of `allocate` */
} ali3_memory;
ALI3_API ali3_status ali3_system_load_with(const void *bytes, size_t size, const ali3_memory *memory, ali3_system **out,
                                           char *message, size_t message_size);
ALI3_API void ali3_system_free(ali3_system *s);
/* A hash of all of a System that generated code depends on. */
ALI3_API uint32_t ali3_system_structure(const ali3_system *s);
/* Code that was generated for the structure of this System replaces its loops, with the same bits; to be called before
 * its first instance. Code of another is refused with a sentence without its full stop. It stays the caller's. */
ALI3_API ali3_status ali3_system_attach(ali3_system *s, const ali3_generated *generated, char *message,
                                        size_t message_size);
ALI3_API ali3_sizes ali3_system_sizes(const ali3_system *s);
ALI3_API int32_t ali3_road_count(const ali3_system *s);

ALI3_API size_t ali3_instance_size(const ali3_system *s); /* bytes of an instance */
ALI3_API ali3_status ali3_instance_new(const ali3_system *s, ali3_instance **out);
ALI3_API void ali3_instance_free(ali3_instance *in);
/* A file (roads/road_file.h, path in UTF-8) instead of a road of the System, for the next ali3_initialise; NULL or an
 * empty path: the road of the System again. The file is opened, checked and gets the memory it needs: what is not near
 * is read when a step comes there. The friction factor of the road goes on. ALI3_BAD_ROAD leaves the road as it was and
 * a sentence without its full stop in the message, which may be NULL. Files stay over ali3_reset. */
ALI3_API ali3_status ali3_set_road(ali3_instance *in, int32_t road, const char *path, char *message,
                                   size_t message_size);
/* After ALI3_ROAD_LOST: what is wrong with which part of a file, in words without a full stop; otherwise "". */
ALI3_API const char *ali3_road_lost(const ali3_instance *in);
/* Heights at n places of the surface of a road that is a grid, of nx x ny values z (y fastest) from the point grid[0],
 * grid[1] on, every grid[2] in x and grid[3] in y. The places are pairs of x and y. */
ALI3_API void ali3_grid_heights(int32_t nx, int32_t ny, const double grid[4], const double *z, int64_t n,
                                const double *places, double *heights);
/* Whether a vector is a normal that a road at a port can have: of length 1 within a tenth, and pointing up. */
ALI3_API int ali3_is_road_normal(const double n[3]);
/* The first wheel whose centre is half a radius below a road that is a grid, where its contact is lost, as a sentence
 * without its full stop; ALI3_OK and "" if there is none, otherwise ALI3_WHEEL_IN_ROAD. *element: its number, or -1. */
ALI3_API ali3_status ali3_wheel_in_road(const ali3_instance *in, int32_t *element, char *text, size_t size);

/* The coordinate that is farthest beyond its table, by more than a spacing: a body is none along a tangent there.
 * ALI3_OK if there is none, otherwise ALI3_BEYOND_TABLE. *column: its number, or -1; its value and both ends of the
 * table. Both may be NULL. */
ALI3_API ali3_status ali3_beyond_table(const ali3_instance *in, int32_t *column, double value_and_ends[3]);
/* A sentence on a wheel whose rim was pressed into the road, otherwise "". *element: its number, or -1; may be NULL. */
ALI3_API ali3_status ali3_rim_text(const ali3_instance *in, int32_t *element, char *text, size_t size);
ALI3_API ali3_status ali3_reset(ali3_instance *in); /* back to q0, qd0, y0, default inputs, parameters and settings */
ALI3_API ali3_settings ali3_default_settings(void);
ALI3_API ali3_status ali3_set_settings(ali3_instance *in, const ali3_settings *settings);
ALI3_API ali3_status ali3_get_settings(const ali3_instance *in, ali3_settings *settings);
/* The value, clamped to its range; it is held until it is set again. */
ALI3_API ali3_status ali3_set_input(ali3_instance *in, int32_t index, double value);
/* Inputs as a function of time: writes those at time t to `input` (nu), which comes with the present ones, so that some
 * may be left as they are; returns other than 0 to refuse. Steps then ask at every time at which their method looks at
 * inputs, halves of a step too: with after = 1 at the start of a step, where the value behind a jump counts, otherwise
 * with 0. Numbers are clamped to their ranges; what is refused or not finite ends the step with ALI3_BAD_ARGUMENT.
 * NULL: the values of ali3_set_input or ali3_run, as before. The function is not part of a saved state; ali3_reset
 * removes it. */
typedef int32_t ali3_input_function(void *context, double t, int32_t after, double *input);
ALI3_API ali3_status ali3_set_input_function(ali3_instance *in, ali3_input_function *function, void *context);
/* Times (n, ascending, the caller's) at which it jumps: until a function is set, steps have parts that end there. */
ALI3_API ali3_status ali3_set_input_breaks(ali3_instance *in, const double *time, int64_t n);
/* Such a function, whose context is an ali3_input_tables: straight lines between the points of each table, held
 * outside; a time given twice is a jump, and times within `tolerance` of a jump are at it. A table of one point is a
 * constant. */
typedef struct {
  int32_t input; /* its number */
  int64_t n; /* points, one at least */
  const double *time, *value; /* n: s, do not decrease; in the unit of the input */
} ali3_input_table;
typedef struct {
  double tolerance; /* s */
  int32_t n; /* tables */
  const ali3_input_table *table; /* n */
} ali3_input_tables;
ALI3_API int32_t ali3_input_of_tables(void *tables, double t, int32_t after, double *input);
ALI3_API ali3_status ali3_get_input(const ali3_instance *in, int32_t index, double *value);
/* Range and what it writes to are checked. A tunable one takes effect at the next step; a fixed one can be set until
 * ali3_initialise and again after ali3_reset, ali3_set_pose or ali3_set_q. ali3_try_parameter: whether the value could
 * be set before a start; nothing changes. */
ALI3_API ali3_status ali3_set_parameter(ali3_instance *in, int32_t index, double value);
ALI3_API ali3_status ali3_try_parameter(ali3_instance *in, int32_t index, double value);
ALI3_API ali3_status ali3_get_parameter(const ali3_instance *in, int32_t index, double *value);
/* x, y, z, m, yaw, rad, speed along the heading, speed to its left, m/s, and yaw rate, rad/s, of the origin of the
 * drawing, earth axes. */
#define ALI3_POSE 7
ALI3_API ali3_status ali3_set_pose(ali3_instance *in, const double *pose);
ALI3_API ali3_status ali3_set_q(ali3_instance *in, const double *q, const double *qd); /* before initialise */
/* Rows of a switch on or off: before initialise as drawn; later they hold the values they have at that moment, the
 * velocities are projected, accelerations and multipliers computed again; report.energy_jump is the change of
 * energy. */
ALI3_API ali3_status ali3_set_switch(ali3_instance *in, int32_t number, int32_t on);
ALI3_API ali3_status ali3_get_switch(const ali3_instance *in, int32_t number, int32_t *on);
/* If the file starts in static equilibrium and parameters of elements or driving functions differ from the file: that
 * equilibrium first, at the place of the drawing, then the pose. Coordinates given by ali3_set_q stay as they are.
 * Position problem (mass-weighted nearest point on Phi = 0), velocity problem, consistent accelerations and
 * multipliers. */
ALI3_API ali3_status ali3_initialise(ali3_instance *in, double t0);
/* After ali3_initialise of a scene that a pose may place: the place along the ground and the velocity of the heaviest
 * point, the heading and the yaw rate of the heaviest direction (in a car that of its chassis) are held for the
 * duration (s) by steps of at most h, with the present inputs, or those of the input function before this time, while
 * all else settles; then the run begins, at the same time and with books at zero. After a failure the scene must be
 * reset. ALI3_BAD_ARGUMENT, too, if no body has a direction. */
#define ALI3_LONGEST_SETTLING 10.0
ALI3_API ali3_status ali3_settle(ali3_instance *in, double duration, double h);
/* The parts that steps are made in from now on, their iterations, and for each step of ali3_settle ALI3_SETTLING_WORK,
 * as its forces and accelerations are found anew, are taken off *left, which outlives the instance; where nothing is
 * left steps and settlings end with ALI3_TOO_MUCH_WORK. NULL, as it begins: they have no bound together. */
#define ALI3_SETTLING_WORK 8
ALI3_API void ali3_count_work(ali3_instance *in, int64_t *left);
/* After ali3_settle: the largest speed beside the held motion, m/s, of a point or, along the ground, of the end of a
 * direction; of a body that turns by itself it does not become small. 0 after a start that did not settle. */
ALI3_API double ali3_unsettled(const ali3_instance *in);
/* After ALI3_START_REFUSED: how much higher, m, the scene must start so that it is out of the way of all elements.
 * Which element refuses the start most (-1: none), and its words after the element's name; NULL: not asked for. */
ALI3_API double ali3_start_excess(const ali3_instance *in, int32_t *element, const char **words);
/* A scene that a pose may place starts on a road of a file at the height at which it rests on its own: a sentence on
 * how much the last start was raised for that and how far the part that is highest above its place of rest has to sink;
 * empty up to 1 mm, and after ali3_settle. */
ALI3_API ali3_status ali3_start_text(const ali3_instance *in, char *text, size_t size);
/* Forces that count as none: 1e-6 of the largest force of gravity on a coordinate, N. */
ALI3_API double ali3_no_force(const ali3_instance *in);
/* After ALI3_WRONG_METHOD: what the method of the settings takes no System with, in words; "" if it takes all. */
ALI3_API const char *ali3_method_excludes(const ali3_instance *in);
/* Static equilibrium near the present position with all rates zero, max |Q - Phi_q' lam|_i <= tolerance (N, N m);
 * then as ali3_initialise. */
ALI3_API ali3_status ali3_static_equilibrium(ali3_instance *in, double t0, double tolerance, int32_t max_iterations);
ALI3_API ali3_status ali3_step(ali3_instance *in, double h);
/* steps: inputs is (n_steps x nu) row major, the values at the end of each step, to which they go straight from those
 * at its start, or NULL (held); every k-th state's sensors go to out (n_steps/every x ns), its coordinates to positions
 * (n_steps/every x nq) unless they are NULL. *done is the number of accepted steps. */
ALI3_API ali3_status ali3_run(ali3_instance *in, double h, int64_t n_steps, const double *inputs, int64_t every,
                              double *out, double *positions, int64_t *done);
/* Several instances of one System that advance together, a lane each: every number of a step is a vector of 2, 4 or 8
 * of them, by the instructions that the processor has. Each lane has the bits of ali3_run. Steps of ALi3-P with
 * projections and the linearised update, of Systems without switches, are made together; other Systems, methods and
 * settings, and what one lane needs and the others do not (halves of a step, a failure, the damped start of a flexible
 * System), are stepped alone and counted. A group belongs to one thread at a time. */
typedef struct ali3_many ali3_many;
typedef struct {
  ali3_instance *instance; /* of the System of the lanes, each once, all with the same settings */
  const double *inputs; /* as of ali3_run */
  double *out, *positions; /* likewise */
  int64_t done, alone; /* accepted steps of the call; steps made alone */
  int32_t status; /* ALI3_OK, or why this lane stopped; the others go on */
} ali3_lane;
ALI3_API int32_t ali3_widest_lanes(void); /* 2, 4 or 8: the most that this processor has instructions for */
ALI3_API size_t ali3_many_size(const ali3_system *s, int32_t width); /* bytes beside the instances */
ALI3_API ali3_status ali3_many_new(const ali3_system *s, int32_t width, ali3_many **out); /* at most the widest */
ALI3_API void ali3_many_free(ali3_many *many);
/* n, at most the width, instances make n_steps of h. */
ALI3_API ali3_status ali3_many_run(ali3_many *many, int32_t n, ali3_lane *lane, double h, int64_t n_steps,
                                   int64_t every);
/* Steps of any length by step doubling, so that their errors add up to the tolerance over the span (error per unit
 * step). Errors of positions are relative to `length`, errors of velocities to length * rate or to the present speed.
 * What is given comes first; the counts start at 0 and go on from call to call. */
typedef struct {
  double tolerance, length, span, rate; /* 1, m, s, 1/s: the least rate of the motion */
  double longest; /* of steps, s */
  double h; /* next step to try, s; 0: chosen */
  double last; /* error of the last step relative to its limit, for the controller; 0: none */
  double usual; /* mean of the last some hundred steps, s */
  double smallest, largest; /* accepted steps, s */
  double error_sum; /* of the estimates of accepted steps */
  double forced_error; /* the part of it of steps as short as they may be that erred more than they might */
  int64_t accepted, rejected, failed, forced; /* steps; failed: did not converge */
  int64_t over_share; /* steps with an error above their part of the tolerance and below a fixed limit */
  int64_t side_steps; /* made for a record when no polynomial through the steps was accurate enough */
} ali3_control;
/* Times at which a run is recorded, and what is recorded there. */
typedef struct {
  int64_t n; /* times */
  const double *time; /* n, s, ascending, after the present time */
  double *sensors, *positions; /* n x ns, n x nq, row major; may be NULL */
} ali3_record;
/* At most most_steps steps towards t_end, which is the end of one. Breaks of driving functions of time are ends of
 * steps; inputs must not jump before t_end. scale (nq): size of a unit of each coordinate, m; NULL: 1. *done counts
 * the rows of the record that are written. A step that fails as short as it may be ends the call; the state before it
 * is kept. */
ALI3_API ali3_status ali3_control_run(ali3_instance *in, ali3_control *control, const double *scale, double t_end,
                                      int64_t most_steps, const ali3_record *record, int64_t *done);
/* Accelerations and multipliers of the present inputs and driving functions, without the history: after a jump of
 * these. */
ALI3_API ali3_status ali3_refresh(ali3_instance *in);
ALI3_API ali3_status ali3_sensors(ali3_instance *in, double *out); /* ns values at the present state */
/* The same of n sensors by their numbers. */
ALI3_API ali3_status ali3_some_sensors(ali3_instance *in, int32_t n, const int32_t *number, double *out);
/* The System with ports that another run follows, ALI3_BAD_ARGUMENT if it does not belong to the other System: takes
 * over its state, accelerations and multipliers and finds the forces at the ports, for ali3_sensors. `source` stays as
 * it is. */
ALI3_API ali3_status ali3_ports_follow(ali3_instance *in, const ali3_instance *source);
/* First time derivatives of the sensors; known[i] = 0 if sensor i depends on forces or accelerations (rates[i] = 0). */
ALI3_API ali3_status ali3_sensor_rates(ali3_instance *in, double *rates, unsigned char *known);
ALI3_API ali3_status ali3_report_get(const ali3_instance *in, ali3_report *out);
/* A row that is open by less, m, is not why something failed. */
#define ALI3_OPEN 1e-9
/* Farthest and fastest start, m and m/s or rad/s, and its yaw, rad: coordinates have 16 digits. */
#define ALI3_FARTHEST 1e8
#define ALI3_FASTEST 1e6
/* |energy_error| relative to the energy that was in the motion: largest kinetic energy and work, or energy_floor. */
ALI3_API double ali3_energy_balance(const ali3_report *report);
/* Two motions of a System with longer and shorter steps, compared by numbers that they show, each in a unit. What rests
 * judges nothing: its size is 0. Rates, and forces of motors, are judged where no place moves by itself. */
enum { /* units */
       ALI3_JUDGED_M = 0,
       ALI3_JUDGED_RAD,
       ALI3_JUDGED_COORDINATE,
       ALI3_JUDGED_N,
       ALI3_JUDGED_M_S,
       ALI3_JUDGED_RAD_S,
       ALI3_JUDGED_N_M,
       ALI3_JUDGED_PA,
       ALI3_JUDGED_COUNT
};
/* Bits: a position, a length or an angle; a force, held against its largest value, all else against its range; judged
 * in any case, rates and motors are not; an angle from -pi to pi. */
enum { ALI3_JUDGED_PLACE = 1, ALI3_JUDGED_LOAD = 2, ALI3_JUDGED_ALWAYS = 4, ALI3_JUDGED_WRAPPED = 8 };
typedef struct {
  int32_t unit, kind; /* ALI3_JUDGED_M to ALI3_JUDGED_PA; bits */
  double factor; /* of the values, to the unit */
} ali3_judged;
typedef struct { /* of one of them; zero before the first sample */
  double least, most; /* of the finer motion, of an angle without its jumps */
  /* of an angle: the last value, its turns, the largest change between compared samples */
  double last, turns, quickest;
  double gap, time, latest; /* the largest difference, when, s, and the last one */
  int64_t samples, in_turn; /* all of them; those that were compared since one for ranges only */
} ali3_compared;
/* Adds n numbers at so many times (NULL: no matter): of the coarser motion (`one`, NULL: ranges only; NaN: that number
 * is not compared) and of the finer one, row major. */
ALI3_API void ali3_compare(const ali3_judged *judged, int32_t n, int64_t rows, const double *time, const double *one,
                           const double *other, ali3_compared *seen);
/* What a difference of each is held against, the largest range or force in its unit; 0: it does not count. `length`: of
 * the model, m; `energy`, J: forces that do less work along the length, or moments along a radian, do not count;
 * `exclude_prescribed`: places that are the same in both motions are prescribed and do not count as moving. */
ALI3_API void ali3_compared_sizes(const ali3_judged *judged, int32_t n, const ali3_compared *seen, double length,
                                  double energy, int32_t exclude_prescribed, double *size);
/* The largest difference, or the largest of the last sample, relative to its size; *worst: whose, -1: none. */
ALI3_API double ali3_compared_error(int32_t n, const ali3_compared *seen, const double *size, int32_t latest,
                                    int32_t *worst);
#define ALI3_STILL 1e-4 /* of the largest value, or of the length: a smaller range is rest */
#define ALI3_REST_SPEED 1e-6 /* m/s: a slower motion has no energy error and no rates to compare */
#define ALI3_WRONG_ERROR 0.05 /* of the size: wrong */
#define ALI3_RESOLVED 0.5 /* largest resolved fraction of missed changes of velocity, h w/2 of a vibration of w */
#define ALI3_AGREED 0.1 /* of what would be wrong: two motions that differ by less agree */
#define ALI3_MOST_PARTS 8 /* by which the step of a second motion is longer, or half of it shorter, at most */
/* One sentence about the first change of an assembly mode that the report counts, UTF-8; empty if there is none. */
ALI3_API ali3_status ali3_branch_text(const ali3_instance *in, char *text, size_t size);
ALI3_API double ali3_time(const ali3_instance *in);

enum { /* report of the solver; the integer of sensors of type 13 */
       ALI3_SOLVER_ITERATIONS = 0, /* of the last step */
       ALI3_SOLVER_VIOLATION, /* m */
       ALI3_SOLVER_RESIDUAL, /* m */
       ALI3_SOLVER_FACTORIZATIONS, /* since the start */
       ALI3_SOLVER_HALVINGS, /* since the start */
       ALI3_SOLVER_STATUS, /* of the last step; of a good one after a change of an assembly mode ALI3_BRANCH_CHANGED */
       ALI3_SOLVER_ENERGY_ERROR, /* J, since the start */
       ALI3_SOLVER_ENERGY_BALANCE, /* the same relative to the motion, see ali3_energy_balance */
       ALI3_SOLVER_CAPPED, /* steps since the start that ended at settings.step_iterations, or stayed whole for it */
       ALI3_SOLVER_COUNT
};
ALI3_API double ali3_solver_value(const ali3_instance *in, int32_t kind);
/* What the steps of the last ali3_step or ali3_run left that ended at settings.step_iterations, the largest, m; 0 if
 * none did. Not part of a saved state. */
ALI3_API double ali3_capped_residual(const ali3_instance *in);

/* Flat, versioned, pointer-free, checksummed; bound to the System and the files of its roads by CRC. Holds all that
 * continues bit for bit, parameters and settings too. */
ALI3_API size_t ali3_state_size(const ali3_system *s);
ALI3_API ali3_status ali3_state_save(const ali3_instance *in, void *bytes, size_t size);
ALI3_API ali3_status ali3_state_restore(ali3_instance *in, const void *bytes, size_t size);
/* A copy in memory of what inputs, parameters and steps change, for steps that are taken back: a block of
 * ali3_snapshot_size bytes, aligned as by malloc, which must be restored to the instance it was taken of. Settings are
 * not in it: if the method is another one now, call ali3_set_settings after it. */
ALI3_API size_t ali3_snapshot_size(const ali3_system *s);
ALI3_API void ali3_snapshot_take(const ali3_instance *in, void *snapshot);
ALI3_API void ali3_snapshot_restore(ali3_instance *in, const void *snapshot);
/* Whether one that was stored elsewhere may be restored: ALI3_OK or ALI3_BAD_STATE; the instance stays as it is. */
ALI3_API ali3_status ali3_snapshot_check(ali3_instance *in, const void *snapshot);
/* Per force element (ne) 1 if it touches a road in the present position, otherwise 0. */
ALI3_API void ali3_contacts(const ali3_instance *in, unsigned char *touching);
/* Per force element (ne) a number of the smooth piece of its law that holds in the present state with the present
 * inputs: when it changes, a stop is met or left, friction sticks or slips, a limit is reached. */
ALI3_API void ali3_law_pieces(ali3_instance *in, uint32_t *piece);

/* For tests and linearisation: values at a given (q, qd, y, t); any output may be NULL. Does not change the state.
   phi, lam and jacobian are those of the stored (mass-normalised) rows; of conditions on velocities, A qd = 0, phi is
   zero and the jacobian is A. Signs are those of M qdd + Phi_q' lam = Q: rows put the force -Phi_q' lam on q. */
ALI3_API ali3_status ali3_get_state(const ali3_instance *in, double *q, double *qd, double *qdd, double *lam,
                                    double *y);
ALI3_API ali3_status ali3_evaluate(ali3_instance *in, const double *q, const double *qd, const double *y, double t,
                                   double *phi, double *jacobian_values, double *phi_t,
                                   double *gamma /* d(Phi_q)/dt qd + d(Phi_t)/dt */, double *force /* Q, nq */,
                                   double *outputs);
/* The tangent (23) as a dense symmetric nq x nq matrix at the present state for step h with multipliers lam (NULL:
 * present). */
ALI3_API ali3_status ali3_tangent(ali3_instance *in, double h, const double *lam, double *dense);
/* M(q), dense nq x nq; it depends on q only if bodies are flexible. */
ALI3_API ali3_status ali3_mass_matrix(ali3_instance *in, const double *q, double *dense);
/* One element step in isolation: slots y_old -> y_new over h at (q, qd); force (nq) may be NULL. */
ALI3_API ali3_status ali3_element_step(ali3_instance *in, const double *q, const double *qd, const double *y_old,
                                       double h, double *y_new, double *force);
#endif
