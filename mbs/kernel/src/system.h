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
       ALI3_TARGET_DRIVING,
       ALI3_TARGET_ROAD,
       ALI3_TARGET_PAYLOAD,
       ALI3_TARGET_SWITCH,
       ALI3_TARGET_ARMATURE,
       ALI3_TARGET_INERTIA,
       ALI3_TARGET_SENSOR,
       ALI3_TARGET_AXIS,
       ALI3_TARGET_COUNT
};

/* A product h q_a q_b of a row. */
typedef struct {
  int32_t a, b; /* coordinates; b = -1: linear term h q_a, a = b = -1: constant h */
  int32_t ja, jb; /* entries of Phi_q in the row pattern of both; -1 likewise */
  int32_t pos; /* place of the second derivative by q_a and q_b in front storage; -1: there is none */
  double h; /* coefficient of the stored row */
} ali3_term;

/* A term of a row of an angle theta: hc q_a q_b of the factor of sin(theta), hs q_a q_b of that of cos(theta). */
typedef struct {
  int32_t a, b, ja, jb, pos; /* as in ali3_term */
  int32_t pos_a, pos_b; /* places in front storage of the second derivatives by theta and q_a, q_b; -1: none */
  double hc, hs; /* coefficients of the stored row */
} ali3_angle_term;

/* A term h s^power q_a q_b of a row with a driving function s. */
typedef struct {
  ali3_term term; /* h q_a q_b */
  int32_t row, driving, power; /* indices of both; exponent, 1 or 2 */
} ali3_driving_term;

typedef struct { /* outputs of an element that are forces of a contact or a stop, N */
  int32_t element, first, n; /* its index; first of these outputs among those of all elements, and their number */
  /* outputs at whose abrupt changes a step is divided; of a tyre its load only, as its other forces follow pedals */
  int32_t judged, n_judged;
  bool tyre, touches; /* the element is a tyre; it has a depth in a road */
} ali3_contact_forces_of;

typedef struct { /* data of an element */
  int32_t nsig, nreal, nint, nstate, nout; /* numbers of signals, reals, integers, states and outputs */
  int32_t real, integer, state, out; /* indices of the first ones in el_parameter, el_int, y and the outputs */
} ali3_element_size;

typedef struct ali3_element_type ali3_element_type; /* elements/element.h */
typedef struct ali3_lookup ali3_lookup; /* lookup/lookup.h */
typedef struct ali3_lookup_base ali3_lookup_base;
typedef struct ali3_lookup_parameter ali3_lookup_parameter;
typedef struct ali3_lookup_group ali3_lookup_group;
typedef struct ali3_tree ali3_tree; /* tree/tree.h: the part of a System for relative coordinates */

struct ali3_system {
/* the arrays of the file, and n_ and the name: the length of each; their meaning is in system_arrays.h */
#define ALI3_DECLARE(items, name, ...) const ALI3_ITEM_##items *name;
  ALI3_SYSTEM_ARRAYS(ALI3_DECLARE)
#undef ALI3_DECLARE
#define ALI3_DECLARE(items, name, ...) int64_t n_##name;
  ALI3_SYSTEM_ARRAYS(ALI3_DECLARE)
#undef ALI3_DECLARE
  ali3_memory memory; /* functions that allocate and release all blocks of the System and of its instances */
  unsigned char *bytes; /* the copied file */
  uint32_t crc; /* CRC-32 of the file */
  ali3_sizes size; /* lengths of the arrays and vectors; nq, nc, ng, ne and nf below are its members */
  int32_t nr; /* roads */
  int32_t max_front; /* coordinates of the largest front */
  double flex_rate; /* largest K_jj/M_jj of a mode, 1/s^2 */
  int32_t n_flexible, max_modes; /* number of flexible bodies, largest number of modes of one */
  int32_t n_lookup, n_dependent; /* number of lookup-table bodies and numbers, and of their dependent coordinates */
  int32_t n_lookup_base, n_lookup_parameter, n_lookup_group; /* lengths of the arrays of these names below */
  int32_t lookup_square; /* numbers of the work array of the largest group */
  bool senses_rows; /* a sensor reads multipliers or violations */
  bool has_force_tables; /* an element has a force by a table */
  bool has_avx2; /* the processor has AVX2, see algebra/processor.h */
  void *derived; /* the block of all arrays below, which are derived at load */

