/* What the kernel's files share: the loaded System, the instance and the functions between files. */
#ifndef ALI3_INTERNAL_H
#define ALI3_INTERNAL_H
#include <stdbool.h>

#include "../include/ali3.h"
#include "algebra/elementary.h"
#include "elements/element.h"
#include "elements/road.h"

/* The arrays of a System file: C type, item type number, name. */
/* clang-format off */
#define ALI3_SYSTEM_ARRAYS(X) \
  X(unsigned char, 3, meta) \
  X(double, 2, q0) X(double, 2, qd0) X(double, 2, y0) \
  X(int32_t, 1, mass_ptr) X(int32_t, 1, mass_col) X(double, 2, mass_val) X(int32_t, 1, mass_pos) \
  X(double, 2, gravity_force) X(double, 2, gravity_const) \
  X(int32_t, 1, row_ptr) X(int32_t, 1, row_col) X(double, 2, row_lin) X(double, 2, row_const) \
  X(double, 2, row_scale) X(double, 2, row_measure) X(int32_t, 1, row_front) X(int32_t, 1, row_loc) \
  X(int32_t, 1, quad_ptr) X(int32_t, 1, quad_a) X(int32_t, 1, quad_b) X(double, 2, quad_h) \
  X(int32_t, 1, angle_row) X(int32_t, 1, angle_theta) X(int32_t, 1, angle_ptr) X(int32_t, 1, angle_a) \
  X(int32_t, 1, angle_b) X(double, 2, angle_hc) X(double, 2, angle_hs) \
  X(int32_t, 1, gterm_row) X(int32_t, 1, gterm_guide) X(int32_t, 1, gterm_power) X(int32_t, 1, gterm_a) \
  X(int32_t, 1, gterm_b) X(double, 2, gterm_h) X(int32_t, 1, row_switch) X(int32_t, 1, switch_start) \
  X(int32_t, 1, velocity_row) X(int32_t, 1, velocity_ptr) X(int32_t, 1, velocity_a) X(int32_t, 1, velocity_b) \
  X(double, 2, velocity_h) \
  X(int32_t, 1, front_col) X(int32_t, 1, front_ptr) X(int32_t, 1, front_idx) X(int32_t, 1, front_parent) \
  X(int32_t, 1, front_map) X(int32_t, 1, front_off) \
  X(int32_t, 1, sig_ptr) X(int32_t, 1, sig_col) X(double, 2, sig_val) X(double, 2, sig_const) \
  X(int32_t, 1, el_type) X(int32_t, 1, el_sig_ptr) X(int32_t, 1, el_sig) X(int32_t, 1, el_real_ptr) \
  X(double, 2, el_real) X(int32_t, 1, el_int_ptr) X(int32_t, 1, el_int) X(int32_t, 1, el_state_ptr) \
  X(int32_t, 1, el_out_ptr) X(int32_t, 1, el_front) X(int32_t, 1, el_loc_ptr) X(int32_t, 1, el_loc) \
  X(double, 2, input_start) X(double, 2, input_min) X(double, 2, input_max) \
  X(int32_t, 1, guide_type) X(int32_t, 1, guide_input) X(int32_t, 1, guide_real_ptr) X(double, 2, guide_real) \
  X(int32_t, 1, road_type) X(int32_t, 1, road_real_ptr) X(double, 2, road_real) \
  X(double, 2, par_value) X(double, 2, par_min) X(double, 2, par_max) X(int32_t, 1, par_ptr) \
  X(int32_t, 1, par_target) X(int32_t, 1, par_index) X(double, 2, par_scale) \
  X(double, 2, pose_0) X(double, 2, pose_cos) X(double, 2, pose_sin) X(double, 2, pose_x) X(double, 2, pose_y) \
  X(double, 2, pose_z) X(double, 2, pose_speed) \
  X(int32_t, 1, sen_type) X(int32_t, 1, sen_int_ptr) X(int32_t, 1, sen_int) X(int32_t, 1, sen_real_ptr) \
  X(double, 2, sen_real) \
  X(int32_t, 1, flex_mode_ptr) X(int32_t, 1, flex_frame) X(int32_t, 1, flex_mode) X(int32_t, 1, flex_front) \
  X(int32_t, 1, flex_loc) X(double, 2, flex_gravity) X(double, 2, flex_P) X(double, 2, flex_c) X(double, 2, flex_T) \
  X(double, 2, flex_K) X(double, 2, flex_C) \
  X(int32_t, 1, tree_parent) X(int32_t, 1, tree_slides) X(double, 2, tree_base) X(double, 2, tree_mass) \
  X(double, 2, tree_centre) X(double, 2, tree_inertia) X(double, 2, tree_gravity) X(int32_t, 1, tree_frame) \
  X(int32_t, 1, tree_out_body) X(double, 2, tree_out_local) X(int32_t, 1, tree_out_col) \
  X(int32_t, 1, tree_cut_body) X(int32_t, 1, tree_cut_rows) X(double, 2, tree_cut_place) \
  X(int32_t, 1, tree_angle_col) X(int32_t, 1, tree_angle_ptr) X(int32_t, 1, tree_angle_joint) \
  X(double, 2, tree_angle_sign) X(double, 2, tree_angle_inertia) \
  X(int32_t, 1, mode_triad_ptr) X(int32_t, 1, mode_triad) X(int32_t, 1, mode_cell_ptr) X(int32_t, 1, mode_cell) \
  X(int32_t, 1, mode_name_ptr) X(int32_t, 1, mode_name) \
  X(int32_t, 1, static_start) X(int32_t, 1, static_par) X(double, 2, static_value) X(int32_t, 1, pose_partner)
