/* The loaded System: its arrays and those derived from them at load. */
#ifndef ALI3_SYSTEM_H
#define ALI3_SYSTEM_H
#include <stdbool.h>

#include "../include/ali3.h"
#include "generated.h"
#include "system_arrays.h"

/* Numbers and signals of a body with inertia set by parameters. */
enum { ALI3_INERTIA_REALS = 10, ALI3_INERTIA_SIGNALS = 12 };
enum { ALI3_AXIS_REALS = 2, ALI3_AXIS_SIGNALS = 9 }; /* numbers and signals of a wheel with an axis set by parameters */

enum {
#define ALI3_NUMBER(items, name, ...) ALI3_ARRAY_##name,
  ALI3_SYSTEM_ARRAYS(ALI3_NUMBER)
#undef ALI3_NUMBER
      ALI3_ARRAY_COUNT
};

/* Values of row_triples; ALI3_POINTS: also the second factors of the terms are triples. */
enum { ALI3_TRIPLES = 1, ALI3_POINTS };

enum { /* par_target: kind of data that a parameter writes */
       ALI3_TARGET_ELEMENT = 0,
       ALI3_TARGET_GUIDE,
       ALI3_TARGET_ROAD,
       ALI3_TARGET_PAYLOAD,
       ALI3_TARGET_SWITCH,
       ALI3_TARGET_ARMATURE,
       ALI3_TARGET_INERTIA,
       ALI3_TARGET_SENSOR,
       ALI3_TARGET_AXIS,
       ALI3_TARGET_COUNT
};

/* A product h q_a q_b of a row with its positions; ja, jb: entries of the Jacobian; pos: of front storage. */
typedef struct {
  int32_t a, b, ja, jb, pos; /* b = -1: linear term, a = b = -1: constant; pos = -1: no second derivative */
  double h;
} ali3_term;

typedef struct {
  int32_t a, b, ja, jb, pos, pos_a, pos_b; /* pos_a, pos_b: front storage of the products with theta */
  double hc, hs;
} ali3_angle_term;

typedef struct {
  ali3_term term;
  int32_t row, guide, power;
} ali3_guide_term;

typedef struct { /* outputs of an element that are forces of a contact or a stop */
  int32_t element, first, n; /* range of outputs */
  /* outputs checked for abrupt changes; of a tyre its load only, as its other forces follow pedals, which jump */
  int32_t judged, n_judged;
  bool tyre, touches; /* touches: has a depth in a road */
} ali3_contact_forces_of;

typedef struct { /* numbers of data of an element and the offsets of its first ones */
  int32_t nsig, nreal, nint, nstate, nout, real, integer, state, out;
} ali3_element_size;

typedef struct ali3_element_type ali3_element_type; /* elements/element.h */
typedef struct ali3_tabled ali3_tabled; /* tabled/tabled.h */
typedef struct ali3_tabled_base ali3_tabled_base;
typedef struct ali3_tabled_parameter ali3_tabled_parameter;
typedef struct ali3_tabled_group ali3_tabled_group;
typedef struct ali3_tree ali3_tree; /* tree/tree.h: the part of a System for relative coordinates */

