/* The interface every force element implements: one file per type, one function per file.
 * An element sees its affine signals u and their rates ud, never coordinates. It returns the generalised force f
 * conjugate to u, the symmetric part of its tangent wC*C + wK*K (C = -df/dud, K = -df/du, states condensed), and the
 * slots of its state at the end of the step. */
#ifndef ALI3_ELEMENT_H
#define ALI3_ELEMENT_H
#include <stddef.h>
#include <stdint.h>

enum { /* element types; the numbers are part of the file format and equal mbs/elements/types.py */
       ALI3_SPRING_DAMPER = 1,      /* two points */
       ALI3_SCALAR_SPRING_DAMPER,   /* one signal: torsional, or along a coordinate */
       ALI3_INPUT_FORCE,            /* one input times constant weights on its signals */
       ALI3_BODY_FORCE,             /* inputs along body axes at a point */
       ALI3_BODY_TORQUE,            /* inputs as a torque, earth or body axes */
       ALI3_GYROSCOPIC_SPIN,        /* axisymmetric wheel on a carrier */
       ALI3_DRAG,                   /* quadratic aerodynamic drag */
       ALI3_TYRE,
       ALI3_BRAKE,                  /* elastoplastic friction between a spin and its carrier */
       ALI3_AUTOMATIC_DRIVE,        /* engine, converter, gears, open differential */
       ALI3_CONTACT_POINTS,         /* points of a body on a road */
       ALI3_SPIN_TORQUE,            /* an input between a spin and its carrier */
       ALI3_ELEMENT_TYPE_END
};

#define ALI3_MAX_SIGNALS 24    /* per element */

typedef struct ali3_road ali3_road; /* road.h */

typedef struct {
  int32_t nsig, nreal, nint, nstate, nout;
  const double *u, *ud;          /* signals and rates at the iterate (end of the step) */
  const double *y_old;           /* slots at the start of the step */
  double *y_new;                 /* slots at the end, always written completely */
  double h;                      /* step; 0: evaluate at y_old (y_new = y_old) */
  double wC, wK;                 /* weights of the tangent: h/2 and h^2/4 in a step, 0 and h^2/4 in statics */
  const double *real;
  const int32_t *integer;
  const double *input;           /* all inputs of the System */
  const ali3_road *roads;
  double *f;                     /* nsig, zeroed by the caller */
  double *S;                     /* nsig x nsig, row major, symmetric, zeroed by the caller; NULL when not wanted */
  double *out;                   /* nout element outputs, always written */
  double potential;              /* stored energy, J, written */
  int32_t idle;                  /* 0; set to 1 by an element whose f and S are zero */
} ali3_element_args;

typedef void ali3_element_function(ali3_element_args *a);
typedef void ali3_element_accept_function(
    ali3_element_args *a); /* once per accepted step, and with h = 0 at a start: discrete changes in y_new */

typedef struct ali3_element_type {
  ali3_element_function *evaluate;
  ali3_element_accept_function *accept;  /* may be NULL */
  /* sizes that the loader checks; -1: any; nstate = -k, k > 1: k for each of the items that the last integer counts.
   * check (may be NULL) returns NULL or one sentence for bad data. */
  int32_t nsig, nreal, nint, nstate, nout;
  const char *(*check)(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint,
                       int32_t n_inputs, int32_t n_roads);
} ali3_element_type;

const ali3_element_type *ali3_element_type_get(int32_t type); /* NULL if unknown; table in elements.c */
#endif