/* clang-format on */

/* A product h q_a q_b of a row with everything its loops need; ja, jb index the Jacobian, pos the front storage. */
typedef struct {
  int32_t a, b, ja, jb, pos; /* b = -1: linear term, a = b = -1: constant; pos = -1: no second derivative */
  double h;
} ali3_term;

typedef struct {
  int32_t a, b, ja, jb, pos, pos_a, pos_b; /* pos_a, pos_b: entries with theta */
  double hc, hs;
} ali3_angle_term;

typedef struct {
  ali3_term term;
  int32_t row, guide, power;
} ali3_guide_term;

typedef struct ali3_tree ali3_tree;           /* tree.h: what relative coordinates need of a System */
typedef struct ali3_tree_work ali3_tree_work; /* tree.h: their work space */

struct ali3_system {
#define ALI3_DECLARE(type, number, name) const type *name;
  ALI3_SYSTEM_ARRAYS(ALI3_DECLARE)
#undef ALI3_DECLARE
#define ALI3_DECLARE(type, number, name) int64_t n_##name;
  ALI3_SYSTEM_ARRAYS(ALI3_DECLARE)
#undef ALI3_DECLARE
  ali3_memory memory;
  unsigned char *bytes; /* the copied file */
  uint32_t crc;
  ali3_sizes size;
  int32_t nr;        /* roads */
  int32_t max_front; /* largest front */
  double flex_rate; /* largest K_jj/M_jj of a mode, 1/s^2 */
  int32_t n_flexible, max_modes; /* flexible bodies, most modes of one */
  bool senses_rows; /* a sensor reads multipliers or violations */
  /* derived at load, in one block */
  void *derived;
  int32_t *hess_ptr, *hess_col; /* second derivatives of row_ptr's entries: Phi_q = row_lin + hess q */
  double *hess_val;
  double *row_round; /* round-off of the violation at the reference position, m */
  unsigned char *row_wide; /* 1: the row fills most of its front */
  ali3_term *quad;             /* as quad_* */
  ali3_angle_term *angle;      /* as angle_a */
  int32_t *angle_theta_col, *angle_theta_j, *angle_theta_pos;
  ali3_guide_term *gterm;
  ali3_term *velocity;         /* as velocity_a; b is the coordinate whose rate it takes */
  double *front_mass;          /* front storage holding M, the start of every tangent */
  double *mass_floor;          /* nq: M_ii, or a typical mass for massless coordinates */
  double *mass_floor_inverse;  /* nq */
  double *mass_missing;        /* nq: mass_floor - M_ii where M_ii is zero, else 0 */
  int32_t *diagonal_pos;       /* nq: front storage index of entry (i, i) */
  const ali3_element_type **el_kind;
  int32_t *el_S_off;           /* ne+1: offsets of the elements' signal tangents */
  int32_t *el_entry_ptr;       /* ne+1: signal entries of the element */
  int32_t *el_entry_signal,
      *el_entry_local; /* per entry: signal within the element, its coordinate within the element */
  double *el_entry_value;
  int32_t *el_coordinate_ptr;  /* ne+1 */
  int32_t *el_coordinate_loc;  /* local index in the front, ascending */
  int32_t *active_signal;      /* signals that elements use */
  int32_t *flex_square;        /* n_flexible + 1: offsets of the n x n matrices of flexible bodies */
  ali3_tree *tree;             /* NULL: the System has none */
  int32_t n_work, n_work_force; /* elements whose work is sensed, signals of all of them */
  int32_t *work_of, *work_element, *work_ptr; /* ne: number among them or -1; which; n_work + 1: offsets of signals */
  int32_t n_active, shift_x, shift_y, shift_z; /* shift_*: a coordinate that shows the translation, or -1 */
};

