/* Bodies and numbers by tables: dependent coordinates X of independent ones.
 * A body has four vectors, its position and its axes, X_0 = r + Y p and X_i = Y R_i: r and the axes Y are those of
 * its base, p and R_i functions of one or two parameters, which are coordinates too. A number is a single such
 * function. For elements and sensors X extend the coordinates of the System: signals may have columns nq and above.
 * Their forces are transformed by B' with B = dX/dq, without rows. Inertia is summed over the bodies of a base
 * (lookup_inertia.c). */
#ifndef ALI3_LOOKUP_H
#define ALI3_LOOKUP_H
#include "../algebra/real.h"
#include "../instance.h"

enum { ALI3_LOOKUP_BODY = 12, ALI3_LOOKUP_COLUMNS = 14, ALI3_LOOKUP_MOMENTS = 10, ALI3_LOOKUP_VALUES = 6 };
/* Capacities of a group: items, coordinates, signals. */
enum { ALI3_LOOKUP_ITEMS = 4, ALI3_LOOKUP_MOST = 72, ALI3_LOOKUP_SIGNALS = 32 };
/* capacities of a group with parts */
enum { ALI3_LOOKUP_VECTORS = 6, ALI3_LOOKUP_NUMBERS = 4, ALI3_LOOKUP_SINGLES = 8 };
enum { ALI3_LOOKUP_COMPONENT = INT8_MIN }; /* marks the second and third component of a vector */
enum { ALI3_BY_A = 1, ALI3_BY_B, ALI3_BY_AA, ALI3_BY_AB, ALI3_BY_BB }; /* indices into ali3_lookup_work.value */

struct ali3_lookup {
  int32_t n;                         /* functions: 12 of a body, 1 of a number */
  int32_t count[2];                  /* control points along each parameter; 1: there is no second one */
  int32_t first;                     /* index of its first dependent */
  int32_t front;                     /* front that contains all its coordinates */
  /* local indices there of r, Y and the parameters; -1: the earth, no second parameter */
  int32_t loc[ALI3_LOOKUP_COLUMNS];
  int32_t base, along[2];           /* base of a body, and indices of its parameters in the base */
  int32_t n_seen, seen[4];          /* vectors on which signals of elements depend */
  const int32_t *frame, *param;      /* coordinates of r and Y, of the parameters; -1 likewise */
  const double *axis, *coef, *mass, *gravity; /* of tabled_axis, tabled_coef, tabled_mass, tabled_gravity */
};

/* Bodies with the same r, Y and gravity. */
struct ali3_lookup_base {
  int32_t front, loc[ALI3_LOOKUP_BODY]; /* as those of its bodies */
  int32_t at[ALI3_LOOKUP_BODY][ALI3_LOOKUP_BODY]; /* indices into F of the entries between them */
  int32_t first, end;                   /* range of its parameters in lookup_parameter */
  const int32_t *frame;                 /* coordinates of r and Y; frame[0] = -1: the earth */
  const double *gravity;                /* 3, m/s^2, earth axes */
};

/* A parameter of the tables of bodies on one base. */
struct ali3_lookup_parameter {
  int32_t column;               /* the coordinate */
  int32_t at[ALI3_LOOKUP_BODY]; /* indices into F of the entries between it and the base */
};

typedef struct { /* a list of vectors of a group */
  uint8_t n, at[ALI3_LOOKUP_VECTORS]; /* length, indices */
} ali3_lookup_list;

/* Elements of one front with signals of the same dependents. */
struct ali3_lookup_group {
  int32_t front, first, end;          /* elements: lookup_order[first .. end) */
  int32_t m, loc[ALI3_LOOKUP_MOST]; /* local indices in the front of all their coordinates, ascending */
  /* slot: index in loc of each coordinate of an item */
  int32_t n_item, item[ALI3_LOOKUP_ITEMS], slot[ALI3_LOOKUP_ITEMS][ALI3_LOOKUP_COLUMNS];
  int32_t n_signal, signal[ALI3_LOOKUP_SIGNALS]; /* signals of all elements */
  /* entries of a signal, stored with one of its elements */
  int32_t entry[ALI3_LOOKUP_SIGNALS], n_entry[ALI3_LOOKUP_SIGNALS];
  /* Parts, if its signals are vectors of bodies on one base and numbers: as d(vector) is a sum of a share of each of r
   * and Y and of a vector per single coordinate, a 3 x 3 square is transformed by four shares. */
  bool parted;
  int32_t base; /* -1: none, or the earth */
  int32_t n_vector, n_number, n_along, n_single; /* n_along: the first single coordinates, which move vectors */
  /* signal of the first component of a vector, signal of a number */
  int32_t vector[ALI3_LOOKUP_VECTORS], number[ALI3_LOOKUP_NUMBERS];
  int8_t part[ALI3_LOOKUP_SIGNALS]; /* of a signal that is a first component: its vector; of a number: -1 - its index */
  bool place[ALI3_LOOKUP_VECTORS]; /* whether a vector is a point and depends on r */
  ali3_lookup_list beside[ALI3_LOOKUP_VECTORS]; /* vectors with which it shares an element */
  /* of a coordinate: index of r or of the axis of Y, or index among the single coordinates */
  int8_t axis[ALI3_LOOKUP_MOST];
  /* indices into F of the entries between single coordinates and r, Y, and among single coordinates */
  int32_t to_base[ALI3_LOOKUP_SINGLES][ALI3_LOOKUP_BODY], to_single[ALI3_LOOKUP_SINGLES][ALI3_LOOKUP_SINGLES];
  int8_t along[ALI3_LOOKUP_ITEMS][2]; /* indices of the parameters of an item among the single coordinates */
};

