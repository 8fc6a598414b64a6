/* Bodies and numbers that a table carries: dependent coordinates X of independent ones.
 * A body has four vectors, its place and its axes, X_0 = r + Y p and X_i = Y R_i, where r and the axes Y are those of its
 * base and p, R_i functions of one or two parameters, coordinates too. A number is such a function alone. Elements and
 * sensors see X as coordinates behind those of the System: signals may have columns from nq on. Their forces go back by
 * B' with B = dX/dq, and so does the inertia of a body: M = B' M_X B, Q_v = -B' M_X Bd qd. There are no rows. */
#ifndef ALI3_TABLED_H
#define ALI3_TABLED_H
#include "../instance.h"

enum { ALI3_TABLED_BODY = 12, ALI3_TABLED_COLUMNS = 14, ALI3_TABLED_MOMENTS = 10 };
enum { ALI3_TABLED_SIGNALS = 24, ALI3_TABLED_ITEMS = 4, ALI3_TABLED_MOST = 72 }; /* of one element; coordinates */

struct ali3_tabled {
  int32_t n;                         /* functions: 12 of a body, 1 of a number */
  int32_t count[2];                  /* control points along each parameter; 1: there is no second one */
  int32_t first;                     /* its first dependent */
  int32_t front;                     /* of a body: that has all its coordinates */
  int32_t loc[ALI3_TABLED_COLUMNS]; /* places there of r, Y and the parameters; -1: the earth, no second parameter */
  const int32_t *frame, *param;      /* coordinates of r and Y, of the parameters; -1 likewise */
  const double *axis, *coef, *mass, *gravity;
};

/* An element with signals of dependents. */
struct ali3_tabled_element {
  int32_t m, loc[ALI3_TABLED_MOST]; /* coordinates, and their places in its front, ascending */
  int32_t n_item, item[ALI3_TABLED_ITEMS], slot[ALI3_TABLED_ITEMS][ALI3_TABLED_COLUMNS];
};

struct ali3_tabled_work { /* what ali3_tabled_prepare leaves of an item */
  double value[6][ALI3_TABLED_BODY]; /* functions, their derivatives by a, b, aa, ab, bb */
  double by[2][ALI3_TABLED_BODY];    /* dX/da, dX/db */
  double axes[9];                     /* Y */
  double force[ALI3_TABLED_BODY];    /* on X, of the last ali3_tabled_forces */
};

/* Whether a coordinate of in->now is beyond its table by more than a spacing: along a tangent a body is none there. */
bool ali3_tabled_left(const ali3_instance *in);
void ali3_tabled_table(const ali3_tabled *c, double a, double b, double value[6][ALI3_TABLED_BODY]);
void ali3_tabled_prepare(const ali3_instance *in, const double *q);
/* in->extended[0 .. 2]: q, qd, qdd (NULL: left) with the dependents behind them; prepared at q. */
void ali3_tabled_extend(const ali3_instance *in, const double *q, const double *qd, const double *qdd);
/* X of a change D of coordinates that ends where was prepared, behind D in in->extended[0]: to second order. */
void ali3_tabled_way(const ali3_instance *in, const double *D);
void ali3_tabled_mass_times(const ali3_instance *in, const double *x, double *out);
void ali3_tabled_forces(ali3_instance *in, const double *qd, double *Q);
double ali3_tabled_gravity(const ali3_instance *in, const double *q);
/* Adds what rates change in both energies beside M qdd and the constant weight. */
void ali3_tabled_power(const ali3_instance *in, const double *qd, double *kinetic, double *gravity);
void ali3_tabled_tangent(const ali3_instance *in, double wM, double wK, double *F);
void ali3_tabled_elements_tangent(ali3_instance *in, double *F);
#endif
