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
  int32_t nsig, nreal, nint, nstate, nout;
  const real *u, *ud;            /* signals and rates at the iterate (end of the step) */
  const real *y_old;             /* slots at the start of the step */
  real *y_new;                   /* slots at the end, always written completely */
  double h;                      /* step; 0: evaluate at y_old (y_new = y_old, its rates those that follow) */
  real reach;                    /* how far rates may still go from ud in this step; 0: it is not known */
  double wC, wK;                 /* weights of the tangent: h/2 and h^2/4 in a step, 0 and h^2/4 in statics */
  const real *real;
  const int32_t *integer;
  const real *input;             /* all inputs of the System */
  const ali3_road *roads;
  real *f;                       /* nsig, zeroed by the caller */
  real *S;                       /* nsig x nsig, row major, symmetric, zeroed by the caller; NULL when not wanted */
  real *out;                     /* nout element outputs, always written */
  real potential;                /* stored energy, J, written */
  int32_t idle;                  /* 0; set to 1 by an element whose f and S are zero */
  /* 0; set to what tells the smooth pieces of the law apart: a stop is met, friction slips, a limit is reached */
  uint32_t piece;
} ali3_element_args;

typedef void ali3_element_function(ali3_element_args *a);

/* What an element says of a start. */
typedef struct {
  double excess; /* above 0: no scene is meant to start like this; of two elements the larger one is named */
  double rise;   /* above 0: the height, m, by which the scene must rise at least to be out of the element's way */
  double pressed; /* above 0: how much deeper than a wheel holds its rim is in the road, m */
} ali3_start_verdict;

/* What a number of an element must be, and the sentence for one that is not; the tables are written from the classes in
 * Python, see *_fields.h. */
typedef enum { ALI3_IS_ANY, ALI3_IS_NOT_NEGATIVE, ALI3_IS_POSITIVE, ALI3_IS_SHARE, ALI3_IS_FRACTION } ali3_range;
typedef struct {
  ali3_range range;
  const char *text;
} ali3_field;

/* The same of an integer: below 0 or `least`, or above `most` or the last of what it is a number of. */
typedef enum { ALI3_OF_NUMBERS, ALI3_OF_INPUTS, ALI3_OF_ROADS } ali3_numbered;
typedef struct {
  ali3_numbered of;
  int32_t least, most;
  int32_t reals, states; /* of each that it counts */
  const char *text;
} ali3_integer;

/* What a type of elements is; what is not named is 0 or NULL: not so, or none. */
typedef struct ali3_element_type {
  ali3_element_function *evaluate;
  /* Forces over a step by a discrete gradient, for elements whose potential is not quadratic in their signals:
   * f . (u1 - u0) = -(V(u1) - V(u0)) minus what dampers take, exactly. It sees the middle of the step, u, and
   * ud = (u1 - u0) / (2 h), its h being half a step. NULL: evaluate is exact there, or as good. */
  ali3_element_function *discrete;
  ali3_element_function *accept; /* once per accepted step, and with h = 0 at a start: discrete changes in y_new */
  /* Springs with end stops, whose first outputs are length and force: whether these lie beyond one. */
  bool (*stops)(const double *real, const double *out);
  /* Of these: the share of a step of size h at which the first of those with a kink is met or left, from
   * the outputs at its start and at its end; 1: none is. */
  double (*event)(const double *real, int32_t nreal, const double *from, const double *to, double h);
  bool conservative; /* a potential, or a force of inputs alone: steps of order four may be composed of it */
  /* whether a conservative element takes energy with these data */
  bool (*lossy)(const double *real, int32_t nreal, const int32_t *integer);
  /* Verdict on a start, from u, real, integer and roads, with the scene raised by `raised`, m; and its words, after the
   * element's name. */
  ali3_start_verdict (*start)(const ali3_element_args *a, double raised);
  const char *start_words;
  /* How deep the element is in its road with the scene raised by `raised`, m; < 0: above it. From u, real, integer and
   * roads; *part: raising the scene by this share of the depth brings it towards 0 and not beyond. */
  double (*depth)(const ali3_element_args *a, double raised, double *part);
  /* Sizes without what its integers count; -1: any. nint are the integers that must be there, of all that `integers`
   * has. With one of the others, or where there are none, nreal_more and nstate_more may follow. */
  int32_t nsig, nreal, nint, nstate, nout;
  int32_t nsig_plane; /* of an element in the plane, where they are others; 0: they are not */
  int32_t nreal_more, nstate_more;
  const ali3_field *fields; /* what its numbers must be: the first ones, then the last nreal_more */
  int32_t nfields;
  const ali3_integer *integers;
  int32_t nintegers;
  /* NULL or one sentence for bad data that the fields do not say */
  const char *(*check)(int32_t nsig, const double *real, int32_t nreal, const int32_t *integer, int32_t nint);
} ali3_element_type;

/* Whether the sizes of an element are those of its type; its signals may be in space or in the plane. */
bool ali3_element_fits(const ali3_element_type *type, int32_t nsig, int32_t nreal, const int32_t *integer, int32_t nint,
                       int32_t nstate, int32_t nout);

/* NULL or one sentence for bad data: by the declared numbers and integers, then by the type's own check. */
const char *ali3_element_check(const ali3_element_type *type, int32_t nsig, const double *real, int32_t nreal,
                               const int32_t *integer, int32_t nint, int32_t n_inputs, int32_t n_roads);

#define ALI3_DECLARE(number, name) extern const ali3_element_type ali3_##name;
ALI3_ELEMENT_TYPES(ALI3_DECLARE)
#undef ALI3_DECLARE

const ali3_element_type *ali3_element_type_get(int32_t type); /* NULL if unknown; table in elements.c */
#endif
