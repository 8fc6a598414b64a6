/* Work memory of force elements, flexible bodies and lookup-table bodies. */
#ifndef ALI3_INSTANCE_ELEMENTS_H
#define ALI3_INSTANCE_ELEMENTS_H

typedef struct ali3_lookup_work ali3_lookup_work; /* lookup/lookup.h */
typedef struct ali3_lookup_base_work ali3_lookup_base_work;
typedef struct ali3_lookup_parameter_work ali3_lookup_parameter_work;

/* Force elements. Signals and what is conjugate to them have the units of their type, see ../elements/element.h. */
typedef struct {
  double *u, *ud;       /* nsig: signals and their rates */
  double *force;        /* as el_sig: generalised forces on the signals of each element, of the last ali3_forces */
  double *S;            /* by el_S_off: signal tangents wC C + wK K of all elements */
  double wC, wK;        /* weights of the last forces, s and s^2 as in ali3_element_args */
  double *SB;           /* product of S of one element and its signals' derivatives: signals x coordinates */
  unsigned char *idle;  /* ne: 1 where force and tangent were zero in the last ali3_forces */
  double *S_made, *ud_at; /* of defect_correction.c: S of the tangent in F; ud of the last ali3_forces */
  double *y, *out, *potential; /* ny, nout, ne: for calls that do not store these results */
} ali3_element_work;

/* Flexible bodies. */
typedef struct {
  double *prepared; /* at the last q prepared: what ../flexible/body_arrays.h lays out, body by body */
  double *work;     /* 3 x max_modes: scratch */
} ali3_flexible_work;

/* Lookup-table bodies at the last q prepared. */
typedef struct {
  ali3_lookup_work *item;                /* n_lookup */
  ali3_lookup_base_work *base;           /* n_lookup_base */
  ali3_lookup_parameter_work *parameter; /* n_lookup_parameter */
  double *square;                        /* lookup_square: tangent of one group of elements */
  double *extended[3], *force;           /* q, qd, qdd and forces (nq), each followed by those of the dependents */
} ali3_lookup_memory;

/* Elements whose work sensors read, see ../state/work.c. */
typedef struct {
  double *now;    /* n_work + n_work_force: power, W, and generalised forces of the last ali3_forces */
  double *sum;    /* n_work, J: weighted sum of the powers at the stages of a step */
  double *stages; /* ALI3_RADAU x n_work, W: power at the stages */
} ali3_watch;
#endif
