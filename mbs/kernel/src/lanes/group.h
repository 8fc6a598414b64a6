/* A group of instances of one System that advance together, each in a lane of the processor's vectors. A `real` of the
 * group has one number of each lane. Sources written in `real` are compiled for instances and for groups, whose members
 * have the same names (see real.h and kernels.h). */
#ifndef ALI3_GROUP_H
#define ALI3_GROUP_H
#include "../algebra/real.h"
#include "../elements/lane_road.h"
#include "../instance.h"

#ifdef ALI3_WIDTH
typedef lane_mask ali3_mask; /* all bits of a lane or none; also counters */
#else
typedef int64_t ali3_mask;
#endif

/* Vectors of a state, as in ali3_vectors, for all lanes. */
typedef struct {
  real *q, *qd, *qdd, *lam;
  real *s, *sd, *sdd; /* driving functions */
  real *mean, *mean_before; /* of `now` in Systems with flexible bodies */
  real *history, *past_a, *past_lam; /* of `now` in the others */
  real *y; /* states of elements */
} ali3_lane_vectors;

typedef struct ali3_lane_group ali3_lane_group;

/* Functions compiled for one number of lanes. */
typedef struct ali3_lane_code {
  /* Makes a step of the lanes in group->lanes to group->next; group->good marks those that converged. */
  void (*step)(struct ali3_lane_group *group);
  /* Copies n numbers of each lane to the group, where number i of all lanes is contiguous. */
  void (*spread)(double *to, const double *const lane[], int32_t n);
  void (*collect)(double *const lane[], const double *from, int32_t n); /* and back */
} ali3_lane_code;

struct ali3_lane_group {
  const ali3_system *system; /* of all lanes */
  const ali3_lane_code *code; /* for `width` */
  int32_t width, used; /* number of lanes, and of lanes with an instance */
  ali3_instance *lane[ALI3_MAX_LANES]; /* the first `used`: their instances */
  ali3_settings settings; /* the same for all lanes */
  ali3_rule rule; /* of the step, the same for all lanes */
  double h, alpha; /* s; 1/s^2, penalty of the rows */
  ali3_lane_vectors now, next; /* start and end of the step */
  struct {
    real *val, *floor, *floor_inverse, *gravity, *gravity_const;
    bool isotropic;
  } mass; /* this and the following members are as in an instance, for all lanes */
  struct {
    real *D, *d0, *r, *x, *w, *hat, *Q, *stage, *shifted, *Phi, *Phit, *gamma, *mu, *lam, *drive;
  } step;
  struct {
    real *correction_q, *step_q, *correction_lam, *step_lam;
  } mixing;
  struct {
    real *J, *J_made, *F, *local;
    real *F_new; /* tangent of lanes that need a new one while others reuse the old one */
  } tangent;
  struct {
    real *u, *ud, *force, *S, *SB, *S_made, *ud_at;
    ali3_mask *idle;
  } element;
  struct {
    real *prepared, *work;
    real *P, *c; /* numbers of the System, the same in all lanes */
  } flexible;
  struct {
    ali3_lookup_work *item;
    ali3_lookup_base_work *base;
    ali3_lookup_parameter_work *parameter;
    real *square, *extended[3], *force;
  } lookup;
  struct {
    real *mean, *follows;
  } driving;
  real *ways; /* n_work_force: displacements of elements whose work is summed, see ../state/work.c */
  real *el_parameter, *input, *out, *potential; /* as el_parameter of the System; nu; nout; ne, J */
  ali3_lane_road *road; /* nr */
  bool *by_law; /* ne: the element is evaluated in vectors */
  real *mean_a, *newton_lam; /* of the last step, for the history */
  double *discarded; /* receives the numbers of lanes without a completed step */
  /* masks of lanes: in the step, counted in the report, evaluating elements, converged, with a singular tangent */
  ali3_mask *lanes, *at_work, *evaluated, *good, *singular;
  ali3_mask *iterations, *worst_row, *worst_coordinate; /* of the step: counts, indices */
  struct {
    ali3_mask *factorizations, *solves, *negative_pivots; /* as in ali3_report */
  } report;
  real *residual, *violation, *velocity_violation, *open_power; /* as in ali3_report */
  real *reach; /* as in ali3_element_args */
  real *work, *end, *open, *size; /* error, end, open and size of ali3_energy_judge */
  real *driving_work; /* J: work of driving functions in the step */
  real *weight; /* J: potential energy of gravity at the end of the step */
  real *squares; /* 3: speed, change and miss of ali3_balance_motion */
};

extern const ali3_lane_code ali3_code_lanes_2, ali3_code_lanes_4, ali3_code_lanes_8;

/* Evaluates element e of the lanes in g->evaluated, one lane after the other; f: its forces. */
void ali3_lane_element(ali3_lane_group *g, int32_t e, real *f, bool tangent);
/* ali3_is_abrupt of a lane at the present iterate of its whole step. */
bool ali3_lane_is_abrupt(const ali3_lane_group *g, int32_t lane);
/* Makes discrete changes of the elements of a lane after an accepted step. */
void ali3_lane_elements_accept(ali3_lane_group *g, int32_t lane);
#endif
