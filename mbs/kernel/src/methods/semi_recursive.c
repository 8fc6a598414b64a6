/* Semi-recursive formulation: explicit Runge-Kutta methods on the relative coordinates of a spanning tree (J. Garcia de
 * Jalon, E. Bayo, Kinematic and Dynamic Simulation of Multibody Systems, 1994, chapters 5 and 8). Loops are closed by a
 * second transformation to independent rates; positions and velocities are projected onto the rows at the end of a
 * step. The method's state is in the history of in->now; natural coordinates are computed when they are read. */
#include <math.h>
#include <string.h>

#include "../algebra/finite.h"
#include "../elements/forces.h"
#include "../instance.h"
#include "../method.h"
#include "../rows/constraints.h"
#include "../rows/violation.h"
#include "../start/index_one.h"
#include "../state/inputs.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "../tree/tree.h"
#include "check_method.h"
#include "energy_balance.h"
#include "newton.h"
#include "steps.h"
#include "tableau.h"

static const double MAX_ANGLE = 1e4, TWO_PI = 6.283185307179586; /* rad: whole turns of larger angles are removed */
static const double MAX_VIOLATION = 1e3; /* m: a larger violation is divergence */

/* Writes the state of the method to `state`: q, qd, qdd, turned angles, rank, order of rows, order of joints. */
static void store(const ali3_instance *in, double *state) {
  const ali3_tree *T = in->system->tree;
  const ali3_tree_work *w = in->tree;
  const size_t n = (size_t)T->n;
  memcpy(state, w->state, 2 * n * sizeof(double));
  memcpy(state + 2 * n, w->qdd, n * sizeof(double));
  memcpy(state + 3 * n, w->turned, (size_t)T->n_angle * sizeof(double));
  if (T->n_row == 0) return;
  double *order = state + 3 * n + T->n_angle;
  *order++ = w->rank;
  for (int32_t i = 0; i < T->n_row; i++) *order++ = w->row_order[i];
  for (int32_t j = 0; j < T->n; j++) *order++ = w->column_order[j];
}

/* Whether v is a permutation of the n integers first, first + 1, ..., as a restored state may have other values. */
static bool permutation(const double *v, int32_t n, int32_t first, int32_t *out) {
  bool used[ALI3_LANES] = {false};
  for (int32_t i = 0; i < n; i++) {
    if (!(v[i] >= first && v[i] < first + n)) return false;
    out[i] = (int32_t)v[i];
    if (used[out[i] - first]) return false;
    used[out[i] - first] = true;
  }
  return true;
}

/* Sets the tree's state from saved numbers; false: they are invalid. */
static bool restore(const ali3_instance *in, const double *state) {
  const ali3_tree *T = in->system->tree;
  ali3_tree_work *w = in->tree;
  const size_t n = (size_t)T->n;
  memcpy(w->state, state, 2 * n * sizeof(double));
  memcpy(w->qdd, state + 2 * n, n * sizeof(double));
  memcpy(w->turned, state + 3 * n, (size_t)T->n_angle * sizeof(double));
  w->rank = 0;
  if (T->n_row == 0) return true;
  const double *order = state + 3 * n + T->n_angle;
  if (!(order[0] >= 0.0 && order[0] <= T->n_row && order[0] <= T->n)) return false;
  w->rank = (int32_t)order[0];
  return permutation(order + 1, T->n_row, 0, w->row_order) &&
         permutation(order + 1 + T->n_row, T->n, 1, w->column_order);
}

/* Sets joint coordinates and computes the frames. */
static void set_positions(const ali3_instance *in, const double *x) {
  memcpy(in->tree->q + 1, x, (size_t)in->system->tree->n * sizeof(double));
  ali3_tree_place(in->system->tree, in->tree);
}

/* Computes frames, joint motions and the factorised rows at the positions that are set. */
static void factorise_rows(const ali3_instance *in) {
  const ali3_system *S = in->system;
  ali3_tree_joints(S->tree, in->tree);
  if (S->tree->n_row == 0) return;
  ali3_loops_rows(S, in->tree, true);
  ali3_loops_factorise(S->tree, in->tree);
}

