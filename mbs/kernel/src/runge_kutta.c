/* Explicit Runge-Kutta method of order eight with twelve stages (coefficients of Dormand and Prince, in Hairer, Norsett,
 * Wanner, "Solving Ordinary Differential Equations I", second edition) on the equations of index one: every stage solves
 * for accelerations and multipliers, positions and velocities return to the rows at the end of a step. For smooth
 * motion without stiff forces, away from singular positions; the last stage of a step is the first of the next. */
#include <string.h>

#include "ali3_internal.h"

enum { STAGES = ALI3_STAGES, SOLVES = 2, SWEEPS = 3 };
static const double ALPHA = 1e8; /* of mass-normalised rows, with unit weight of M */
static const double VELOCITY_TOLERANCE = 1e-12;

static const double node[STAGES] = {0.0,
                                    0.05260015195876773,
                                    0.0789002279381516,
                                    0.1183503419072274,
                                    0.2816496580927726,
                                    0.3333333333333333,
                                    0.25,
                                    0.3076923076923077,
                                    0.6512820512820513,
                                    0.6,
                                    0.8571428571428571,
                                    1.0};
static const double weight[STAGES] = {0.054293734116568765,
                                      0.0,
                                      0.0,
                                      0.0,
                                      0.0,
                                      4.450312892752409,
                                      1.8915178993145003,
                                      -5.801203960010585,
                                      0.3111643669578199,
                                      -0.1521609496625161,
                                      0.20136540080403034,
                                      0.04471061572777259};
static const double stage_weight[STAGES][STAGES] = {
    {0.0},
    {0.05260015195876773},
    {0.0197250569845379, 0.0591751709536137},
    {0.02958758547680685, 0.0, 0.08876275643042054},
    {0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792},
    {0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242},
    {0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125},
    {0.03709200011850479, 0.0, 0.0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
     0.008273789163814023},
    {0.6241109587160757, 0.0, 0.0, -3.3608926294469414, -0.868219346841726, 27.59209969944671, 20.154067550477894,
     -43.48988418106996},
    {0.47766253643826434, 0.0, 0.0, -2.4881146199716677, -0.590290826836843, 21.230051448181193, 15.279233632882423,
     -33.28821096898486, -0.020331201708508627},
    {-0.9371424300859873, 0.0, 0.0, 5.186372428844064, 1.0914373489967295, -8.149787010746927, -18.52006565999696,
     22.739487099350505, 2.4936055526796523, -3.0467644718982196},
    {2.273310147516538, 0.0, 0.0, -10.53449546673725, -2.0008720582248625, -17.9589318631188, 27.94888452941996,
     -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636},
};

/* Accelerations and multipliers at q, qd and the guides of v: v->qdd and v->lam are improved from what they hold. */
static ali3_status accelerate(ali3_instance *in, ali3_vectors *v) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  ali3_constraints(in, v->q, v->s, in->Phi, in->J);
  ali3_constraint_gamma(in, v->q, v->qd, v, in->gamma);
  const ali3_force_call call = {v->q, v->qd, in->now.y, 0.0, 0.0, 0.0, false, in->Q, v->y, v->out, v->potential};
  ali3_forces(in, &call);
  memcpy(in->F, S->front_mass, (size_t)S->size.front_size * sizeof(double));
  if (S->n_flexible > 0) ali3_flexible_tangent(in, 1.0, 0.0, 0.0, in->F);
  ali3_rows_square(in, in->J, ALPHA, in->F);
  const ali3_status status = ali3_factorise(in, in->F);
  if (status != ALI3_OK) return status;
  for (int solve = 0; solve < SOLVES; solve++) {
    ali3_rows_times(S, in->J, v->qdd, in->mu);
    for (int32_t k = 0; k < nc; k++) in->mu[k] = v->lam[k] + ALPHA * (in->mu[k] + in->gamma[k]);
    ali3_rows_transposed(S, in->J, in->mu, in->x);
    ali3_mass_times(in, v->qdd, in->r);
    for (int32_t i = 0; i < nq; i++) in->x[i] = in->Q[i] - in->r[i] - in->x[i];
    ali3_solve(in, in->F, in->x);
    for (int32_t i = 0; i < nq; i++) v->qdd[i] += in->x[i];
    ali3_rows_times(S, in->J, in->x, v->lam);
    for (int32_t k = 0; k < nc; k++) v->lam[k] = in->mu[k] + ALPHA * v->lam[k];
  }
  in->report.iterations++;
  return ali3_finite(v->qdd, nq) ? ALI3_OK : ALI3_NOT_FINITE;
}

/* Where stage `stage` looks: positions and velocities from the accelerations of the stages before it. `row` are its
 * weights, `second` those of the double integral. */
