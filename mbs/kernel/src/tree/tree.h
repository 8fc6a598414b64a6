/* Relative coordinates along a spanning tree of the bodies, for the semi-recursive method. Quantities are in earth axes
 * with respect to the origin of the earth, in SI units, so that quantities of bodies add up along the tree without
 * transformations. Most are arrays over bodies ("lanes"), body 0 is the ground; loops over lanes have no branches and
 * no dependence between bodies, recursions along the tree have few operations. */
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
  int32_t n, lanes; /* joints, and n + 1 rounded up to a whole number of vectors */
  int32_t n_cut, n_row; /* cut joints and their rows */
  int32_t n_angle; /* relative angles that are coordinates of the System */
  bool slides, asymmetric; /* a joint is prismatic; a body has three different moments of inertia */
  int32_t parent[ALI3_LANES],
      run[ALI3_LANES]; /* run: the lowest of the bodies j, j - 1, .. that are each other's parents */
  ali3_lanes
      base[3][3]; /* [i][k]: component i of axis k of the joint, in the frame of the parent; axis 2: of its motion */
  ali3_lanes place[3]; /* origin of the joint in the frame of the parent */
  ali3_lanes mass, composite, centre[3]; /* kg; kg carried by the joint; m, in the frame of the body */
  ali3_lanes round, first, first_axis[3], second, second_axis[3]; /* kg m^2: round 1 + first e e' + second g g' */
  ali3_lanes turn, slide; /* 1 and 0 for a revolute, 0 and 1 for a prismatic joint */
  double gravity[3]; /* m/s^2 */
};

struct ali3_tree_work {
  ali3_lanes q, qd, sine, cosine; /* joint coordinates, rad or m */
  double relative[ALI3_LANES][3][4]; /* axes and origin of the frame in the frame of the parent */
  /* [b][i]: component i of the axes of body b and of the displacement from its parent */
  double frame[ALI3_LANES][3][4];
  ali3_lanes origin[3]; /* m: of the frames of the bodies */
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
  double largest_term; /* of the sums in w->row, m or 1, by which their round-off is measured */
  double Phi[ALI3_MAX_CUT_ROWS], gamma[ALI3_MAX_CUT_ROWS]; /* m or 1: those rows; per s^2: see ali3_loops_bias */
  int32_t row_order[ALI3_MAX_CUT_ROWS], column_order[ALI3_LANES], rank; /* the first `rank` of both are the chosen */
  double stage[ALI3_STAGES][2 * ALI3_LANES], sum[2 * ALI3_LANES]; /* rates of (q, qd) at the stages of a step */
  double state[2 * ALI3_LANES], qdd[ALI3_LANES]; /* state at the present stage */
  double turned[ALI3_MAX_ANGLES]; /* values of the angles at zero joint coordinates, including whole turns */
};

/* Fills zeroed memory with the tree of a System. */
void ali3_tree_derive(const ali3_system *s, ali3_tree *T);
/* Initialises zeroed work space: the ground, and gravity if the System has no forces that include it. */
void ali3_tree_start(const ali3_system *s, ali3_tree_work *w);

/* Frames and origins of the bodies at w->q. */
void ali3_tree_place(const ali3_tree *T, ali3_tree_work *w);
/* Motion of each body per unit rate of its joint at these frames: w->turn, w->shift. */
void ali3_tree_joints(const ali3_tree *T, ali3_tree_work *w);
/* Velocities of the bodies at w->qd, and the parts of their accelerations that are quadratic in them. */
void ali3_tree_move(const ali3_tree *T, ali3_tree_work *w);
/* Adds the joint accelerations qdd (n) to the accelerations of the bodies and removes the acceleration of the
 * ground. */
void ali3_tree_accelerate(const ali3_tree *T, ali3_tree_work *w, const double *qdd);

/* Relative coordinates and rates x (2 n) of natural ones q, qd (nq). */
void ali3_tree_read(ali3_instance *in, const double *q, const double *qd, double *x);
/* Natural coordinates q and their rates qd, qdd (nq) of the motion in the work space; qd and qdd may be NULL. */
void ali3_tree_write(const ali3_instance *in, double *q, double *qd, double *qdd);
/* Subtracts the generalised forces Q (nq) of natural coordinates from the inertia forces of the bodies. */
void ali3_tree_load(const ali3_instance *in, const double *Q);

/* Inertia of each body about the origin of the earth, and its inertia forces by velocity and gravity. */
void ali3_tree_forces(const ali3_tree *T, ali3_tree_work *w);
/* Adds payloads to both. */
void ali3_tree_payloads(const ali3_instance *in);
/* Composite bodies of the joints, mass matrix w->mass and right side w->load of M qdd = load. */
void ali3_tree_mass(const ali3_tree *T, ali3_tree_work *w);
/* Factorises M in place, M = L' D L; b (n + 1) becomes L'^-1 b. False: M is not positive definite. */
bool ali3_tree_factorise(const ali3_tree *T, ali3_tree_work *w, double *b);
/* b becomes L^-1 D^-1 b. */
void ali3_tree_solve(const ali3_tree *T, const ali3_tree_work *w, double *b);

/* Sets w->turned from natural coordinates q and the relative ones in w->state; relative angles of the System are sums
 * of joint coordinates. */
void ali3_angles_read(const ali3_system *S, ali3_tree_work *w, const double *q);
/* Compensates an angle, rad, subtracted from a joint's coordinate, so that the angles of the System are continuous. */
void ali3_angles_turn(const ali3_system *S, ali3_tree_work *w, int32_t joint, double angle);
/* Writes the angles at w->q, w->qd and w->qdd to natural coordinates; qd and qdd may be NULL. */
void ali3_angles_write(const ali3_system *S, const ali3_tree_work *w, double *q, double *qd, double *qdd);
/* Adds the generalised forces of the angles, Q (nq), to the forces of their joints. */
void ali3_angles_load(const ali3_system *S, ali3_tree_work *w, const double *Q);
/* Adds the inertia of angles to the lower triangle of M. */
void ali3_angles_mass(const ali3_system *S, ali3_tree_work *w);

/* Rows of the cut joints, w->Phi, at the present frames and, with `gradients`, their derivatives w->row by the
 * joints. */
void ali3_loops_rows(const ali3_system *S, ali3_tree_work *w, bool gradients);
/* Chooses independent rows and dependent joints by complete pivoting of the present rows. */
void ali3_loops_choose(const ali3_tree *T, ali3_tree_work *w);
/* Factorises the chosen rows: L U of J_d with inverse pivots on the diagonal, then G in the columns of the other joints
 * (tree_loops.c). */
void ali3_loops_factorise(const ali3_tree *T, ali3_tree_work *w);
/* Second rates of the rows without joint accelerations, w->gamma. */
void ali3_loops_bias(const ali3_system *S, ali3_tree_work *w);
/* Joint accelerations qdd (n) from w->load, w->gamma and M. False: the reduced mass matrix is not positive definite. */
bool ali3_loops_solve(const ali3_tree *T, ali3_tree_work *w, double *qdd);
/* Subtracts from x (n) the smallest change, in the metric of mass, that removes the violation of the chosen rows. */
void ali3_loops_correct(const ali3_tree *T, ali3_tree_work *w, const double *violation, double *x);
#endif