/* Joint accelerations at the positions that are set and the rates qd. */
static ali3_status accelerations(ali3_instance *in, const double *qd, double *qdd) {
  const ali3_system *S = in->system;
  const ali3_tree *T = S->tree;
  ali3_tree_work *w = in->tree;
  bool solved;
  memcpy(w->qd + 1, qd, (size_t)T->n * sizeof(double));
  ali3_tree_move(T, w);
  ali3_tree_forces(T, w);
  ali3_tree_payloads(in);
  if (S->size.ne > 0) {
    ali3_vectors *v = &in->next;
    ali3_tree_write(in, v->q, v->qd, NULL);
    const ali3_force_call call = ali3_forces_at(in, v);
    ali3_forces(in, &call);
    ali3_tree_load(in, in->step.Q);
  }
  ali3_tree_mass(T, w);
  ali3_angles_mass(S, w);
  if (S->size.ne > 0) ali3_angles_load(S, w, in->step.Q);
  if (T->n_row > 0) {
    ali3_loops_bias(S, w);
    solved = ali3_loops_solve(T, w, qdd);
  } else {
    solved = ali3_tree_factorise(T, w, w->load);
    ali3_tree_solve(T, w, w->load);
    memcpy(qdd, w->load + 1, (size_t)T->n * sizeof(double));
  }
  in->report.iterations++;
  in->report.factorizations++;
  return solved ? ALI3_OK : ALI3_SINGULAR;
}

/* Computes the state of the method from natural coordinates, after a start or another method. */
static ali3_status start_from_natural(ali3_instance *in) {
  ali3_tree_work *w = in->tree;
  const ali3_tree *T = in->system->tree;
  ali3_tree_read(in, in->now.q, in->now.qd, w->state);
  ali3_angles_read(in->system, w, in->now.q);
  set_positions(in, w->state);
  ali3_tree_joints(T, w);
  if (T->n_row > 0) {
    ali3_loops_rows(in->system, w, true);
    ali3_loops_choose(T, w);
    ali3_loops_factorise(T, w);
  }
  return accelerations(in, w->state + T->n, w->qdd);
}

/* Computes accelerations at the start of a step after a jump of its inputs. */
static ali3_status accelerations_after_jump(ali3_instance *in) {
  ali3_tree_work *w = in->tree;
  set_positions(in, w->state);
  factorise_rows(in);
  return accelerations(in, w->state + in->system->tree->n, w->qdd);
}

/* w->sum = state + h times the weighted sum of the rates of the stages. */
static void combine(const ali3_instance *in, double h, const double *weight, int32_t stages) {
  ali3_tree_work *w = in->tree;
  const int32_t n = 2 * in->system->tree->n;
  double *restrict sum = w->sum;
  for (int32_t i = 0; i < n; i++) sum[i] = 0.0;
  for (int32_t j = 0; j < stages; j++) {
    const double *restrict rate = w->stage[j], a = weight[j];
    if (a == 0.0) continue;
    for (int32_t i = 0; i < n; i++) sum[i] += a * rate[i];
  }
  for (int32_t i = 0; i < n; i++) sum[i] = w->state[i] + h * sum[i];
}

/* Largest absolute value. */
static double largest_size(const double *v, int32_t n) {
  double most = 0.0;
  for (int32_t i = 0; i < n; i++) most = fabs(v[i]) > most ? fabs(v[i]) : most;
  return most;
}

/* Projects positions in w->sum onto the rows with the factors of the last stage, which was at or near the end of the
 * step; then velocities. */
static ali3_status project(ali3_instance *in) {
  const ali3_system *S = in->system;
  const ali3_tree *T = S->tree;
  ali3_tree_work *w = in->tree;
  double *qd = w->sum + T->n;
  for (int32_t sweep = 0;; sweep++) {
    set_positions(in, w->sum);
    if (T->n_row == 0) break;
    ali3_loops_rows(S, w, false);
    const double violation = largest_size(w->Phi, T->n_row);
    in->report.violation = violation;
    if (violation <= S->fine * in->settings.tolerance_phi) break;
    if (sweep == in->settings.max_iterations || !(violation < MAX_VIOLATION)) return ALI3_NOT_CONVERGED;
    ali3_loops_correct(T, w, w->Phi, w->sum);
  }
  factorise_rows(in);
  if (T->n_row == 0) return ALI3_OK;
  for (int32_t i = 0; i < T->n_row; i++) {
    w->gamma[i] = 0.0;
    for (int32_t j = 0; j < T->n; j++) w->gamma[i] += w->row[i][j + 1] * qd[j];
  }
  ali3_loops_correct(T, w, w->gamma, qd);
  ali3_loops_choose(T, w);
  ali3_loops_factorise(T, w);
  return ALI3_OK;
}

