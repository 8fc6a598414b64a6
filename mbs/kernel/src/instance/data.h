/* Data of an instance that callers set: inputs, parameters and arrays that depend on them, roads, the start. */
#ifndef ALI3_INSTANCE_DATA_H
#define ALI3_INSTANCE_DATA_H
#include "../system.h"

typedef struct ali3_road ali3_road; /* elements/road.h */

/* Values of inputs over a step, nu each, in the units of the System. A whole step is the one that a caller requests; it
 * may be divided in parts. */
typedef struct {
  double *set; /* as set, clamped to their ranges; within a step those at the end of the present part */
  double *work, *middle; /* scratch; values at the fraction of the present part that ali3_inputs_at was asked for */
  const double *forces; /* values that elements read: `set`, or `middle` when the middle of a step is evaluated */
  double *from, *to; /* at the start and the end of the whole step */
  double *begin; /* at the start of the present part */
  double *stage; /* ALI3_RADAU x nu: at the stages of radau.c */
  double whole_time, whole_length; /* s: start and length of the whole step */
  double part_time, part_length; /* s: of the present part */
  ali3_input_function *function; /* computes inputs as functions of time, or NULL */
  void *context; /* first argument of `function` */
  ali3_float_control host_control; /* floating-point control word of the caller, for `function`; 0: as the kernel's */
  const double *breaks; /* n_breaks, s: times at which steps are divided, ascending */
  int64_t n_breaks; /* 0: none */
} ali3_inputs;

/* Parameters, and copies of the arrays of the System that they change. */
typedef struct {
  double *value, *work; /* np, in the units of the System: as set; scratch */
  /* lengths, meaning and units as the arrays of these names in system_arrays.h */
  double *el_parameter, *guide_parameter, *road_parameter, *sen_parameter, *inertia_parameter, *axis_parameter;
  double *payload_mass, *armature_ratio; /* likewise */
  double *switch_on; /* n_switch: 0 or 1 at the start */
} ali3_parameters;

/* Storage of an instance for the arrays of ali3_masses that its parameters change. */
typedef struct {
  double *val, *front, *floor, *floor_inverse, *missing, *gravity; /* as there */
} ali3_own_masses;

/* Masses and gravity: of the System, or `own` if parameters change them. */
typedef struct {
  const double *val, *front; /* constant mass matrix: nnz_mass, as mass_val; front_size, the start of every tangent */
  const double *floor, *floor_inverse; /* nq: M_ii, or a typical mass if there is none; one over it */
  const double *missing; /* nq: that typical mass if the coordinate is massless, otherwise 0 */
  const double *gravity; /* nq, N or N m: generalised force of gravity on the constant masses */
  double gravity_const; /* J: potential energy of gravity is gravity_const - gravity . q */
  bool isotropic; /* see ali3_mass_isotropic */
  ali3_own_masses own; /* with payloads and armatures; empty if there are none */
} ali3_masses;

/* Copy of the System with the wheel axes that parameters set, and its arrays that differ from those of the System. */
typedef struct {
  ali3_system *system; /* NULL: no parameter sets an axis, and the members that follow are empty */
  double *val, *constant, *entry; /* as sig_val, sig_const and el_entry_value of ali3_system */
  double *mass, *speed; /* as tabled_mass and pose_speed */
  ali3_lookup *lookup; /* n_lookup: as `lookup` of the System, with `mass` */
} ali3_parametric_axes;

/* Roads. */
typedef struct {
  ali3_road *used; /* n: roads in use: own ones or from files */
  ali3_road *own; /* n: roads of the System */
  int32_t n; /* their number, as the System may be released before its instances */
} ali3_roads;

/* Source of the coordinates of the start: the System file, ali3_set_pose, ali3_set_q. */
enum { ALI3_PLACED_BY_FILE = 0, ALI3_PLACED_BY_POSE, ALI3_PLACED_BY_Q };

/* Coordinates of the start, and its position relative to the road. */
typedef struct {
  int32_t initialised; /* 1: the present state is consistent with the rows, otherwise 0 */
  int32_t placed; /* ALI3_PLACED_* */
  double *q; /* nq: coordinates of the start */
  double *pose_0, *pose_cos, *pose_sin; /* nq: q = pose_0 + cos(yaw) pose_cos + sin(yaw) pose_sin + translation */
  double pose[ALI3_POSE]; /* the pose set last, as of ali3_set_pose */
  bool moved; /* `q` differs from the file */
  bool to_lift; /* the height of the road at the next start is unknown, so that the scene must be lifted onto it */
  double lift; /* m: height by which the start was raised */
  double uneven; /* m: largest height of a contact above its height at rest */
  double unsettled; /* m/s: largest remaining speed after the last settled start */
} ali3_start;
#endif