/* One state; the vectors lie in one block of `n` doubles so that a copy is one memcpy. */
typedef struct {
  double *q, *qd, *qdd, *lam, *y;
  double *mean, *mean_before; /* mean rates of the last two steps, of systems with flexible bodies */
  double *s, *sd, *sdd;      /* guides */
  double *out, *potential;   /* of the last evaluation of the elements */
  double *used;              /* inputs as used in the last step */
  double *y_last, *h_last;   /* of the last step: slots at its start (ny), its size; 0 at a start */
  double *on, *anchor;       /* switches: 0 or 1; nc where there are any: what a switched row holds */
  /* of the methods that carry more than q, qd, qdd */
  double *memory;            /* whose it is (ALI3_METHOD_*), count of past steps, their middles relative to now, s */
  double *own;               /* nq: velocity (energy-momentum) or algorithmic acceleration (generalised-alpha) */
  double *past_a, *past_lam; /* ALI3_PAST x nq, x nc: mean accelerations and multipliers of past steps, newest first */
  /* work.c: since the start; potential at the start; power, then forces, at the end of the last step; of the last step
   * mean forces, ways of their signals */
  double *work, *stored, *watched, *step_force, *step_way;
} ali3_vectors;

enum { ALI3_STAGES = 12, ALI3_RADAU = 3 }; /* of runge_kutta.c, radau.c */
enum { ALI3_PAST = 4, ALI3_MEMORY_OWNER = 0, ALI3_MEMORY_COUNT, ALI3_MEMORY_TIME, ALI3_MEMORY = 2 + ALI3_PAST };

/* A step rule in the increment D: qd = rate D + hat, qdd = (D - d0) / c; element tangents weigh C with wC, K with c. */
typedef struct {
  double c, rate, wC;
} ali3_rule;

