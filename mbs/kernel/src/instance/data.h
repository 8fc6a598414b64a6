/* Data of an instance that callers set: inputs, parameters and arrays that depend on them, roads, the start. */
#ifndef ALI3_INSTANCE_DATA_H
#define ALI3_INSTANCE_DATA_H
#include "../system.h"

typedef struct ali3_road ali3_road; /* elements/road.h */

/* Values of inputs over a step, nu each. A whole step is the one that a caller requests; it may be divided in parts. */
typedef struct {
  double *set; /* as set, clamped to their ranges */
  double *work, *middle; /* scratch; values in the middle of a step */
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
  int64_t n_breaks;
} ali3_inputs;

/* Parameters, and copies of the arrays of the System that they change, by the names of the System. */
typedef struct {
  double *value, *work; /* np: as set; scratch */
  double *el_real, *guide_real, *road_real, *sen_real, *inertia_real, *axis_real;
  double *payload_mass, *armature_ratio, *switch_on;
} ali3_parameters;

/* Storage of an instance for the arrays of ali3_masses that its parameters change. */
typedef struct {
  double *val, *front, *floor, *floor_inverse, *missing, *gravity;
} ali3_own_masses;

/* Masses and gravity: of the System, or `own` if parameters change them. */
typedef struct {
  const double *val, *front; /* nnz_mass; front_size, the start of every tangent: the mass matrix */
  const double *floor, *floor_inverse; /* nq: M_ii, or a typical mass if there is none */
  const double *missing; /* nq: what `floor` adds to M_ii */
  const double *gravity; /* nq, N */
  double gravity_const; /* J: energy of gravity without its linear part */
  bool isotropic; /* see ali3_mass_isotropic */
  ali3_own_masses own; /* with payloads and armatures; empty if there are none */
} ali3_masses;

/* Copy of the System with the wheel axes that parameters set: with coefficients and moments of mass of its own. */
typedef struct {
  ali3_system *system;
  double *val, *constant, *entry, *mass, *speed;
  ali3_tabled *tabled;
} ali3_parametric_axes;

/* Roads, nr each. */
typedef struct {
  ali3_road *used; /* roads in use: own ones or from files */
  ali3_road *own; /* roads of the System */
  int32_t n; /* their number, as the System may be released before its instances */
} ali3_roads;

enum { ALI3_PLACED_BY_FILE = 0, ALI3_PLACED_BY_POSE, ALI3_PLACED_BY_Q };

/* Coordinates of the start, and its position relative to the road. */
typedef struct {
  int32_t initialised; /* the present state is consistent */
  int32_t placed; /* ALI3_PLACED_*: source of the coordinates */
  double *q; /* nq: coordinates of the start */
  double *pose_0, *pose_cos, *pose_sin; /* nq: q = pose_0 + cos(yaw) pose_cos + sin(yaw) pose_sin + translation */
  double pose[ALI3_POSE]; /* the pose set last */
  bool moved; /* `q` differs from the file */
  bool to_lift; /* the height of the road at the next start is unknown, so that the scene must be lifted onto it */
  double lift; /* m: height by which the start was raised */
  double uneven; /* m: largest height of a contact above its height at rest */
  double unsettled; /* m/s: largest remaining speed after the last settled start */
} ali3_start;
#endif