  /* Axes of wheels that parameters set: the System with entries for all their directions (parametric_axes.c), NULL if
   * there are none; and the block with the arrays of this System without such entries. */
  ali3_system *turned;
  void *lean;

  /* Rows. Second derivatives of the rows: Phi_q of entry i of the row pattern is row_lin[i] + sum hess_val q[hess_col]
   * over the terms hess_ptr[i] .. hess_ptr[i + 1] - 1; of a row of points the terms of three entries in turn. */
  int32_t *hess_ptr, *hess_col;
  double *hess_val; /* of the stored row */
  double *row_round; /* nc: round-off of the violation at the reference position, m */
  double largest_round; /* largest of row_round, m */
  double fine; /* factor on tolerances in m; not 1 for a very small or large drawing */
  double fall; /* acceleration of coordinates by gravity: root of the mean square, m/s^2 */
  /* nc: ALI3_TRIPLES or ALI3_POINTS: the coordinates of the row are points and directions, in triples of consecutive
   * ones; 0: they are not */
  unsigned char *row_triples;
  int32_t *row_stretch; /* nc: entry from which the coordinates of the row lie side by side and have second derivatives
                           with the same ones, as modes have; they stand by columns. Otherwise the end of the row */
  int32_t *hess_run; /* as row_col: in rows with a stretch, term of the entry from which the
                        coordinates lie side by side; otherwise the end of its terms */
  int32_t *front_row_ptr, *front_row; /* nf + 1: offsets into front_row, nc: rows front by front */
  /* as front_row: number of rows from this one on with the same stretch in the front; 0: no stretch */
  int32_t *row_alike;
  ali3_term *quad; /* as quad_a, its terms; of a row those with entries of its stretch stand last */
  int32_t *quad_pos; /* as quad: its place in front storage */
  double *quad_second; /* as quad: the second derivative of the term, h or, of a square, 2 h */
  int32_t *quad_end; /* nc: index of the first term with entries of the stretch */
  int32_t *stretch_pos; /* as hess_col: of the first entry of a stretch, front storage of the term; they are a column */
  ali3_angle_term *angle; /* as angle_a, its terms */
  int32_t *angle_theta_col; /* as angle_row: coordinate theta of the row */
  int32_t *angle_theta_j; /* as angle_row: entry of theta in the row pattern */
  int32_t *angle_theta_pos; /* as angle_row: place of the second derivative by theta in front storage */
  ali3_driving_term *gterm; /* as gterm_row, its terms */
  int32_t *driven_row; /* n_driven: rows with driving function terms, ascending */
  int32_t *turning; /* n_turning: entries of angle_row whose angle has inertia or other rows (rows/turning.h) */
  int32_t n_driven, n_turning; /* lengths of both */
  ali3_term *velocity; /* as velocity_a, its terms; b: the coordinate of the rate */

  /* Masses; entry i of a vector of nq has the unit kg, of directions and angles kg m^2. */
  double *front_mass; /* size.front_size: M in front storage, the initial value of every tangent */
  double *mass_floor; /* nq: M_ii, or a typical mass for massless coordinates */
  double *mass_floor_inverse; /* nq: 1 / mass_floor */
  double *mass_missing; /* nq: the typical mass if the coordinate is massless, otherwise 0 */
  int32_t *mass_stretch; /* 2 nq: entries of mass_ptr between which the columns of a row are neighbours; an empty range
                            at its end if they are few */
  /* A triple are three signals or rows of mass_ptr that are components of a point or a direction: entry by entry of the
   * first the columns of the others are one and two further, and the values are the same. */
  int32_t
      *mass_alike; /* nq: number of rows of mass_ptr from this one on with the same columns, 1 without modes; 0: this
                          row begins a triple */
  int32_t *mass_mirror; /* as mass_col: entry (j, i) of an entry (i, j) */
  int32_t *diagonal_pos; /* nq: place of entry (i, i) in front storage */