static void combine(ali3_instance *in, double h, double time, const double *row, int stages) {
  const int32_t nq = in->system->size.nq;
  double second[STAGES] = {0.0};
  for (int i = 0; i < stages; i++)
    for (int j = 0; j < i; j++) second[j] += row[i] * stage_weight[i][j];
  for (int32_t i = 0; i < nq; i++) {
    in->next.qd[i] = 0.0;
    in->next.q[i] = 0.0;
  }
  for (int j = 0; j < stages; j++) {
    const double *restrict a = in->stage + (int64_t)j * nq, first = row[j], twice = second[j];
    if (first == 0.0 && twice == 0.0) continue;
    for (int32_t i = 0; i < nq; i++) {
      in->next.qd[i] += first * a[i];
      in->next.q[i] += twice * a[i];
    }
  }
  for (int32_t i = 0; i < nq; i++) {
    in->next.q[i] = in->now.q[i] + h * (time * in->now.qd[i] + h * in->next.q[i]);
    in->next.qd[i] = in->now.qd[i] + h * in->next.qd[i];
  }
}

/* Back to Phi = 0 and Phi_q qd + Phi_t = 0 with the tangent of the last stage, which was at the end of the step too. */
static ali3_status close(ali3_instance *in) {
  const ali3_system *S = in->system;
  ali3_vectors *v = &in->next;
  memcpy(in->J_tangent, in->J, (size_t)S->size.nnz_rows * sizeof(double));
  for (int sweep = 0;; sweep++) {
    ali3_constraints(in, v->q, v->s, in->Phi, in->J);
    in->report.violation = ali3_violation(S, in->Phi, &in->report.worst_row);
    if (ali3_closed(S, in->Phi, in->settings.tolerance_phi)) break;
    if (sweep == in->settings.max_iterations || !(in->report.violation < 1e300)) return ALI3_NOT_CONVERGED;
    for (int32_t k = 0; k < S->size.nc; k++) in->mu[k] = ALPHA * in->Phi[k];
    ali3_rows_transposed(S, in->J_tangent, in->mu, in->x);
    ali3_solve(in, in->F, in->x);
    for (int32_t i = 0; i < S->size.nq; i++) v->q[i] -= in->x[i];
  }
  ali3_constraint_rate(in, v->q, v, in->Phit);
  in->report.velocity_violation = ali3_project(in, ALPHA, in->Phit, v->qd, NULL, VELOCITY_TOLERANCE, SWEEPS);
  return ALI3_OK;
}

/* From in->now to in->next; in->now changes only when the step is good. t is the time at its end. */
ali3_status ali3_runge_kutta(ali3_instance *in, double t, double h) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  const int64_t before = in->report.iterations;
  ali3_vectors *from = &in->now, *to = &in->next;
  ali3_switch_carry(in);
  memcpy(in->stage, from->qdd, (size_t)nq * sizeof(double));
  memcpy(to->qdd, from->qdd, (size_t)nq * sizeof(double));
  memcpy(to->lam, from->lam, (size_t)S->size.nc * sizeof(double));
  memcpy(to->used, in->input, (size_t)S->size.nu * sizeof(double));
  ali3_status status = ALI3_OK;
  in->force_input = in->input_middle;
  for (int stage = 1; stage < STAGES && status == ALI3_OK; stage++) {
    combine(in, h, node[stage], stage_weight[stage], stage);
    for (int32_t i = 0; i < S->size.nu; i++)
      in->input_middle[i] = from->used[i] + node[stage] * (in->input[i] - from->used[i]);
    ali3_guides_time(in, to, t - (1.0 - node[stage]) * h);
    status = accelerate(in, to);
    memcpy(in->stage + (int64_t)stage * nq, to->qdd, (size_t)nq * sizeof(double));
  }
  in->force_input = in->input;
  if (status == ALI3_OK) {
    combine(in, h, 1.0, weight, STAGES);
    ali3_guides_time(in, to, t);
    status = close(in);
  }
  if (status == ALI3_OK) status = accelerate(in, to);
  in->report.last_iterations = (int32_t)(in->report.iterations - before);
  if (in->report.last_iterations > in->report.max_iterations) in->report.max_iterations = in->report.last_iterations;
  if (status != ALI3_OK) return status;
  to->memory[ALI3_MEMORY_OWNER] = ALI3_METHOD_RUNGE_KUTTA_8;
  for (int32_t i = 0; i < nq; i++) in->D[i] = to->q[i] - from->q[i];
  ali3_predict_accept(in, h);
  to->h_last[0] = 0.0;
  if (!ali3_finite(to->q, (int64_t)in->n_vector)) return ALI3_NOT_FINITE;
  const ali3_vectors swap = in->now;
  in->now = in->next;
  in->next = swap;
  return ALI3_OK;
}
