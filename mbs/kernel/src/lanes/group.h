/* Instances of one System that advance together. A number of a group is one of each lane, side by side; sources written
 * in `real` see in it what they see of an instance, by the same names (see real.h and kernels.h). */
#ifndef ALI3_GROUP_H
#define ALI3_GROUP_H
#include "../algebra/real.h"
#include "../elements/lane_road.h"
#include "../instance.h"

#ifdef ALI3_WIDTH
typedef truth ali3_mask; /* all bits of a lane, or none; counts too */
#else
typedef int64_t ali3_mask;
#endif

typedef struct {
  real *q, *qd, *qdd, *lam;
  real *s, *sd, *sdd; /* guides */
  real *mean, *mean_before;
  real *history, *past_a, *past_lam;
  real *y; /* states of elements */
} ali3_lane_vectors;

typedef struct ali3_lane_group ali3_lane_group;

/* What is compiled for a number of lanes. */
typedef struct ali3_lane_code {
  /* A step of the lanes in group->lanes to group->next; group->good has those that converged. */
  void (*step)(struct ali3_lane_group *group);
  /* n numbers of each lane become those of the group, and back. */
  void (*spread)(double *to, const double *const lane[], int32_t n);
  void (*collect)(double *const lane[], const double *from, int32_t n);
} ali3_lane_code;

struct ali3_lane_group {
  const ali3_system *system;
  const ali3_lane_code *code;
  int32_t width, used; /* lanes, and how many of them have an instance */
  ali3_instance *lane[ALI3_MOST_LANES];
  ali3_settings settings; /* those of all lanes */
  ali3_rule rule;
  double h, alpha;
  ali3_lane_vectors now, next;
  bool mass_isotropic;
  real *mass_val, *mass_floor, *mass_floor_inverse, *gravity_force;
  real *D, *d0, *r, *x, *w, *hat, *Q, *shifted, *correction_q, *step_q; /* nq, as those of an instance */
  real *Phi, *Phit, *gamma, *mu, *lam, *drive, *correction_lam, *step_lam; /* nc */
  real *guide_mean, *guide_follows; /* ng */
  real *J, *J_tangent, *F, *local;
  real *F_new; /* of lanes that get a new tangent while others keep theirs */
  real *u, *ud, *S, *SB;
  ali3_tabled_work *tabled; /* as those of an instance, with numbers of all lanes */
  ali3_tabled_base_work *tabled_base;
  ali3_tabled_parameter_work *tabled_parameter;
  real *tabled_square, *extended[3], *extended_force;
  real *element_force;
  real *ways; /* of elements whose work is watched, see ../state/work.c */
  real *flex, *flex_work, *flex_P, *flex_c; /* of flexible bodies; numbers of the System, the same in all lanes */
  real *stage, *S_tangent, *ud_at; /* of defect_correction.c */
  ali3_mask *idle;
  real *el_real, *input, *out, *potential;
  ali3_lane_road *road;
  bool *by_law; /* ne: the element is computed in vectors */
  real *mean_a, *newton_lam; /* what a step leaves to the history */
  double *discarded; /* where numbers of lanes go that did not make the step */
  /* one each: lanes that make the step, those that the sources count, those that evaluate elements, those that ended */
  ali3_mask *lanes, *at_work, *evaluated, *good, *singular;
  ali3_mask *iterations, *worst_row, *worst_coordinate;
  struct {
    ali3_mask *factorizations, *solves, *negative_pivots;
  } report;
  real *residual, *reach, *violation, *velocity_violation, *open_power, *work, *end, *open, *size, *guides;
  real *gravity_const, *weight; /* energy of gravity without its linear part; at the end of a step */
  real *squares; /* 3, of balance_squares */
};

extern const ali3_lane_code ali3_code_lanes_2, ali3_code_lanes_4, ali3_code_lanes_8;

/* Element e of the lanes in group->evaluated, one by one; f: its forces. */
void ali3_lane_element(ali3_lane_group *group, int32_t e, real *f, bool tangent);
void ali3_lane_elements_accept(ali3_lane_group *group, int32_t lane);
#endif