struct ali3_instance {
  const ali3_system *system;
  void (*release)(void *block);
  ali3_settings settings;
  ali3_report report;
  ali3_report report_before; /* of the step that branch_watch.c may make again */
  double t_base, h_last; /* time = t_base + count * h_last */
  bool halves_left; /* this is a part of a step that was asked for, and it may still be halved */
  int64_t count;
  int32_t initialised;
  /* start: of a step that may be halved; whole: of a composed one; tangent: a direction in the space of states */
  ali3_vectors now, next, start, whole, tangent;
  ali3_vectors origin, centre, coarse; /* of a controlled step: its start, its centre, its end by one whole step */
  ali3_rule rule;
  bool kept; /* in->start holds the state before the step */
  bool discrete, quiet; /* forces by discrete gradients; nobody will look at the state of this step */
  bool sampled; /* only sensors will look at it */
  bool controlled; /* steps change from one to the next, and may be forgotten */
  size_t n_vector;
  double *input, *input_work, *parameter, *input_middle;
  const double *force_input; /* what elements see: input, or input_middle in a step that looks at its middle */
  double *el_real, *guide_real, *road_real; /* copies that parameters write to */
  ali3_road *road;
  /* work space */
  double *D, *d0, *r, *x, *w, *hat; /* nq */
  double *stage; /* ALI3_STAGES x nq: accelerations, of radau.c residuals too */
  double *middle, *rate; /* nq: position and velocity in the middle of the step */
  double *J0, *A, *A_tangent; /* row pattern: Phi_q at the start, discrete derivative, where F was made */
  double *at_J0; /* nq, ng, switches: where J0 was made */
  bool has_J0;
  double *Phi, *Phit, *gamma, *mu, *lam; /* nc */
  double *J, *J_tangent; /* row pattern: Phi_q at the iterate, and where the tangent was made */
  double *F; /* front storage */
  double *Q; /* nq */
  double *u, *ud; /* signals */
  double *S; /* signal tangents of all elements */
  double *SB; /* one element: signals x coordinates */
  unsigned char *idle; /* ne: 1 where the last ali3_forces met no force and no tangent */
  double *correction_q, *step_q, *correction_lam, *step_lam; /* of the last iteration */
  double *local; /* one front */
  double *shifted; /* nq */
  double *flex, *flex_work; /* flexible bodies: at the last q prepared; scratch */
  double wC, wK; /* weights of the last forces */
  /* of radau.c, empty where states have memory: stages of the rows, of Phi_q, of where the tangent saw it, of
   * corrections */
  double *stage_Phi, *stage_lam, *stage_J, *stage_J_tangent, *stage_x;
  double *F_stages, *F_C, *F_K; /* tangent of all stages, front storage of dampers and of springs and rows */
  double *y_work, *out_work, *potential_work, *parameter_work;
  ali3_tree_work *tree;
  /* inputs.c: who is asked, inputs at the start of the step, when it starts, its length, the time of in->now */
  ali3_input_function *input_function;
  void *input_context;
  double *input_begin, *stage_input; /* nu; of the stages of radau.c */
  double input_time, input_length, t_now;
  /* of branch_watch.c, signed squares: sines and cosines of the triads at in->now; sines before the step, after it, after it in parts;
   * loops that left their modes */
  double *mode_sine, *mode_cosine, *sine_before, *sine_after, *sine_few, *mode_left;
  ali3_vectors before; /* the state before a step where branches may be near */
  bool mode_known, branch_kept;
  /* of start_equilibrium.c: where a start is and how a pose moves it; the last pose; who placed the present start */
  double *start_q, *pose_0, *pose_cos, *pose_sin, pose[5];
  int32_t placed;
  bool start_moved; /* not as in the file */
  double *watched, *work_sum, *stage_power; /* work.c: of the last ali3_forces; of the stages of a step */
};

enum { ALI3_PLACED_BY_FILE = 0, ALI3_PLACED_BY_POSE, ALI3_PLACED_BY_Q };

enum { ALI3_TRIAD_ITEMS = 11, ALI3_MOST_TRIADS = 15 }; /* of mode_triad: 9 signals, kind, ring; of a loop */

enum { ALI3_LOCAL = ALI3_MAX_SIGNALS };

/* crc32.c */
uint32_t ali3_crc32(const void *bytes, size_t size);

/* system_check.c: content of the arrays; system_derive.c: the derived block */
typedef struct {
  char *text;
  size_t size;
} ali3_message;
ali3_status ali3_bad(ali3_message m, const char *format, ...);
ali3_status ali3_system_check(ali3_system *s, ali3_message m);
ali3_status ali3_check_fronts(ali3_system *s, ali3_message m);
ali3_status ali3_check_rows(const ali3_system *s, ali3_message m);
ali3_status ali3_check_elements(const ali3_system *s, ali3_message m);
ali3_status ali3_check_sensors(const ali3_system *s, ali3_message m);
ali3_status ali3_check_flexible(ali3_system *s, ali3_message m);
ali3_status ali3_check_pointers(ali3_message m, const char *name, const int32_t *ptr, int64_t n_ptr, int64_t n,
                                int64_t total);
ali3_status ali3_check_indices(ali3_message m, const char *name, const int32_t *v, int64_t n, int64_t low,
                               int64_t high);
const char *ali3_check_data(const ali3_system *s, const double *el_real, const double *guide_real,
                            const double *road_real);
