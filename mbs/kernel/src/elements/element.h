/* The interface every force element implements: one file per type, one description per file, one line in
 * element_types.h. Nothing else in the engine knows a type.
 * An element sees its affine signals u and their rates ud, never coordinates. It returns the generalised force f
 * conjugate to u, the symmetric part of its tangent wC*C + wK*K (C = -df/dud, K = -df/du, states condensed), and the
 * slots of its state at the end of the step. */
#ifndef ALI3_ELEMENT_H
#define ALI3_ELEMENT_H
#include <stdbool.h>
#include <stdint.h>

#include "../algebra/real.h"
#include "element_types.h"

ALI3_BRANCHES_AS_WRITTEN

#define ALI3_MAX_SIGNALS 24    /* per element */

typedef struct ali3_road ali3_road; /* road.h */

typedef struct {
  int32_t nsig, nreal, nint, nstate, nout; /* numbers of signals, reals, integers, states and outputs */
  const real *u, *ud;            /* signals and rates at the iterate (end of the step) */
  const real *y_old;             /* slots at the start of the step */
  real *y_new;                   /* slots at the end, always written completely */
  double h;                      /* step; 0: evaluate at y_old (y_new = y_old, its rates those that follow) */
  real reach;                    /* bound of the change of rates from ud in this step; 0: unknown */
  double wC, wK;                 /* weights of the tangent: h/2 and h^2/4 in a step, 0 and h^2/4 in statics */
  const real *real;              /* nreal: its data, by *_fields.h of its type */
  const int32_t *integer;        /* nint: likewise */
  const real *input;             /* nu: all inputs of the System */
  const ali3_road *roads;        /* nr: all roads of the instance */
  real *f;                       /* nsig: power is f . ud; zeroed by the caller */
  real *S;                       /* nsig x nsig, row major, symmetric, zeroed by the caller; NULL when not wanted */
  real *out;                     /* nout element outputs, always written */
  real potential;                /* stored energy, J, written */
  int32_t idle;                  /* 0; set to 1 by an element whose f and S are zero */
  /* 0; set to what tells the smooth pieces of the law apart: a stop is met, friction slips, a limit is reached */
  uint32_t piece;
} ali3_element_args;

typedef void ali3_element_function(ali3_element_args *a);

/* Verdict of an element on a start. */
typedef struct {
  double excess; /* above 0: the start is refused; the element with the largest value is named */
  double rise;   /* above 0: least height by which the scene must be raised so that the element accepts it, m */
  double pressed; /* above 0: depth of a rim in the road beyond what the wheel can carry, m */
} ali3_start_verdict;

/* Allowed range of a number of an element, and the sentence for one outside; the tables are generated from the classes
 * in Python, see *_fields.h. */
typedef enum { ALI3_IS_ANY, ALI3_IS_NOT_NEGATIVE, ALI3_IS_POSITIVE, ALI3_IS_SHARE, ALI3_IS_FRACTION } ali3_range;
typedef struct {
  ali3_range range; /* of finite numbers: any; x >= 0; x > 0; 0 < x <= 1; 0 <= x < 1 */
  const char *text; /* sentence without its full stop for a number outside */
} ali3_field;

/* Allowed range of an integer: not below 0 or `least`, and not above `most` or the last index of the list it refers
 * to. */
typedef enum { ALI3_OF_NUMBERS, ALI3_OF_INPUTS, ALI3_OF_ROADS } ali3_numbered;
typedef struct {
  ali3_numbered of; /* the integer is a number, or the index of an input or a road */
  int32_t least, most;
  int32_t reals, states; /* of a count: reals and states for each counted item */
  const char *text; /* sentence without its full stop for an integer outside */
} ali3_integer;

enum { ALI3_TABLE_LENGTH = 0, ALI3_TABLE_RATE = 2 }; /* outputs of springs by a table */

/* A type of elements. Members that an initialiser does not name are 0 or NULL: the property does not hold, or there is
 * no such function. */