/* Writes natural coordinates at the state of the method to v, and what `reading` needs. */
static ali3_status write_natural(ali3_instance *in, ali3_vectors *v, ali3_reading reading, bool controlled) {
  const ali3_system *S = in->system;
  ali3_tree_accelerate(S->tree, in->tree, in->tree->qdd);
  ali3_tree_write(in, v->q, v->qd, v->qdd);
  const bool sensors = reading == ALI3_READ_SENSORS;
  if (controlled && sensors) return ALI3_OK; /* only the motion is read */
  if (sensors && !S->senses_rows && S->size.ne == 0) return ALI3_OK;
  /* multipliers start from zero, so that results do not depend on which states were read */
  memset(v->lam, 0, (size_t)S->size.nc * sizeof(double));
  const ali3_status status = ali3_index_one(in, v);
  if (status != ALI3_OK) return status;
  ali3_tree_write(in, v->q, v->qd, v->qdd); /* the solution for the multipliers has changed them by its error */
  in->report.iterations--; /* only evaluations of the method are counted */
  in->report.violation = ali3_violation(S, in->step.Phi, &in->report.worst_row);
  ali3_rows_times(S, in->tangent.J, v->qd, in->step.mu);
  int32_t worst = 0;
  in->report.velocity_violation = ali3_violation(S, in->step.mu, &worst);
  return ALI3_OK;
}

/* Removes whole turns of rotary joints beyond MAX_ANGLE. */
static void remove_turns(const ali3_system *S, ali3_tree_work *w) {
  for (int32_t j = 0; j < S->tree->n; j++)
    if (fabs(w->state[j]) > MAX_ANGLE && S->tree->slide[j + 1] == 0.0) {
      const double angle = TWO_PI * floor(w->state[j] / TWO_PI + 0.5);
      w->state[j] -= angle;
      w->q[j + 1] = w->state[j];
      ali3_angles_turn(S, w, j + 1, angle);
    }
}

/* Adds the step to the accuracy measures, in the metric of the diagonal of the mass matrix; w->stage[0] has rates and
 * accelerations at the start of the step, w->sum and w->qdd those at its end. */
static void balance(ali3_instance *in, double h) {
  const ali3_tree *T = in->system->tree;
  const ali3_tree_work *w = in->tree;
  const double *v0 = w->stage[0], *a = v0 + T->n, *v1 = w->sum + T->n;
  double speed = 0.0, change = 0.0, miss = 0.0, back = 0.0;
  for (int32_t j = 0; j < T->n; j++) {
    double m = 0.0;
    for (int i = 0; i < 3; i++)
      m += w->angular[i][j + 1] * w->turn[i][j + 1] + w->linear[i][j + 1] * w->shift[i][j + 1];
    const double d = v1[j] - v0[j], e = d - h * a[j], b = d - h * w->qdd[j];
    speed += m * v1[j] * v1[j];
    change += m * d * d;
    miss += m * e * e;
    back += m * b * b;
  }
  ali3_balance_motion(in, speed, change, fmax(miss, back));
}

/* Sets the state of the method at the start of a step: stored, from natural coordinates, or after a jump of inputs. */
static ali3_status start_step(ali3_instance *in) {
  const bool has_state = in->now.history[ALI3_HISTORY_OWNER] == (double)ALI3_METHOD_SEMI_RECURSIVE;
  const ali3_status status = ali3_inputs_at(in, 0.0);
  if (status != ALI3_OK) return status;
  in->inputs.forces = in->inputs.middle;
  if (!(has_state && restore(in, in->now.own))) return start_from_natural(in);
  if (ali3_inputs_jump(in)) return accelerations_after_jump(in);
  ali3_work_recall(in);
  return ALI3_OK;
}

/* Evaluates the rates of all stages of a step. */
static ali3_status evaluate_stages(ali3_instance *in, double h, const ali3_tableau *rule) {
  const int32_t n = in->system->tree->n;
  ali3_tree_work *w = in->tree;
  ali3_status status = ALI3_OK;
  ali3_work_first(in, h * rule->b[0]);
  memcpy(w->stage[0], w->state + n, (size_t)n * sizeof(double));
  memcpy(w->stage[0] + n, w->qdd, (size_t)n * sizeof(double));
  for (int32_t stage = 1; stage < rule->stages && status == ALI3_OK; stage++) {
    combine(in, h, rule->a[stage], stage);
    status = ali3_inputs_at(in, rule->c[stage]);
    if (status != ALI3_OK) break;
    set_positions(in, w->sum);
    factorise_rows(in);
    memcpy(w->stage[stage], w->sum + n, (size_t)n * sizeof(double));
    status = accelerations(in, w->sum + n, w->stage[stage] + n);
    ali3_work_stage(in, h * rule->b[stage], in->watch.now, in->watch.sum);
  }
  return status;
}

/* Sets w->sum at the end of a step, on the rows, and w->qdd there. */
static ali3_status evaluate_end(ali3_instance *in, double h, const ali3_tableau *rule) {
  ali3_tree_work *w = in->tree;
  combine(in, h, rule->b, rule->stages);
  const ali3_status status = project(in);
  return status == ALI3_OK ? accelerations(in, w->sum + in->system->tree->n, w->qdd) : status;
}