ali3_status ali3_system_derive(ali3_system *s, ali3_message m);
int32_t ali3_find(const int32_t *sorted, int32_t n, int32_t value); /* position or -1 */

/* guides.c */
const char *ali3_guide_check(int32_t type, const double *real, int32_t nreal);
void ali3_guides_start(const ali3_instance *in, ali3_vectors *v, double t);
void ali3_guides_time(const ali3_instance *in, ali3_vectors *v, double t);
void ali3_guides_step(const ali3_instance *in, const ali3_vectors *from, ali3_vectors *to, double t, double h);

/* constraints.c */
void ali3_constraints(ali3_instance *in, const double *q, const double *s, double *Phi, double *J);
void ali3_constraint_rate(ali3_instance *in, const double *q, const ali3_vectors *guides, double *Phit);
void ali3_constraint_gamma(ali3_instance *in, const double *q, const double *qd, const ali3_vectors *guides,
                           double *gamma);
void ali3_geometric(ali3_instance *in, const double *q, const double *s, const double *lam, double weight, double *F);
void ali3_rows_square(ali3_instance *in, const double *J, double weight, double *F);
void ali3_rows_product(ali3_instance *in, const double *A, const double *J, double weight, double *F);
void ali3_rows_times(const ali3_system *S, const double *J, const double *x, double *out);
void ali3_rows_transposed(const ali3_system *S, const double *J, const double *w, double *out); /* out = J' w */

/* velocity_rows.c */
void ali3_velocity_jacobian(const ali3_instance *in, const double *q, double *Phi, double *J);
void ali3_velocity_gamma(const ali3_instance *in, const double *qd, double *gamma);
void ali3_velocity_values(const ali3_instance *in, const double *A, const double *v, double rate, double *Phi);
void ali3_velocity_middle(const ali3_instance *in, const double *A, const double *D, double *Phi, double *J);
void ali3_velocity_release(const ali3_instance *in, double *J);

/* forces.c */
typedef struct {
  const double *q, *qd, *y_old;
  double h, wC, wK;
  bool tangent;
  double *Q, *y_new, *out, *potential;
} ali3_force_call;
void ali3_forces(ali3_instance *in, const ali3_force_call *call);
void ali3_elements_tangent(ali3_instance *in, double *F);
void ali3_forces_tangent(ali3_instance *in, double *F);
void ali3_forces_accept(ali3_instance *in, const ali3_force_call *call);

/* discrete_gradient.c */
ali3_element_function *ali3_discrete_gradient(int32_t type); /* NULL: the middle of the step is exact or as good */

/* discrete_rows.c */
void ali3_discrete_rows(ali3_instance *in, const double *D, const double *q1, const ali3_vectors *from,
                        const ali3_vectors *to);

/* discrete_inertia.c */
void ali3_flexible_momentum(const ali3_instance *in, const double *q, const double *v, double *p);
void ali3_discrete_inertia(const ali3_instance *in, double h, const double *p0, const double *p1, const double *mean,
                           const double *half, double *r);

/* flexible_body.c: prepare is for one q, the others use what it left */
void ali3_flexible_prepare(const ali3_instance *in, const double *q);
void ali3_flexible_mass_times(const ali3_instance *in, const double *x, double *out);
void ali3_flexible_forces(const ali3_instance *in, const double *q, const double *qd, double *Q);
void ali3_flexible_energy(const ali3_instance *in, const double *q, double *gravity, double *elastic);
void ali3_flexible_tangent(const ali3_instance *in, double wM, double wC, double wK, double *F);
void ali3_flexible_stiffen(const ali3_instance *in, double weight, double *F);
void ali3_flexible_elastic(const ali3_instance *in, double weight, const double *x, double *out);

/* fronts.c */
ali3_status ali3_factorise(ali3_instance *in, double *F);
void ali3_solve(ali3_instance *in, const double *F, double *b);

/* fronts_lu.c */
void ali3_mirror(const ali3_instance *in, double *F);
ali3_status ali3_factorise_lu(ali3_instance *in, int32_t width, double *F);
void ali3_solve_lu(ali3_instance *in, int32_t width, const double *F, double *b);

