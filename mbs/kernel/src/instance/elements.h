/* Work memory of force elements, flexible bodies and lookup-table bodies. */
#ifndef ALI3_INSTANCE_ELEMENTS_H
#define ALI3_INSTANCE_ELEMENTS_H

typedef struct ali3_tabled_work ali3_tabled_work; /* tabled/tabled.h */
typedef struct ali3_tabled_base_work ali3_tabled_base_work;
typedef struct ali3_tabled_parameter_work ali3_tabled_parameter_work;

typedef struct {
  double *u, *ud;       /* nsig: signals and their rates */
  double *force;        /* of the last ali3_forces, by the signals of each element */
  double *S;            /* signal tangents of all elements, wC C + wK K */
  double wC, wK;        /* weights of the last forces */
  double *SB;           /* one element: signals x coordinates */
  unsigned char *idle;  /* 1 where force and tangent were zero in the last ali3_forces */
  double *S_made, *ud_at; /* of defect_correction.c: S of the tangent in F; ud of the last ali3_forces */
  double *y, *out, *potential; /* ny, nout, ne: for calls that do not store these results */
} ali3_element_work;

typedef struct {
  double *prepared; /* at the last q prepared, see ../flexible/body_arrays.h */
  double *work;     /* 3 x max_modes: scratch */
} ali3_flexible_work;

/* Lookup-table bodies at the last q prepared. */
typedef struct {
  ali3_tabled_work *item;
  ali3_tabled_base_work *base;
  ali3_tabled_parameter_work *parameter;
  double *square;              /* of one group of elements */
  double *extended[3], *force; /* q, qd, qdd and forces, each followed by the values of dependents */
} ali3_tabled_memory;

/* Elements whose work sensors read, see ../state/work.c. */
typedef struct {
  double *now;    /* n_work + n_work_force: power, W, and forces of the last ali3_forces */
  double *sum;    /* n_work: of the stages of a step */
  double *stages; /* ALI3_RADAU x n_work: power at the stages */
} ali3_watch;
#endif
