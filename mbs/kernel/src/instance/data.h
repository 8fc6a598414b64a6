/* What an instance is set to: inputs, parameters and what follows from them, the start. */
#ifndef ALI3_INSTANCE_DATA_H
#define ALI3_INSTANCE_DATA_H
#include "../system.h"

typedef struct ali3_road ali3_road; /* elements/road.h */

/* Inputs over a step, nu each. A whole step is what a caller asks for; it may be made in parts. */
typedef struct {
  double *set;           /* as set, clamped to their ranges */
  double *work, *middle; /* scratch; in the middle of a step */
  const double *forces;  /* those that elements read: set, or middle where the middle is evaluated */
  double *from, *to;     /* at the start and the end of the whole step */
  double *begin;         /* at the start of the present part */
  double *stage;         /* ALI3_RADAU x nu: at the stages of radau.c */
  double whole_time, whole_length; /* s: start and length of the whole step */
  double part_time, part_length;   /* s: of the present part */
  ali3_input_function *function; /* of the caller, or NULL; its context; the control of its processor, 0: the same */
  void *context;
  ali3_float_control host_control;
  const double *breaks; /* n_breaks, s: times at which steps are divided, ascending */
  int64_t n_breaks;
} ali3_inputs;

/* Parameters, and arrays of the System that they write to: copies, by the names of the System. */
typedef struct {
  double *value, *work; /* np: as set; scratch */
  double *el_real, *guide_real, *road_real, *sen_real, *inertia_real, *axis_real;
  double *payload_mass, *armature_ratio, *switch_on;
} ali3_parameters;

typedef struct {
  double *val, *front, *floor, *floor_inverse, *missing, *gravity;
} ali3_own_masses;

/* Masses and gravity: those of the System, or `own` where parameters change them. */
typedef struct {
  const double *val, *front; /* nnz_mass; front_size, the start of every tangent: the mass matrix */
  const double *floor, *floor_inverse; /* nq: M_ii, or a typical mass where there is none */
  const double *missing; /* nq: what `floor` adds to M_ii */
  const double *gravity; /* nq, N */
  double gravity_const; /* J: energy of gravity without its linear part */
  bool isotropic; /* see ali3_mass_isotropic */
  ali3_own_masses own; /* with payloads and armatures; empty where there are none */
} ali3_masses;

/* The System turned to the axes that parameters write: with coefficients and moments of mass of its own. */
typedef struct {
  ali3_system *system;
  double *val, *constant, *entry, *mass, *speed;
  ali3_tabled *tabled;
} ali3_parametric_axes;

/* Roads, nr each. */
typedef struct {
  ali3_road *used, *own; /* in use: the System's own or from files; the System's own */
  int32_t n; /* the System may be gone before its instances */
} ali3_roads;

enum { ALI3_PLACED_BY_FILE = 0, ALI3_PLACED_BY_POSE, ALI3_PLACED_BY_Q };

/* Where a start is, and how it comes to the road. */
typedef struct {
  int32_t initialised; /* the present state is consistent */
  int32_t placed; /* ALI3_PLACED_*: who placed it */
  double *q; /* nq: where a start is */
  double *pose_0, *pose_cos, *pose_sin; /* nq: q = pose_0 + cos(yaw) pose_cos + sin(yaw) pose_sin + translation */
  double pose[ALI3_POSE]; /* the last one */
  bool moved; /* `q` is not that of the file */
  bool to_lift; /* the next start is at a place of which it is not known how high its road is */
  double lift; /* m: what raised the start */
  double uneven; /* m: how far above its rest the highest part is */
  double unsettled; /* m/s: what the last settled start had left */
} ali3_start;
#endif