/* B and S B of the parts of a group, and sums of the tangents of its elements; 3 x 3 matrices are row major. */
typedef struct {
  real base[4][4][9]; /* B' S B between r (0) and the axes of Y (1 to 3), sum over the groups of a base */
  /* B: of each vector its share of r and of the axes of Y, its derivative by each single coordinate; of each number its
   * derivative by each single coordinate */
  real share[ALI3_LOOKUP_VECTORS][4], along[ALI3_LOOKUP_VECTORS][ALI3_LOOKUP_SINGLES][3];
  real slope[ALI3_LOOKUP_NUMBERS][ALI3_LOOKUP_SINGLES];
  /* S: sums of the tangents of the elements between two vectors, a number and a vector, two numbers */
  real vectors[ALI3_LOOKUP_VECTORS][ALI3_LOOKUP_VECTORS][9], mixed[ALI3_LOOKUP_NUMBERS][ALI3_LOOKUP_VECTORS][3];
  real numbers[ALI3_LOOKUP_NUMBERS][ALI3_LOOKUP_NUMBERS];
  /* S B: rows of a vector by r and Y, by the single coordinates; rows of a number by the single coordinates */
  real by_share[ALI3_LOOKUP_VECTORS][4][9], by_single[ALI3_LOOKUP_VECTORS][ALI3_LOOKUP_SINGLES][3];
  real number_by_single[ALI3_LOOKUP_NUMBERS][ALI3_LOOKUP_SINGLES];
} ali3_lookup_parts;

struct ali3_lookup_work { /* quantities of an item from ali3_lookup_prepare, per lane */
  real value[ALI3_LOOKUP_VALUES][ALI3_LOOKUP_BODY]; /* functions, their derivatives by a, b, aa, ab, bb */
  real by[2][ALI3_LOOKUP_BODY]; /* dX/da, dX/db of the vectors with signals */
  real inertia[3], twist[3]; /* T_p J T_q of the parameters aa, ab, bb; of T_a J T_b' (2 3), ... */
  real force[ALI3_LOOKUP_BODY]; /* forces of elements on X, from the last ali3_lookup_forces */
};

struct ali3_lookup_base_work {
  real axes[9], weight[3]; /* Y; gravity along Y, set by ali3_lookup_tangent */
  real mass[4][4]; /* sum of T J T' */
  real force[12]; /* scratch */
};

struct ali3_lookup_parameter_work {
  real own[12], turned[12]; /* sum of T J dT'/dp along Y, along the axes of the earth */
};

/* Functions of an item at parameters a, b and their derivatives by a, b, aa, ab, bb. */
ALI3_PER_WIDTH void ali3_lookup_table(const ali3_system *S, const ali3_lookup *c, real a, real b,
                                      real value[ALI3_LOOKUP_VALUES][ALI3_LOOKUP_BODY]);
/* Evaluates all items at q (nq), and the inertia of the bodies; the other functions use the last q prepared. */
ALI3_PER_WIDTH void ali3_lookup_prepare(const ali3_instance *in, const real *q);
/* Writes q, qd, qdd (NULL: omitted), each followed by the dependents, to in->lookup.extended[0 .. 2]: all dependents,
 * or those with signals; after ali3_lookup_prepare at q. */
ALI3_PER_WIDTH void ali3_lookup_extend(const ali3_instance *in, const real *q, const real *qd, const real *qdd,
                                       bool all);
/* Writes D and the change of X by a change D of the coordinates that ends at the prepared position to
 * in->lookup.extended[0]; to second order, for vectors with signals. */
ALI3_PER_WIDTH void ali3_lookup_displacements(const ali3_instance *in, const real *D);
/* Computes Q from the forces on coordinates and dependents in in->lookup.force, with gravity and inertia forces. */
ALI3_PER_WIDTH void ali3_lookup_forces(ali3_instance *in, const real *qd, real *Q);

/* Whether an item is a body with mass. */
static inline bool ali3_lookup_heavy(const ali3_lookup *c) { return c->n == ALI3_LOOKUP_BODY && c->mass[0] > 0.0; }
/* out (3) = Y t. */
static inline void ali3_lookup_turn(const real *restrict Y, const real *restrict t, real *restrict out) {
  for (int x = 0; x < 3; x++) out[x] = Y[x] * t[0] + Y[3 + x] * t[1] + Y[6 + x] * t[2];
}
/* Moments of a body times four vectors; `m`: mass, first (3), second xx, yy, zz, yz, zx, xy. */
ALI3_PER_WIDTH void ali3_lookup_moments(const double *m, const real *x, real *out);
/* Adds the inertia of a body to its base and its parameters. */
ALI3_PER_WIDTH void ali3_lookup_add_inertia(const ali3_instance *in, const ali3_lookup *c, ali3_lookup_work *w);
/* out += B' M_X B x */
ALI3_PER_WIDTH void ali3_lookup_mass_times(const ali3_instance *in, const real *x, real *out);
/* Adds gravity and -B' M_X Bd qd to Q. */
ALI3_PER_WIDTH void ali3_lookup_inertia_forces(const ali3_instance *in, const real *qd, real *Q);
/* Potential energy of gravity, J, at the prepared q. */
double ali3_lookup_gravity(const ali3_instance *in, const double *q);
/* Adds the power of both energies beyond M qdd and constant gravity, W. */
void ali3_lookup_power(const ali3_instance *in, const double *qd, double *kinetic, double *gravity);
/* F += wM B' M_X B and wK times the geometric stiffness of gravity and of the forces of elements, lower triangles. */
ALI3_PER_WIDTH void ali3_lookup_tangent(const ali3_instance *in, double wM, double wK, real *F);
/* F += tangents of elements on dependents, transformed by B. */
ALI3_PER_WIDTH void ali3_lookup_elements_tangent(ali3_instance *in, real *F);
#endif
