/* Code that `mbs.compiler.generated` writes for the algebra of one System. It depends on the structure of the System
 * only and reads all numbers from its arguments, so that all instances of all Systems of that structure share it; it
 * has no memory of its own and has the order of sums of the kernel, so that results are the same bits. For a function
 * that is NULL the kernel uses its loops. Arrays may be read and, if the kernel does so, written one number beyond
 * their end, as by `ali3_three`. */
#ifndef ALI3_GENERATED_H
#define ALI3_GENERATED_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { ALI3_GENERATED_VERSION = 1 };

/* Vectors of four as in GCC and Clang; with other compilers and in WebAssembly the kernel uses its loops. */
#if (defined(__x86_64__) || defined(__aarch64__)) && (defined(__clang__) || (defined(__GNUC__) && __GNUC__ >= 12))
#define ALI3_GENERATES
#endif

/* Terms of the tangent; names as in the System and its instance. */
typedef struct {
  const double *front_mass, *J, *lam; /* of ali3_masses.front; Phi_q in the row pattern; multipliers (nc) */
  const double *s; /* ng: driving functions */
  const double *hess_val, *gterm_h, *angle_hc, *angle_hs, *sig_val; /* of the System */
  const double *S; /* signal tangents of all elements, as in->element.S */
  const double *q; /* shifted near the origin, as for the rows */
  double (*cosine)(double), (*sine)(double); /* ali3_cos and ali3_sin, of rad */
  const unsigned char *idle; /* ne: 1: the tangent of the element is not read */
  double square, geometric; /* weights of J' J and of the second derivatives */
} ali3_tangent_parts;

typedef struct ali3_generated {
  uint32_t version, structure; /* of this table; structure of the System, see `ali3_system_structure` */
  int32_t avx2; /* 1: it has instructions of AVX2 */
  const struct ali3_generated *turned; /* of the same System with all directions of wheel axes; NULL: not generated */
  /* The functions are those of ali3_constraints, ali3_constraint_gamma, ali3_rows_times, ali3_rows_transposed,
   * ali3_constant_mass_times, ali3_active_signals, ali3_add_forces, the tangent of a step, ali3_factorise and
   * ali3_solve; rows and gamma without terms of driving functions and angles. */
  void (*rows)(const double *row_lin, const double *row_const, const double *hess_val, const double *q, double *Phi,
               double *J);
  void (*gamma)(const double *hess_val, const double *qd, double *gamma);
  void (*rows_times)(const double *J, const double *x, double *out);
  void (*rows_transposed)(const double *J, const double *w, double *out);
  void (*mass_times)(const double *mass_val, const double *x, double *out); /* triples have the same values */
  void (*signals)(const double *sig_val, const double *sig_const, const double *q, const double *qd, double *u,
                  double *ud);
  void (*forces)(const double *sig_val, const unsigned char *idle, const double *f, double *Q); /* adds to Q */
  void (*tangent)(const ali3_tangent_parts *parts, double *F);
  /* -1, or the coordinate of the first invalid pivot, which is written to *pivot; counts negative pivots. */
  int32_t (*factorise)(double *F, const double *mass_floor, int32_t *negative, double *pivot);
  void (*solve)(const double *F, double *b);
} ali3_generated;

/* Calls the generated function of that name and is true, if there is one; false for lanes. */
#ifdef ALI3_WIDTH
#define ALI3_GENERATED(system, name, given) false
#else
#define ALI3_GENERATED(system, name, given) ((system)->generated.name != NULL && ((system)->generated.name given, true))
#endif
#endif
