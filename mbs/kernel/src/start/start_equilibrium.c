/* Start in static equilibrium. If parameters change the equilibrium of the file, it is solved again here: at the
 * position of the drawing, on the roads of the file, with the start values of the inputs. The file may give other
 * values of parameters for the search (for example, a drive that pushes has no equilibrium). */
#include <math.h>
#include <string.h>

#include "../elements/signal.h"
#include "../instance.h"
#include "../state/parameters.h"
#include "../state/vectors.h"
#include "initialise.h"

static const double TOLERANCE = 1e-8; /* N, N m */
static const double SAME = 1e-9; /* m: a smaller displacement is round-off, if the file lacks the start of its search */
enum { ITERATIONS = 400 };

/* Sets q as the start of the scene; a pose then rotates each horizontal component by pose_cos and pose_sin. */
static void set_start(ali3_instance *in, const double *q) {
  const ali3_system *S = in->system;
  memcpy(in->start.q, q, (size_t)S->size.nq * sizeof(double));
  for (int32_t i = 0; S->size.has_pose && i < S->size.nq; i++) {
    if (S->pose_partner[i] == 0) {
      const double shifted = S->pose_0[i] + (q[i] - S->q0[i]); /* pose_0 differs from q0 for spins */
      in->start.pose_0[i] = S->pose_0[i] == S->q0[i] ? q[i] : shifted; /* avoids round-off */
    } else {
      in->start.pose_cos[i] = q[i];
      in->start.pose_sin[i] = ali3_turned(S, i, q, false);
    }
  }
}

/* Whether a parameter that writes to anything but roads differs from the file. */
static bool parameters_changed(const ali3_instance *in) {
  const ali3_system *S = in->system;
  for (int32_t p = 0; p < S->size.np; p++)
    for (int32_t k = S->par_ptr[p]; k < S->par_ptr[p + 1]; k++)
      if (S->par_target[k] != ALI3_TARGET_ROAD && in->parameters.value[p] != S->par_value[p]) return true;
  return false;
}

/* Exchanges the roads in use and those of the System. */
static void exchange_roads(ali3_instance *in) {
  ali3_road *road = in->roads.used;
  in->roads.used = in->roads.own;
  in->roads.own = road;
}

/* Sets the roads of the System, its values of parameters and the start values of inputs for the search. The values of
 * the instance are stored in parameters.work and inputs.work. */
static ali3_status prepare(ali3_instance *in) {
  const ali3_system *S = in->system;
  memcpy(in->parameters.work, in->parameters.value, (size_t)S->size.np * sizeof(double));
  memcpy(in->inputs.work, in->inputs.set, (size_t)S->size.nu * sizeof(double));
  for (int64_t i = 0; i < S->n_static_par; i++) in->parameters.value[S->static_par[i]] = S->static_value[i];
  const ali3_status status = ali3_parameters_apply(in);
  ali3_parameters_switch(in);
  exchange_roads(in);
  for (int32_t p = 0; p < S->size.np; p++)
    for (int32_t k = S->par_ptr[p]; k < S->par_ptr[p + 1]; k++)
      if (S->par_target[k] == ALI3_TARGET_ROAD)
        in->parameters.road_parameter[S->par_index[k]] = ali3_parameter_writes(S, k, S->par_value[p]);
  memcpy(in->inputs.set, S->input_start, (size_t)S->size.nu * sizeof(double));
  return status;
}

/* Restores the values of the instance after the search. */
static void restore(ali3_instance *in) {
  const ali3_system *S = in->system;
  memcpy(in->parameters.value, in->parameters.work, (size_t)S->size.np * sizeof(double));
  memcpy(in->inputs.set, in->inputs.work, (size_t)S->size.nu * sizeof(double));
  exchange_roads(in);
  ali3_parameters_apply(in);
  ali3_parameters_switch(in);
}

/* Solves for the equilibrium: coordinates to in->step.stage (nq), states to in->now.y. It starts where the compiler
 * started, so that equal parameters give equal bits in a file and in an instance. */
static ali3_status solve_equilibrium(ali3_instance *in, double t) {
  const ali3_system *S = in->system;
  ali3_vectors_copy(in, &in->stored.whole, &in->now);
  memcpy(in->now.q, S->n_static_q > 0 ? S->static_q : S->q0, (size_t)S->size.nq * sizeof(double));
  const double *y = S->n_static_q > S->size.nq ? S->static_q + S->size.nq : S->y0;
  memcpy(in->now.y, y, (size_t)S->size.ny * sizeof(double));
  const ali3_status status = ali3_solve_static(in, t, TOLERANCE, ITERATIONS);
  memcpy(in->step.stage, in->now.q, (size_t)S->size.nq * sizeof(double));
  memcpy(in->element.y, in->now.y, (size_t)S->size.ny * sizeof(double));
  ali3_vectors_copy(in, &in->now, &in->stored.whole);
  if (status == ALI3_OK) memcpy(in->now.y, in->element.y, (size_t)S->size.ny * sizeof(double));
  if (status == ALI3_OK || status == ALI3_NO_MEMORY) return status;
  return ALI3_NO_EQUILIBRIUM;
}

ali3_status ali3_start_in_equilibrium(ali3_instance *in, double t) {
  const ali3_system *S = in->system;
  if (S->n_static_start == 0 || in->start.placed == ALI3_PLACED_BY_Q) return ALI3_OK;
  const bool needed = parameters_changed(in);
  if (!needed && !in->start.moved) return ALI3_OK;
  memcpy(in->now.y, S->y0, (size_t)S->size.ny * sizeof(double));
  ali3_file_start(in);
  in->start.moved = false;
  if (needed) {
    const ali3_report report = in->report;
    ali3_status status = prepare(in);
    if (status == ALI3_OK) status = solve_equilibrium(in, t);
    restore(in);
    if (status != ALI3_OK) return status;
    in->report = report; /* the search is not part of the run */
    double largest = 0.0;
    for (int32_t i = 0; i < S->size.nq; i++) largest = fmax(largest, fabs(in->step.stage[i] - S->q0[i]));
    in->start.moved = largest > (S->n_static_q > 0 ? 0.0 : SAME);
    if (in->start.moved) set_start(in, in->step.stage);
  }
  if (in->start.placed == ALI3_PLACED_BY_POSE) return ali3_set_pose(in, in->start.pose);
  memcpy(in->now.q, in->start.q, (size_t)S->size.nq * sizeof(double));
  return ALI3_OK;
}