/* measure.c */
bool ali3_finite(const double *v, int64_t n);
void ali3_constant_mass_times(const ali3_system *S, const double *x, double *out);
void ali3_mass_times(const ali3_instance *in, const double *x, double *out); /* M of the last q prepared */
double ali3_mass_product(const ali3_instance *in, const double *a, const double *b, double *work);
bool ali3_judge(ali3_instance *in, const double *r);
ali3_status ali3_newton_ended(const ali3_instance *in, ali3_status status);
void ali3_iterations_since(ali3_instance *in, int64_t before);
double ali3_penalty(const ali3_instance *in, double h);
double ali3_violation(const ali3_system *S, const double *Phi, int32_t *worst);
double ali3_opening(const ali3_system *S, const double *Phi);
bool ali3_closed(const ali3_system *S, const double *Phi, double tolerance);

/* energy_watch.c */
double ali3_constraint_work(ali3_instance *in, double h);
double ali3_projection_work(ali3_instance *in, double h, double *kinetic, double *end, double *open);
ali3_status ali3_energy_watch(ali3_instance *in, double h, double error, double kinetic, double end, double open);

/* books.c */
bool ali3_keeps_books(const ali3_instance *in);
void ali3_books_open(ali3_instance *in);
void ali3_books_energy(ali3_instance *in, double error, double kinetic);
void ali3_books_motion(ali3_report *report, double speed, double change, double miss);
void ali3_books_step(ali3_instance *in, double h);
void ali3_books_back(ali3_report *report, const ali3_report *before);

/* projection.c */
bool ali3_rates_closed(ali3_instance *in, const double *b, const double *v, double tolerance, double *violation);
double ali3_project(ali3_instance *in, double factor, const double *b, double *v, double *lam, double tolerance,
                    int32_t sweeps);

/* step.c */
ali3_status ali3_augmented_lagrangian(ali3_instance *in, double t, double h);

/* generalised_alpha.c */
bool ali3_quiet_start(const ali3_instance *in, double h);
void ali3_alpha_rule(ali3_instance *in, double h);
void ali3_alpha_accept(ali3_instance *in, double h);

/* advance.c */
ali3_status ali3_advance(ali3_instance *in, double t, double h, int32_t depth);

/* predict.c */
bool ali3_predict(ali3_instance *in, double h, bool from_past);
void ali3_predict_accept(ali3_instance *in, double h);
void ali3_predict_rates(ali3_instance *in, double h);

/* accelerate.c */
void ali3_accelerate(ali3_instance *in, int32_t iteration);

/* energy_momentum.c */
ali3_status ali3_energy_momentum(ali3_instance *in, double t, double h, double share, bool report);
double ali3_energy_momentum_penalty(const ali3_instance *in, double h); /* c alpha */

/* energy_momentum_report.c */
void ali3_energy_momentum_carry(ali3_instance *in, ali3_vectors *v, double weight);
ali3_status ali3_energy_momentum_show(ali3_instance *in, ali3_vectors *v);
void ali3_energy_momentum_report(ali3_instance *in);
void ali3_energy_momentum_restart(ali3_instance *in, double h);

/* history.c */
void ali3_history_own(ali3_instance *in, int32_t method, const double *own);
void ali3_history_predict(const ali3_instance *in, double when, int32_t most, double *a, double *lam);
int32_t ali3_history_order(const ali3_instance *in, int32_t most);
bool ali3_history_smooth(const ali3_instance *in, int32_t n, double h);
void ali3_history_append(ali3_instance *in, double h, const double *a);
void ali3_history_velocity(const ali3_instance *in, double h, double *v);

/* index_one.c */
#define ALI3_INDEX_ONE_PENALTY 1e8 /* of mass-normalised rows, with unit weight of M */
ali3_status ali3_index_one(ali3_instance *in, ali3_vectors *v);
ali3_status ali3_index_one_factorise(ali3_instance *in, const double *q);
ali3_status ali3_index_one_solve(ali3_instance *in, const double *Q, const double *b, double tolerance, double *x,
                                 double *lam);

/* check_tree.c */
ali3_status ali3_check_tree(const ali3_system *s, ali3_message m);