  /* Elements and their signals */
  int32_t *batch, *alone; /* elements evaluated four at a time (elements/element_batches.h), and the others */
  int32_t n_batches, n_alone; /* number of batches, number of the others */
  unsigned char *el_in_batch; /* ne: 1: evaluated four at a time */
  int32_t *el_beside; /* ne: first signal of an element with consecutive signals, otherwise -1 */
  int32_t *active_signal; /* n_active: signals that elements use, ascending */
  int32_t n_active;
  unsigned char *active_triple, *el_triple; /* as active_signal, as el_sig: 1: the first of a triple that follows */
  const ali3_element_type **el_kind; /* ne: types of the elements */
  ali3_element_size *el_size; /* ne */
  ali3_contact_forces_of *contact; /* n_contact: elements with forces of contacts or stops */
  int32_t n_contact;
  int32_t *el_S_off; /* ne + 1: offsets of the elements' signal tangents, n x n with n signals each */
  int32_t *el_entry_ptr; /* ne + 1: offsets of the signal entries of the element in the two arrays that follow */
  int32_t *el_entry_local; /* index of the coordinate of the entry within the element */
  double *el_entry_value; /* value of the entry: derivative of the signal by the coordinate */
  int32_t *el_coordinate_ptr; /* ne + 1: offsets of the coordinates of the element in the array that follows */
  int32_t *el_coordinate_loc; /* local index of the coordinate in the front of the element, ascending */
  int32_t *el_apart; /* ne: index from which the coordinates of the element are consecutive */

  int32_t *flex_square; /* n_flexible + 1: offsets of the n x n matrices of flexible bodies with n modes */

  /* Lookup-table bodies and numbers (lookup/lookup.h) */
  ali3_lookup *lookup; /* n_lookup: the bodies and numbers */
  ali3_lookup_base *lookup_base; /* n_lookup_base: frames that they move on */
  ali3_lookup_parameter *lookup_parameter; /* n_lookup_parameter: those of the bodies of a base, base by base */
  ali3_lookup_group *lookup_group; /* n_lookup_group */
  int32_t *lookup_order; /* elements on lookup-table items, ordered by group */
  int32_t *lookup_signal; /* as el_sig: index of the signal in the group of its element */
  int32_t *el_lookup; /* ne: group of the element, -1: none */
  int32_t *el_entry_dependent; /* as el_entry_local: index of the dependent in its item, -1: a coordinate */

  ali3_tree *tree; /* NULL: the System has none */
  ali3_generated generated; /* functions of ali3_system_attach, initially none */

  /* Work that sensors read (state/work.h) */
  int32_t n_work, n_work_force; /* number of elements with sensed work, number of their signals */
  int32_t n_input_work; /* n_work if inputs may change the potentials of elements, otherwise 0 */
  int32_t n_driving_work; /* 1 if the work of driving functions is sensed, otherwise 0 */
  /* ne: index of the element in work_element, or -1; elements with sensed work; n_work + 1: offsets of their signals */
  int32_t *work_of, *work_element, *work_ptr;

  int32_t shift_x, shift_y, shift_z; /* a coordinate that a translation of the scene along x, y, z changes, or -1 */
};

/* Items of a triad in mode_triad (9 signals, kind, cycle), and most triads of a loop. */
enum { ALI3_TRIAD_ITEMS = 11, ALI3_MAX_TRIADS = 15 };

/* The larger one of the System as loaded and the System of instances with other axes. */
static inline const ali3_system *ali3_widest_system(const ali3_system *s) { return s->turned != NULL ? s->turned : s; }
#endif