struct ali3_system {
#define ALI3_DECLARE(items, name, ...) const ALI3_ITEM_##items *name;
  ALI3_SYSTEM_ARRAYS(ALI3_DECLARE)
#undef ALI3_DECLARE
#define ALI3_DECLARE(items, name, ...) int64_t n_##name;
  ALI3_SYSTEM_ARRAYS(ALI3_DECLARE)
#undef ALI3_DECLARE
  ali3_memory memory;
  unsigned char *bytes; /* the copied file */
  uint32_t crc;
  ali3_sizes size;
  int32_t nr; /* roads */
  int32_t max_front; /* largest front */
  double flex_rate; /* largest K_jj/M_jj of a mode, 1/s^2 */
  int32_t n_flexible, max_modes; /* number of flexible bodies, largest number of modes of one */
  int32_t n_tabled, n_dependent; /* number of tabled bodies and numbers, and of their dependent coordinates */
  /* tabled_square: size of the work array of a group */
  int32_t n_tabled_base, n_tabled_parameter, n_tabled_group, tabled_square;
  bool senses_rows; /* a sensor reads multipliers or violations */
  bool has_force_tables; /* an element has a force by a table */
  bool has_avx2; /* the processor has AVX2, see algebra/processor.h */
  /* derived at load, in one block */
  void *derived;
  ali3_system
      *turned; /* System with entries for all directions of parametric axes (parametric_axes.c); NULL: there are none */
  void *lean; /* arrays of this System without such entries */
  int32_t *hess_ptr, *hess_col; /* second derivatives of row_ptr's entries: Phi_q = row_lin + hess q; of a row of
                                   points the terms of three entries in turn */
  double *hess_val;
  double *row_round; /* round-off of the violation at the reference position, m */
  double largest_round; /* largest of row_round, m */
  double fine; /* factor on tolerances in m; not 1 for a very small or large drawing */
  double fall; /* acceleration of coordinates by gravity: root of the mean square, m/s2 */
  /* not 0: the coordinates of the row are points and directions, in triples of consecutive ones */
  unsigned char *row_triples;
  int32_t *row_stretch; /* nc: entry from which the coordinates of the row lie side by side and have second derivatives
                           with the same ones, as modes have; they stand by columns. Otherwise the end of the row */
  int32_t *hess_run; /* as row_col: in rows with a stretch, term of the entry from which the
                        coordinates lie side by side; otherwise the end of its terms */
  int32_t *front_row_ptr, *front_row; /* nf + 1; nc: rows front by front */
  int32_t
      *row_alike; /* as front_row: number of rows from this one on with the same stretch in the front; 0: no stretch */
  ali3_term *quad; /* as quad_*; of a row the terms with entries of its stretch stand last */
  int32_t *quad_pos; /* as quad: its place in front storage */
  double *quad_second; /* as quad: the second derivative of the term, h or, of a square, 2 h */
  int32_t *quad_end; /* nc: index of the first term with entries of the stretch */
  int32_t *stretch_pos; /* as hess_col: of the first entry of a stretch, front storage of the term; they are a column */
  ali3_angle_term *angle; /* as angle_a */
  int32_t *angle_theta_col, *angle_theta_j, *angle_theta_pos;
  ali3_guide_term *gterm;
  int32_t *driven_row; /* n_driven: rows with guide terms */
  int32_t *turning; /* n_turning: entries of angle_row whose angle has inertia or other rows (rows/turning.h) */
  ali3_term *velocity; /* as velocity_a; b: the coordinate of the rate */
  double *front_mass; /* M in front storage, the initial value of every tangent */
  double *mass_floor; /* nq: M_ii, or a typical mass for massless coordinates */
  double *mass_floor_inverse; /* nq */
  double *mass_missing; /* nq: mass_floor - M_ii if M_ii is zero, otherwise 0 */
  int32_t
      *mass_stretch; /* nq: entries of mass_ptr between which the columns of a row are neighbours, or twice its end */
  /* A triple are three signals or rows of mass_ptr that are components of a point or a direction: entry by entry of the
   * first the columns of the others are one and two further, and the values are the same. */
  int32_t *
      mass_alike; /* nq: number of rows of mass_ptr from this one on with the same columns; 0: this row begins a triple */
  int32_t *four, *alone; /* elements evaluated four at a time (elements/element_fours.h), and the others */
  unsigned char *el_in_four; /* ne: 1: evaluated four at a time */
  int32_t *el_beside; /* ne: first signal of an element with consecutive signals, otherwise -1 */
  unsigned char *active_triple,
      *el_triple; /* n_active, as el_sig: 1: it is the first of a triple that follows in turn */
  int32_t *mass_mirror; /* as mass_col: entry (j, i) of an entry (i, j) */
  int32_t *diagonal_pos; /* nq: front storage index of entry (i, i) */
  const ali3_element_type **el_kind;
  ali3_element_size *el_size; /* ne */
  ali3_contact_forces_of *contact; /* n_contact: elements with forces of contacts or stops */
  int32_t *el_S_off; /* ne+1: offsets of the elements' signal tangents */
  int32_t *el_entry_ptr; /* ne+1: signal entries of the element */
  int32_t *el_entry_local; /* per entry: index of its coordinate within the element */
  double *el_entry_value;
  int32_t *el_coordinate_ptr; /* ne+1 */
  int32_t *el_coordinate_loc; /* local index in the front, ascending */
  int32_t *el_apart; /* ne: index from which the coordinates of the element are consecutive */
  int32_t *active_signal; /* signals that elements use */
  int32_t *flex_square; /* n_flexible + 1: offsets of the n x n matrices of flexible bodies */
  ali3_tabled *tabled;
  ali3_tabled_base *tabled_base;
  ali3_tabled_parameter *tabled_parameter;
  ali3_tabled_group *tabled_group;
  int32_t *tabled_order; /* elements on tabled items, ordered by group */
  int32_t *tabled_signal; /* per signal of an element: its index in the group */
  int32_t *el_tabled; /* ne: group of the element, -1: none */
  int32_t *el_entry_dependent; /* per entry: index of the dependent in its item, -1: a coordinate */
  ali3_tree *tree; /* NULL: the System has none */
  ali3_generated generated; /* initially none */
  int32_t n_input_work; /* n_work if inputs may change the potentials of elements, otherwise 0 */
  int32_t n_guide_work; /* 1 if the work of guides is sensed, otherwise 0 */
  int32_t n_work, n_work_force; /* number of elements with sensed work, number of their signals */
  /* ne: index of the element in work_element, or -1; elements with sensed work; n_work + 1: offsets of their signals */
  int32_t *work_of, *work_element, *work_ptr;
  int32_t n_driven, n_contact, n_turning, n_four, n_alone;
  int32_t n_active, shift_x, shift_y, shift_z; /* shift_*: a coordinate that a translation changes, or -1 */
};

/* Items of a triad in mode_triad (9 signals, kind, ring), and most triads of a loop. */
enum { ALI3_TRIAD_ITEMS = 11, ALI3_MAX_TRIADS = 15 };

/* The larger one of the System as loaded and the System of instances with other axes. */
static inline const ali3_system *ali3_widest_system(const ali3_system *s) { return s->turned != NULL ? s->turned : s; }
#endif
