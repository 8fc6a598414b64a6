/* Bodies and numbers that a table carries: dependent coordinates X of independent ones.
 * A body has four vectors, its place and its axes, X_0 = r + Y p and X_i = Y R_i, where r and the axes Y are those of its
 * base and p, R_i functions of one or two parameters, coordinates too. A number is such a function alone. Elements and
 * sensors see X as coordinates behind those of the System: signals may have columns from nq on. Their forces go back by
 * B' with B = dX/dq. There are no rows. Inertia is summed over the bodies of a base (tabled_inertia.c). */
#ifndef ALI3_TABLED_H
#define ALI3_TABLED_H
#include "../algebra/real.h"
#include "../instance.h"

enum { ALI3_TABLED_BODY = 12, ALI3_TABLED_COLUMNS = 14, ALI3_TABLED_MOMENTS = 10, ALI3_TABLED_VALUES = 6 };
enum { ALI3_TABLED_ITEMS = 4, ALI3_TABLED_MOST = 72, ALI3_TABLED_SIGNALS = 32 }; /* of a group; coordinates */
/* of a group that has parts; each is as many as its others have room for */
enum { ALI3_TABLED_VECTORS = 6, ALI3_TABLED_NUMBERS = 4, ALI3_TABLED_SINGLES = 8 };
enum { ALI3_TABLED_COMPONENT = INT8_MIN }; /* another one of a vector than the first */
enum { ALI3_BY_A = 1, ALI3_BY_B, ALI3_BY_AA, ALI3_BY_AB, ALI3_BY_BB }; /* of ali3_tabled_work.value */

struct ali3_tabled {
  int32_t n;                         /* functions: 12 of a body, 1 of a number */
  int32_t count[2];                  /* control points along each parameter; 1: there is no second one */
  int32_t first;                     /* its first dependent */
  int32_t front;                     /* of a body: that has all its coordinates */
  int32_t loc[ALI3_TABLED_COLUMNS]; /* places there of r, Y and the parameters; -1: the earth, no second parameter */
  int32_t base, along[2];           /* of a body: its base, and its parameters among those of the base */
  int32_t n_seen, seen[4];          /* vectors that signals of elements have */
  const int32_t *frame, *param;      /* coordinates of r and Y, of the parameters; -1 likewise */
  const double *axis, *coef, *mass, *gravity;
};

/* Bodies with the same r, Y and gravity. */
struct ali3_tabled_base {
  int32_t front, loc[ALI3_TABLED_BODY]; /* as those of its bodies */
  int32_t at[ALI3_TABLED_BODY][ALI3_TABLED_BODY]; /* where F has the entries between them */
  int32_t first, end;                   /* its parameters */
  const int32_t *frame;                 /* frame[0] = -1: the earth */
  const double *gravity;
};

struct ali3_tabled_parameter {
  int32_t column;               /* the coordinate */
  int32_t at[ALI3_TABLED_BODY]; /* where F has the entries between it and the base */
};

typedef struct {
  uint8_t n, at[ALI3_TABLED_VECTORS];
} ali3_tabled_list;

/* Elements of one front with signals of the same dependents. */
struct ali3_tabled_group {
  int32_t front, first, end;          /* elements: tabled_order[first .. end) */
  int32_t m, loc[ALI3_TABLED_MOST]; /* coordinates of all of them, their places in the front, ascending */
  int32_t n_item, item[ALI3_TABLED_ITEMS], slot[ALI3_TABLED_ITEMS][ALI3_TABLED_COLUMNS]; /* of an item's coordinates */
  int32_t n_signal, signal[ALI3_TABLED_SIGNALS]; /* of all of them */
  int32_t entry[ALI3_TABLED_SIGNALS], n_entry[ALI3_TABLED_SIGNALS]; /* of a signal, as one of its elements has them */
  /* Parts, if its signals are vectors of bodies on one base and numbers: with d(vector) = sum of a share of each of r
   * and Y + a vector for each single coordinate, a square of three by three is moved by four shares. */
  bool parted;
  int32_t base; /* -1: none, or the earth */
  int32_t n_vector, n_number, n_along, n_single; /* of the single coordinates so many move vectors: the first */
  int32_t vector[ALI3_TABLED_VECTORS], number[ALI3_TABLED_NUMBERS]; /* signals: the first component, the number */
  int8_t part[ALI3_TABLED_SIGNALS]; /* of a signal: its vector, if it is the first component; -1 - its number */
  bool place[ALI3_TABLED_VECTORS]; /* whether r moves it */
  ali3_tabled_list beside[ALI3_TABLED_VECTORS]; /* vectors with which it shares an element */
  int8_t axis[ALI3_TABLED_MOST]; /* of a coordinate: which of r and Y it is of, else its number among the singles */
  /* where F has the entries between singles and r and Y, and among singles */
  int32_t to_base[ALI3_TABLED_SINGLES][ALI3_TABLED_BODY], to_single[ALI3_TABLED_SINGLES][ALI3_TABLED_SINGLES];
  int8_t along[ALI3_TABLED_ITEMS][2]; /* of the parameters of an item: their numbers among the singles */
};

