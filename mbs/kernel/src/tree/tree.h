/* Relative coordinates along a spanning tree of the bodies, shared by the files of the semi-recursive method.
 * Quantities are in earth axes with respect to the origin of the earth, so that quantities of bodies add up along the
 * tree without transformations. Most are arrays over bodies ("lanes"), body 0 is the ground; loops over lanes have no
 * branches and no dependence between bodies, recursions along the tree have few operations. */
#ifndef ALI3_TREE_H
#define ALI3_TREE_H
#include "../algebra/number_pairs.h"
#include "../instance.h"

enum { ALI3_MAX_JOINTS = 64, ALI3_LANES = 66, ALI3_MAX_CUT_ROWS = 64, ALI3_MAX_ANGLES = 64 };
typedef double ali3_lanes[ALI3_LANES];

/* For loops with independent iterations; not for sums, which it would allow to be reordered. */
#if defined(__clang__)
#define ALI3_FOR_LANES _Pragma("clang loop vectorize(assume_safety) interleave(disable) unroll(disable)")
#else
#define ALI3_FOR_LANES
#endif

struct ali3_tree {
  int32_t n, lanes;         /* joints, and n + 1 rounded up to a whole number of vectors */
  int32_t n_cut, n_row;     /* cut joints and their rows */
  int32_t n_angle;          /* relative angles that are coordinates of the System */
  bool slides, asymmetric;  /* a joint is prismatic; a body has three different moments of inertia */
  int32_t parent[ALI3_LANES],
      run[ALI3_LANES]; /* run: the lowest of the bodies j, j - 1, .. that are each other's parents */
  ali3_lanes base[3][3];    /* [i][k]: component i of axis k of the joint, in the frame of the parent */
  ali3_lanes place[3];      /* origin of the joint in the frame of the parent */
  ali3_lanes mass, composite, centre[3];
  ali3_lanes round, first, first_axis[3], second, second_axis[3]; /* inertia: round 1 + first e e' + second g g' */
  ali3_lanes turn, slide;   /* 1 and 0 for a revolute, 0 and 1 for a prismatic joint */
  double gravity[3];        /* acceleration */
};

struct ali3_tree_work {
  ali3_lanes q, qd, sine, cosine;
  double relative[ALI3_LANES][3][4];      /* axes and origin of the frame in the frame of the parent */
  /* [b][i]: component i of the axes of body b and of the displacement from its parent */
  double frame[ALI3_LANES][3][4];
  ali3_lanes origin[3];
  ali3_lanes turn[3], shift[3]; /* motion per unit rate of the joint: angular, and linear at the earth's origin */
  ali3_lanes spin[3], drift[3]; /* angular velocity, linear velocity at the earth's origin */
  ali3_lanes spin_rate[3], drift_rate[3]; /* their rates without joint accelerations, minus gravity */
  ali3_lanes inertia[6], moment[3]; /* xx, yy, zz, yz, zx, xy about the earth's origin, mass times centre: composite */
  ali3_lanes torque[3], force[3]; /* of inertia and gravity without the joint accelerations: composite */
  ali3_lanes angular[3], linear[3]; /* composite momentum per unit rate of the joint */
  ali3_lanes composite; /* mass carried by each joint */
  ali3_lanes load; /* right side of M qdd = load */
  double gravity[3]; /* zero if the forces of the System include it */
  double mass[ALI3_MAX_JOINTS + 1][ALI3_LANES]; /* M, lower triangle; zero between joints on different branches */
  double dense[ALI3_MAX_JOINTS + 1][ALI3_LANES]; /* a matrix and its factors */
  double product[ALI3_MAX_JOINTS + 1][ALI3_LANES]; /* M times the columns of the null space */
  double row[ALI3_MAX_CUT_ROWS][ALI3_LANES]; /* Jacobian of the rows of the cut joints */
  double upper[ALI3_MAX_CUT_ROWS][ALI3_LANES]; /* factors of the chosen rows */
  double Phi[ALI3_MAX_CUT_ROWS], gamma[ALI3_MAX_CUT_ROWS];
  int32_t row_order[ALI3_MAX_CUT_ROWS], column_order[ALI3_LANES], rank; /* the first `rank` of both are the chosen */
  double stage[ALI3_STAGES][2 * ALI3_LANES], sum[2 * ALI3_LANES]; /* rates of (q, qd) at the stages of a step */
  double state[2 * ALI3_LANES], qdd[ALI3_LANES]; /* state at the present stage */
  double turned[ALI3_MAX_ANGLES]; /* values of the angles at zero joint coordinates, including whole turns */
};

/* tree_derive.c */
void ali3_tree_derive(const ali3_system *s, ali3_tree *T);
void ali3_tree_start(const ali3_system *s, ali3_tree_work *w);

/* tree.c: frames at w->q, motions of the joints there, velocities at w->qd, accelerations */
void ali3_tree_place(const ali3_tree *T, ali3_tree_work *w);
void ali3_tree_joints(const ali3_tree *T, ali3_tree_work *w);
void ali3_tree_move(const ali3_tree *T, ali3_tree_work *w);
void ali3_tree_accelerate(const ali3_tree *T, ali3_tree_work *w, const double *qdd);

/* tree_natural.c: relative coordinates x (2 n, with rates) from natural ones and to them, and their forces */
void ali3_tree_read(ali3_instance *in, const double *q, const double *qd, double *x);
void ali3_tree_write(const ali3_instance *in, double *q, double *qd, double *qdd);
void ali3_tree_load(const ali3_instance *in, const double *Q);

/* tree_dynamics.c: inertia and inertia forces of the bodies, then the mass matrix and the right side; M qdd = load */
void ali3_tree_forces(const ali3_tree *T, ali3_tree_work *w);
void ali3_tree_payloads(const ali3_instance *in);
void ali3_tree_mass(const ali3_tree *T, ali3_tree_work *w);
bool ali3_tree_factorise(const ali3_tree *T, ali3_tree_work *w, double *b);
void ali3_tree_solve(const ali3_tree *T, const ali3_tree_work *w, double *b);

/* tree_angles.c: relative angles, sums of joint coordinates */
void ali3_angles_read(const ali3_system *S, ali3_tree_work *w, const double *q);
void ali3_angles_turn(const ali3_system *S, ali3_tree_work *w, int32_t joint, double angle);
void ali3_angles_write(const ali3_system *S, const ali3_tree_work *w, double *q, double *qd, double *qdd);
void ali3_angles_load(const ali3_system *S, ali3_tree_work *w, const double *Q);
void ali3_angles_mass(const ali3_system *S, ali3_tree_work *w);

/* tree_loops.c: rows of the cut joints */
void ali3_loops_rows(const ali3_system *S, ali3_tree_work *w, bool gradients);
void ali3_loops_choose(const ali3_tree *T, ali3_tree_work *w);
void ali3_loops_factorise(const ali3_tree *T, ali3_tree_work *w);
void ali3_loops_bias(const ali3_system *S, ali3_tree_work *w);
bool ali3_loops_solve(const ali3_tree *T, ali3_tree_work *w, double *qdd);
void ali3_loops_correct(const ali3_tree *T, ali3_tree_work *w, const double *violation, double *x);
#endif
