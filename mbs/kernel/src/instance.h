/* The instance of a System: its state, settings and work space. */
#ifndef ALI3_INSTANCE_H
#define ALI3_INSTANCE_H
#include <stdbool.h>

#include "system.h"

typedef struct { /* nnz_mass, front_size, nq each */
  double *val, *front, *floor, *floor_inverse, *missing, *gravity;
} ali3_masses;

typedef struct ali3_road ali3_road;           /* elements/road.h */
typedef struct ali3_tabled_work ali3_tabled_work; /* tabled/tabled.h */
typedef struct ali3_tabled_base_work ali3_tabled_base_work;
typedef struct ali3_tabled_parameter_work ali3_tabled_parameter_work;
typedef struct ali3_tree_work ali3_tree_work; /* tree/tree.h: their work space */

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
  double *history; /* of a method: whose it is (ALI3_METHOD_*), count of past steps, their middles relative to now, s */
  double *own; /* nq: velocity (energy-momentum) or algorithmic acceleration (generalised-alpha) */
  double *past_a, *past_lam; /* ALI3_PAST x nq, x nc: mean accelerations and multipliers of past steps, newest first */
  /* work.c: since the start; potential at the start; power, then forces, at the end of the last step; of the last step
   * mean forces, ways of their signals */
  double *work, *stored, *watched, *step_force, *step_way;
  double *by_inputs; /* n_input_work: what jumps of inputs since the start added to the stored energy */
} ali3_vectors;

enum { ALI3_STAGES = 12, ALI3_RADAU = 3, ALI3_LOCAL = 12 }; /* of runge_kutta.c, radau.c, fronts.c */
enum { ALI3_PAST = 4, ALI3_HISTORY_OWNER = 0, ALI3_HISTORY_COUNT, ALI3_HISTORY_TIME, ALI3_HISTORY = 2 + ALI3_PAST };

/* A step rule in the increment D: qd = rate D + hat, qdd = (D - d0) / c; element tangents weigh C with wC, K with c. */
typedef struct {
  double c, rate, wC;
} ali3_rule;