/* Copies in->now to in->next, which keeps the outputs of elements: the last stage evaluated them at the end of the
 * step. */
static void copy_but_outputs(ali3_instance *in) {
  const ali3_system *S = in->system;
  const size_t outputs = S->n_contact > 0 ? (size_t)S->size.nout * sizeof(double) : 0;
  memcpy(in->element.out, in->next.out, outputs);
  ali3_vectors_copy(in, &in->next, &in->now);
  memcpy(in->next.out, in->element.out, outputs);
}

/* Makes a step of h from in->now, which changes only if it succeeds. */
static ali3_status step(ali3_instance *in, const ali3_request *request, const ali3_tableau *rule) {
  const ali3_system *S = in->system;
  const int32_t n = S->tree->n;
  const int64_t before = in->report.iterations;
  const double h = request->h;
  const bool read = request->reading != ALI3_READ_NOTHING;
  ali3_tree_work *w = in->tree;
  ali3_status status = start_step(in);
  if (status == ALI3_OK) status = evaluate_stages(in, h, rule);
  in->inputs.forces = in->inputs.set;
  if (status == ALI3_OK) status = evaluate_end(in, h, rule);
  ali3_iterations_since(in, before);
  if (status != ALI3_OK) return status;
  if (!ali3_finite(w->sum, 2 * n) || !ali3_finite(w->qdd, n)) return ALI3_NOT_FINITE;
  balance(in, h);
  memcpy(w->state, w->sum, 2 * (size_t)n * sizeof(double));
  remove_turns(S, w);
  ali3_vectors *v = read ? &in->next : &in->now;
  if (read) copy_but_outputs(in);
  ali3_work_stage(in, 1.0, in->watch.sum, v->work);
  ali3_work_store(in, v);
  if (read) {
    status = write_natural(in, v, request->reading, request->controlled);
    if (status != ALI3_OK) return status;
  }
  store(in, v->own);
  v->history[ALI3_HISTORY_OWNER] = ALI3_METHOD_SEMI_RECURSIVE;
  v->history[ALI3_HISTORY_COUNT] = 0.0;
  v->h_last[0] = 0.0;
  memcpy(v->used, in->inputs.set, (size_t)S->size.nu * sizeof(double));
  return read ? ali3_accept(in) : ALI3_OK;
}

/* Writes the natural coordinates of the last state, after steps that were not read. */
static void report_last(ali3_instance *in) {
  ali3_tree_work *w = in->tree;
  if (!restore(in, in->now.own)) return;
  set_positions(in, w->state);
  ali3_tree_joints(in->system->tree, w);
  memcpy(w->qd + 1, w->state + in->system->tree->n, (size_t)in->system->tree->n * sizeof(double));
  ali3_tree_move(in->system->tree, w);
  ali3_vectors_copy(in, &in->next, &in->now);
  if (write_natural(in, &in->next, ALI3_READ_ALL, false) != ALI3_OK) { /* only the motion is known */
    ali3_tree_write(in, in->next.q, in->next.qd, in->next.qdd);
    memset(in->next.lam, 0, (size_t)in->system->size.nc * sizeof(double));
  }
  ali3_vectors_copy(in, &in->now, &in->next);
}

static ali3_status check_system(const ali3_instance *in) {
  return in->system->tree == NULL ? ALI3_NO_TREE : ali3_needs_no_states(in);
}

static ali3_status step_8(ali3_instance *in, const ali3_request *request) { return step(in, request, &ali3_tableau_8); }

const ali3_method ali3_method_semi_recursive = {.step = step_8,
                                                .check_system = check_system,
                                                .excludes = ALI3_STATES_IN_WORDS,
                                                .after_sampled = report_last,
                                                .owner = ALI3_METHOD_SEMI_RECURSIVE,
                                                .relative = true,
                                                .stable_rate = 5.0,
                                                .round_off = ALI3_ROUND_OFF_INDEX_1};

static ali3_status step_4(ali3_instance *in, const ali3_request *request) { return step(in, request, &ali3_tableau_4); }

const ali3_method ali3_method_semi_recursive_4 = {.step = step_4,
                                                  .check_system = check_system,
                                                  .excludes = ALI3_STATES_IN_WORDS,
                                                  .after_sampled = report_last,
                                                  .owner = ALI3_METHOD_SEMI_RECURSIVE,
                                                  .relative = true,
                                                  .stable_rate = 2.5,
                                                  .round_off = ALI3_ROUND_OFF_INDEX_1};