typedef struct ali3_element_type {
  ali3_element_function *evaluate; /* forces, tangent, states, outputs and potential at an iterate */
  /* Forces over a step by a discrete gradient, for elements whose potential is not quadratic in their signals:
   * f . (u1 - u0) = -(V(u1) - V(u0)) minus the dissipation of dampers, exactly. It is called at the middle of the step,
   * u, with ud = (u1 - u0) / (2 h), its h being half a step. NULL: `evaluate` is exact or accurate enough there. */
  ali3_element_function *discrete;
  ali3_element_function *accept; /* once per accepted step, and with h = 0 at a start: discrete changes in y_new */
  /* Of springs with end stops, whose first outputs are length and force: whether the length is beyond a stop. */
  bool (*stops)(const double *real, const double *out);
  /* Of the same springs: fraction of a step of size h at which the first stop with a kink is met or left, from the
   * outputs at the start and the end of the step; 1: none is. */
  double (*event)(const double *real, int32_t nreal, const double *from, const double *to, double h);
  /* Of springs by a table, whose outputs are length, force and rate: fraction of the way between two lengths, m, to the
   * first row that the cubic through values and slopes at both ends misses by more than `share` of the largest force
   * and of `largest`, N; 1: no row. */
  double (*resolved)(const double *real, const int32_t *integer, double from, double to, double share, double largest);
  bool conservative; /* a potential, or a force of inputs alone: composed steps of order four accept it */
  /* Whether a conservative element dissipates energy with these data. */
  bool (*lossy)(const double *real, int32_t nreal, const int32_t *integer);
  /* Verdict on a start, from u, real, integer and roads, with the scene raised by `raised`, m; and the sentence for a
   * refusal, which follows the name of the element. */
  ali3_start_verdict (*start)(const ali3_element_args *a, double raised);
  const char *start_words; /* NULL: no start is refused */
  /* Depth of the element in its road with the scene raised by `raised`, m; < 0: above it. From u, real, integer and
   * roads; *part: fraction of the depth by which the scene can be raised without passing depth 0. */
  double (*depth)(const ali3_element_args *a, double raised, double *part);
  /* Sizes without the items that its integers count; -1: any. nint is the number of required integers, of all in
   * `integers`. With an optional one, or if there are none, nreal_more reals and nstate_more states may follow. */
  int32_t nsig, nreal, nint, nstate, nout;
  /* Of each type with `depth` or `stops`: its outputs that are forces, N. */
  int32_t first_force, n_forces;
  int32_t nsig_plane; /* number of signals in the plane, if it differs from that in space; 0: it does not */
  int32_t nreal_more, nstate_more; /* optional reals and states, which are there all or not at all */
  const ali3_field *fields; /* ranges of its reals: the first ones, then the last nreal_more */
  int32_t nfields;
  const ali3_integer *integers; /* ranges of its integers, the optional ones last */
  int32_t nintegers;
  /* NULL or one sentence for bad data that the ranges of `fields` do not exclude. */
  const char *(*check)(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint);
} ali3_element_type;

/* Whether the sizes of an element agree with its type, in space or in the plane. */
bool ali3_element_fits(const ali3_element_type *type, int32_t nsig, int32_t nreal, const int32_t *integer, int32_t nint,
                       int32_t nstate, int32_t nout);

/* NULL or one sentence for bad data: first by the declared ranges of reals and integers, then by the check of the
 * type. */
const char *ali3_element_check(const ali3_element_type *type, int32_t nsig, const double *real, int32_t nreal,
                               const int32_t *integer, int32_t nint, int32_t n_inputs, int32_t n_roads);

#define ALI3_DECLARE(number, name) extern const ali3_element_type ali3_##name;
ALI3_ELEMENT_TYPES(ALI3_DECLARE)
#undef ALI3_DECLARE

const ali3_element_type *ali3_element_type_get(int32_t type); /* NULL if unknown; table in elements.c */
#endif