struct ali3_instance {
  const ali3_system *system; /* base, or turned where axes are not as drawn */
  const ali3_system *base; /* as loaded */
  ali3_system *turned; /* axes.c: with coefficients and moments of mass of its own */
  double *turned_val, *turned_const, *turned_entry, *turned_mass, *turned_speed;
  ali3_tabled *turned_tabled;
  void (*release)(void *block);
  ali3_settings settings;
  ali3_report report;
  ali3_report report_before; /* of the step that branch_watch.c may repeat */
  double t_base, h_last; /* time = t_base + count * h_last */
  double event; /* the share of the present part at which a stop is met or left, see contact_event.c */
  int32_t events_left; /* at which the present step may still be parted; below 0: it is not parted there at all */
  double changed; /* largest change of a judged force in the step, of ali3_divides; below 0: not known */
  int64_t count, iterations_before; /* of steps of h_last, and report.iterations where the present step began */
  int64_t *work_left; /* of the caller's call, see ali3_count_work; or NULL */
  int32_t initialised;
  /* start: of a step that may be halved; whole: of a composed one; direction: one in the space of states */
  ali3_vectors now, next, start, whole, direction;
  ali3_vectors origin, centre, coarse; /* of a controlled step: its start, its centre, its end by one whole step */
  ali3_rule rule;
  bool capped; /* the present step ends at settings.step_iterations, */
  double capped_residual; /* and leaves this, m */
  double call_residual; /* the largest of the steps of a call */
  bool backed_up; /* in->start holds the state before the step */
  size_t n_vector;
  double *input, *input_work, *parameter, *input_middle;
  const double *force_input; /* inputs that elements use: input, or input_middle where the middle is evaluated */
  double *el_real, *guide_real, *road_real, *payload_mass, *switch_on, *armature_ratio, *inertia_real, *axis_real,
      *sen_real; /* copies that parameters write to */
  /* masses.c: mass matrix as mass_val and as the start of every tangent, what else the System has of it, gravity; those
   * of the System where nothing changes them */
  const double *mass_val, *front_mass, *mass_floor, *mass_floor_inverse, *mass_missing, *gravity_force;
  bool mass_isotropic; /* see ali3_mass_isotropic */
  double gravity_const;
  ali3_masses own_masses; /* with payloads and armatures; empty where there are none */
  ali3_road *road, *own_road; /* in use: the System's own or from files; the System's own */
  int32_t n_roads; /* the System may be gone before its instances */
  bool to_lift; /* the next start is at a place of which it is not known how high its road is */
  double unsettled; /* m/s: what the last settled start had left */
  double lift, uneven; /* of start_on_road.c, m: what raised the start; how far above its rest the highest part is */
  /* work space */
  double *D, *d0, *r, *x, *w, *hat; /* nq */
  double *stage; /* ALI3_STAGES x nq: accelerations, of radau.c residuals too */
  double *middle, *rate; /* nq: position and velocity in the middle of the step */
  double *J0, *A, *A_tangent; /* row pattern: Phi_q at the start, discrete derivative, where F was made */
  double *at_J0; /* nq, ng, switches: where J0 was made */
  bool has_J0;
  double *Phi, *Phit, *gamma, *mu, *lam; /* nc */
  double *drive, *guide_mean; /* nc: work of drives by a unit of the multipliers at the end; ng: mean rates of guides */
  double *guide_jump; /* 2 ng: of rate and acceleration of guides of time, the least jump that ends a step */
  double *guide_follows; /* ng: 1 where a filtered guide moves in the step, else 0 */
  double *J, *J_tangent; /* row pattern: Phi_q at the iterate, and where the tangent was made */
  double *F; /* front storage */
  double *Q; /* nq */
  double *u, *ud; /* signals */
  double *S; /* signal tangents of all elements */
  double *S_tangent, *ud_at; /* of defect_correction.c: S of the tangent in F; ud of the last ali3_forces */
  double *element_force; /* of the last ali3_forces, by the signals of each element */
  double *SB; /* one element: signals x coordinates */
  unsigned char *idle; /* ne: 1 where the last ali3_forces met no force and no tangent */
  double *correction_q, *step_q, *correction_lam, *step_lam; /* of the last iteration */
  double *local; /* ALI3_LOCAL columns of a front */
  double *shifted; /* nq */
  double *flex, *flex_work; /* flexible bodies: at the last q prepared; scratch */
  ali3_tabled_work *tabled; /* at the last q prepared */
  ali3_tabled_base_work *tabled_base;
  ali3_tabled_parameter_work *tabled_parameter;
  double *tabled_square; /* of one group of elements */
  double *extended[3], *extended_force; /* q, qd, qdd and forces on them, with the dependents behind */
  double wC, wK; /* weights of the last forces */
  /* of radau.c, empty where there are element states or filtered guides: stages of the rows, of Phi_q, of where the
   * tangent saw it, of corrections */
  double *stage_Phi, *stage_lam, *stage_J, *stage_J_tangent, *stage_x;
  double *F_stages, *F_C, *F_K; /* tangent of all stages, front storage of dampers and of springs and rows */
  double *y_work, *out_work, *potential_work, *parameter_work;
  ali3_tree_work *tree;
  /* inputs.c: the function that is called; of a whole step as asked for: inputs at both ends, its start, its length; of
   * the present part of it: inputs at the start, its start, its length; the time of in->now */
  ali3_input_function *input_function;
  ali3_float_control host_control; /* of the caller, for this function; 0: the same, see api/entries.c */
  void *input_context;
  const double *input_break; /* n_breaks: times at which steps are parted */
  int64_t n_breaks;
  double *input_from, *input_to, *input_begin, *stage_input; /* nu; of the stages of radau.c */
  double whole_time, whole_length, input_time, input_length, t_now;
  /* of branch_watch.c, signed squares: sines and cosines of the triads at in->now; sines before the step, after it,
   * after it in parts; loops that left their modes */
  double *mode_sine, *mode_cosine, *sine_before, *sine_after, *sine_few, *mode_left;
  ali3_vectors before; /* the state before a step where branches may be near */
  bool mode_known, branch_near;
  /* of start_equilibrium.c: where a start is and how a pose moves it; the last pose; who placed the present start */
  double *start_q, *pose_0, *pose_cos, *pose_sin, pose[ALI3_POSE];
  int32_t placed;
  bool start_moved; /* not as in the file */
  double *watched, *work_sum, *stage_power; /* work.c: of the last ali3_forces; of the stages of a step */
};

enum { ALI3_PLACED_BY_FILE = 0, ALI3_PLACED_BY_POSE, ALI3_PLACED_BY_Q };
#endif