/* B and S B of the parts of a group, sums of the tangents of its elements. */
typedef struct {
  real base[4][4][9]; /* sums over the groups of a base */
  real share[ALI3_TABLED_VECTORS][4], along[ALI3_TABLED_VECTORS][ALI3_TABLED_SINGLES][3];
  real slope[ALI3_TABLED_NUMBERS][ALI3_TABLED_SINGLES];
  real vectors[ALI3_TABLED_VECTORS][ALI3_TABLED_VECTORS][9], mixed[ALI3_TABLED_NUMBERS][ALI3_TABLED_VECTORS][3];
  real numbers[ALI3_TABLED_NUMBERS][ALI3_TABLED_NUMBERS];
  real by_share[ALI3_TABLED_VECTORS][4][9], by_single[ALI3_TABLED_VECTORS][ALI3_TABLED_SINGLES][3];
  real number_by_single[ALI3_TABLED_NUMBERS][ALI3_TABLED_SINGLES];
} ali3_tabled_parts;

struct ali3_tabled_work { /* what ali3_tabled_prepare leaves of an item; its members are numbers of each lane */
  real value[ALI3_TABLED_VALUES][ALI3_TABLED_BODY]; /* functions, their derivatives by a, b, aa, ab, bb */
  real by[2][ALI3_TABLED_BODY]; /* dX/da, dX/db, of vectors that are seen */
  real inertia[3], twist[3]; /* T_p J T_q of the parameters aa, ab, bb; of T_a J T_b' (2 3), ... */
  real force[ALI3_TABLED_BODY]; /* of elements on X, of the last ali3_tabled_forces */
};

struct ali3_tabled_base_work {
  real axes[9], weight[3]; /* Y; gravity along it, of ali3_tabled_tangent */
  real mass[4][4]; /* sum of T J T' */
  real force[12]; /* scratch */
};

struct ali3_tabled_parameter_work {
  real own[12], turned[12]; /* sum of T J dT'/dp along Y, along the axes of the earth */
};

ALI3_PER_WIDTH void ali3_tabled_table(const ali3_system *S, const ali3_tabled *c, real a, real b,
                                      real value[ALI3_TABLED_VALUES][ALI3_TABLED_BODY]);
ALI3_PER_WIDTH void ali3_tabled_prepare(const ali3_instance *in, const real *q);
/* in->tabled.extended[0 .. 2]: q, qd, qdd (NULL: left) with the dependents behind them, all or those that elements see;
 * prepared at q. */
ALI3_PER_WIDTH void ali3_tabled_extend(const ali3_instance *in, const real *q, const real *qd, const real *qdd,
                                       bool all);
/* X of a change D of coordinates that ends where was prepared, behind D in in->tabled.extended[0]: to second order, of
 * vectors that elements see. */
ALI3_PER_WIDTH void ali3_tabled_way(const ali3_instance *in, const real *D);
/* Q of the forces on coordinates and dependents in in->tabled.force, with weight and inertia. */
ALI3_PER_WIDTH void ali3_tabled_forces(ali3_instance *in, const real *qd, real *Q);

static inline bool ali3_tabled_heavy(const ali3_tabled *c) { return c->n == ALI3_TABLED_BODY && c->mass[0] > 0.0; }
/* out (3) = Y t. */
static inline void ali3_tabled_turn(const real *restrict Y, const real *restrict t, real *restrict out) {
  for (int x = 0; x < 3; x++) out[x] = Y[x] * t[0] + Y[3 + x] * t[1] + Y[6 + x] * t[2];
}
/* Moments of a body times four vectors; `m`: mass, first (3), second xx, yy, zz, yz, zx, xy. */
ALI3_PER_WIDTH void ali3_tabled_moments(const double *m, const real *x, real *out);
ALI3_PER_WIDTH void ali3_tabled_add_inertia(const ali3_instance *in, const ali3_tabled *c, ali3_tabled_work *w);
ALI3_PER_WIDTH void ali3_tabled_mass_times(const ali3_instance *in, const real *x, real *out);
/* Adds weight and -B' M_X Bd qd to Q. */
ALI3_PER_WIDTH void ali3_tabled_inertia_forces(const ali3_instance *in, const real *qd, real *Q);
double ali3_tabled_gravity(const ali3_instance *in, const double *q);
/* Adds what rates change in both energies beside M qdd and the constant weight. */
void ali3_tabled_power(const ali3_instance *in, const double *qd, double *kinetic, double *gravity);
ALI3_PER_WIDTH void ali3_tabled_tangent(const ali3_instance *in, double wM, double wK, real *F);
ALI3_PER_WIDTH void ali3_tabled_elements_tangent(ali3_instance *in, real *F);
#endif