/* semi_recursive.c */
ali3_status ali3_semi_recursive(ali3_instance *in, double t, double h);
void ali3_semi_recursive_report(ali3_instance *in);

/* runge_kutta.c */
ali3_status ali3_runge_kutta(ali3_instance *in, double t, double h);

/* radau.c */
ali3_status ali3_radau(ali3_instance *in, double t, double h);

/* stiffness.c */
ali3_status ali3_explain_refusal(ali3_instance *in, ali3_status status, double h);

/* composition.c */
ali3_status ali3_composition(ali3_instance *in, double t, double h);
double ali3_composed(double h);

/* check_method.c */
bool ali3_without_memory(const ali3_system *S);
ali3_status ali3_check_method(ali3_instance *in);
bool ali3_relative(const ali3_instance *in);

/* initialise.c */
ali3_status ali3_solve_initial(ali3_instance *in, double t);
ali3_status ali3_solve_rates(ali3_instance *in, bool start);

/* assembly_mode.c */
ali3_status ali3_check_modes(const ali3_system *s, ali3_message m);
int64_t ali3_loop_count(const ali3_system *S);
int64_t ali3_triad_count(const ali3_system *S);
void ali3_mode_angles(ali3_instance *in, const double *q);
int32_t ali3_mode_left(const ali3_instance *in, int64_t loop);

/* start_equilibrium.c */
ali3_status ali3_check_start(const ali3_system *s, ali3_message m);
void ali3_start_of_file(ali3_instance *in);
ali3_status ali3_start_in_equilibrium(ali3_instance *in, double t);

/* branch_watch.c */
void ali3_branch_before(ali3_instance *in);
ali3_status ali3_branch_after(ali3_instance *in, double t, double h);
void ali3_branch_look(ali3_instance *in, double t);

/* switches.c */
void ali3_switch_rows(const ali3_instance *in, double *Phi, double *J);
void ali3_switch_values(const ali3_instance *in, double *v);

/* statics.c */
ali3_status ali3_solve_static(ali3_instance *in, double t, double tolerance, int32_t max_iterations);

/* sensors.c */
void ali3_sensors_evaluate(const ali3_instance *in, double *out);
void ali3_quaternion(const ali3_instance *in, const int32_t *v, double n[4]);

/* sensor_tangent.c: change of the sensors along in->tangent */
void ali3_sensors_tangent(const ali3_instance *in, double *out);

/* instance.c */
ali3_status ali3_parameters_apply(ali3_instance *in);
bool ali3_settings_valid(const ali3_settings *s);

/* work.c */
void ali3_work_watch(ali3_instance *in, int32_t e, const double *f, const double *ud, int32_t n);
void ali3_work_keep(const ali3_instance *in, ali3_vectors *v);
void ali3_work_start(const ali3_instance *in, ali3_vectors *v);
void ali3_work_reopen(ali3_instance *in);
void ali3_work_step(ali3_instance *in, double share);
void ali3_work_stage(const ali3_instance *in, double weight, const double *power, double *sum);
void ali3_work_recall(ali3_instance *in);
void ali3_work_first(ali3_instance *in, double weight);
void ali3_work_beside(ali3_instance *in, double dt);
double ali3_work_sum(const ali3_instance *in, int32_t kind, int32_t n, const int32_t *element);
double ali3_work_change(const ali3_instance *in, int32_t kind, int32_t n, const int32_t *element);

/* vectors.c */
double *ali3_take(double **pool, size_t n);
size_t ali3_vector_count(const ali3_system *s); /* doubles in ali3_vectors */
void ali3_vectors_place(const ali3_system *s, ali3_vectors *v, double **pool);
void ali3_vectors_copy(const ali3_instance *in, ali3_vectors *to, const ali3_vectors *from);
void ali3_keep(ali3_instance *in);
ali3_status ali3_accept(ali3_instance *in);

/* inputs.c */
ali3_status ali3_inputs_begin(ali3_instance *in, double t, double h);
ali3_status ali3_inputs_at(ali3_instance *in, double share);
bool ali3_inputs_jump(const ali3_instance *in);
#endif
