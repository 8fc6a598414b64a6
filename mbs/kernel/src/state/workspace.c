/* What an instance needs of memory: one function places it, walked once to count and once to place. */
#include "workspace.h"

#include "../elements/road.h"
#include "../flexible/body_arrays.h"
#include "../rows/assembly_mode.h"
#include "../system/without_states.h"
#include "../tabled/tabled.h"
#include "../tree/tree.h"
#include "axes.h"
#include "masses.h"
#include "vectors.h"

/* Signals times coordinates of the largest element. */
size_t ali3_signal_work(const ali3_system *s) {
  size_t largest = 0;
  for (int32_t e = 0; e < s->size.ne; e++) {
    const size_t n = (size_t)(s->el_sig_ptr[e + 1] - s->el_sig_ptr[e]);
    const size_t m = (size_t)(s->el_coordinate_ptr[e + 1] - s->el_coordinate_ptr[e]);
    if (n * m > largest) largest = n * m;
  }
  return largest;
}

static void place_state(const ali3_system *s, ali3_vectors *v, ali3_pool *p) {
  ali3_vectors_place(s, v, p);
  ali3_pool_gap(p);
}

static void place_states(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  place_state(s, &in->now, p);
  place_state(s, &in->next, p);
  place_state(s, &in->start, p);
  place_state(s, &in->whole, p);
  place_state(s, &in->direction, p);
  place_state(s, &in->origin, p);
  place_state(s, &in->centre, p);
  place_state(s, &in->coarse, p);
}

/* Inputs, parameters and the data that parameters write to. */
static void place_data(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const size_t nu = (size_t)s->size.nu, np = (size_t)s->size.np;
  in->input = ali3_pool_array(p, nu);
  in->input_work = ali3_pool_array(p, nu);
  in->input_middle = ali3_pool_array(p, nu);
  in->input_from = ali3_pool_array(p, nu);
  in->input_to = ali3_pool_array(p, nu);
  in->input_begin = ali3_pool_array(p, nu);
  in->stage_input = ali3_pool_array(p, ALI3_RADAU * nu);
  in->parameter = ali3_pool_array(p, np);
  in->parameter_work = ali3_pool_array(p, np);
  in->el_real = ali3_pool_array(p, (size_t)s->n_el_real);
  in->sen_real = ali3_pool_array(p, (size_t)s->n_sen_real);
  in->guide_real = ali3_pool_array(p, (size_t)s->n_guide_real);
  in->guide_jump = ali3_pool_array(p, 2 * (size_t)s->size.ng);
  in->switch_on = ali3_pool_array(p, (size_t)s->size.n_switch);
  in->road_real = ali3_pool_array(p, (size_t)s->n_road_real);
  ali3_masses_place(s, in, p);
  ali3_axes_place(s, in, p);
}

/* Coordinates and rows of a step. */
static void place_step(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const size_t nq = (size_t)s->size.nq, nc = (size_t)s->size.nc;
  in->D = ali3_pool_padded(p, nq);
  in->d0 = ali3_pool_padded(p, nq);
  in->r = ali3_pool_padded(p, nq);
  in->x = ali3_pool_padded(p, nq);
  in->w = ali3_pool_padded(p, nq);
  in->shifted = ali3_pool_padded(p, nq);
  in->hat = ali3_pool_padded(p, nq);
  in->middle = ali3_pool_padded(p, nq);
  in->rate = ali3_pool_padded(p, nq);
  in->stage = ali3_pool_padded(p, ALI3_STAGES * nq);
  in->Q = ali3_pool_array(p, nq);
  in->Phi = ali3_pool_array(p, nc);
  in->Phit = ali3_pool_array(p, nc);
  in->gamma = ali3_pool_array(p, nc);
  in->mu = ali3_pool_array(p, nc);
  in->drive = ali3_pool_array(p, nc);
  in->guide_mean = ali3_pool_array(p, (size_t)s->size.ng);
  in->guide_follows = ali3_pool_array(p, (size_t)s->size.ng);
  in->lam = ali3_pool_array(p, nc);
  in->correction_q = ali3_pool_padded(p, nq);
  in->step_q = ali3_pool_padded(p, nq);
  in->correction_lam = ali3_pool_array(p, nc);
  in->step_lam = ali3_pool_array(p, nc);
}

/* Jacobians, signals and tangents. */
static void place_tangents(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const ali3_sizes *z = &s->size;
  in->J = ali3_pool_padded(p, (size_t)z->nnz_rows);
  in->J_tangent = ali3_pool_padded(p, (size_t)z->nnz_rows);
  in->J0 = ali3_pool_padded(p, (size_t)z->nnz_rows);
  in->at_J0 = ali3_pool_array(p, (size_t)z->nq + (size_t)z->ng + (size_t)z->n_switch);
  in->A = ali3_pool_padded(p, (size_t)z->nnz_rows);
  in->A_tangent = ali3_pool_padded(p, (size_t)z->nnz_rows);
  in->F = ali3_pool_array(p, (size_t)z->front_size);
  in->u = ali3_pool_array(p, (size_t)z->nsig);
  in->ud = ali3_pool_array(p, (size_t)z->nsig);
  in->S = ali3_pool_array(p, (size_t)s->el_S_off[z->ne]);
  const bool flexible = s->n_flexible > 0;
  in->S_tangent = ali3_pool_array(p, flexible ? (size_t)s->el_S_off[z->ne] : 0);
  in->ud_at = ali3_pool_array(p, flexible ? (size_t)z->nsig : 0);
  in->element_force = ali3_pool_array(p, (size_t)s->el_sig_ptr[z->ne]);
  in->SB = ali3_pool_array(p, ali3_signal_work(s));
  in->local = ali3_pool_array(p, ALI3_LOCAL * (size_t)s->max_front);
}

/* Of radau.c, where stages inside a step need nothing but q, qd and the time. */
static void place_stages(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const ali3_sizes *z = &s->size;
  const size_t nq = (size_t)z->nq, nc = (size_t)z->nc, stages = ali3_without_states(s) ? ALI3_RADAU : 0;
  in->stage_Phi = ali3_pool_array(p, stages * nc);
  in->stage_lam = ali3_pool_array(p, stages * nc);
  in->stage_J = ali3_pool_padded(p, stages * (size_t)z->nnz_rows);
  in->stage_J_tangent = ali3_pool_padded(p, stages * (size_t)z->nnz_rows);
  in->stage_x = ali3_pool_padded(p, stages * nq);
  in->F_stages = ali3_pool_array(p, stages * stages * (size_t)z->front_size);
  in->F_C = ali3_pool_array(p, stages > 0 ? (size_t)z->front_size : 0);
  in->F_K = ali3_pool_array(p, stages > 0 ? (size_t)z->front_size : 0);
}

/* Flexible bodies and elements. */
static void place_elements(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const ali3_sizes *z = &s->size;
  in->flex =
      ali3_pool_array(p, ALI3_FLEX_COUPLING * (size_t)s->n_flexible + ALI3_FLEX_OF_MODE * (size_t)s->n_flex_mode);
  in->flex_work = ali3_pool_array(p, 3 * (size_t)s->max_modes);
  const size_t extended = s->n_tabled > 0 ? (size_t)(z->nq + s->n_dependent) : 0;
  in->tabled = ali3_pool_items(p, (size_t)s->n_tabled, sizeof *in->tabled);
  in->tabled_base = ali3_pool_items(p, (size_t)s->n_tabled_base, sizeof *in->tabled_base);
  in->tabled_parameter = ali3_pool_items(p, (size_t)s->n_tabled_parameter, sizeof *in->tabled_parameter);
  in->tabled_square = ali3_pool_array(p, (size_t)s->tabled_square);
  for (int k = 0; k < 3; k++) in->extended[k] = ali3_pool_padded(p, extended);
  in->extended_force = ali3_pool_array(p, extended);
  in->y_work = ali3_pool_array(p, (size_t)z->ny);
  in->out_work = ali3_pool_array(p, (size_t)z->nout);
  in->potential_work = ali3_pool_array(p, (size_t)z->ne);
}

/* Of branch_watch.c. */
static void place_modes(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const size_t triads = (size_t)ali3_triad_count(s), loops = (size_t)ali3_loop_count(s);
  in->mode_sine = ali3_pool_array(p, triads);
  in->mode_cosine = ali3_pool_array(p, triads);
  in->sine_before = ali3_pool_array(p, triads);
  in->sine_after = ali3_pool_array(p, triads);
  in->sine_few = ali3_pool_array(p, triads);
  in->mode_left = ali3_pool_array(p, loops);
  if (triads > 0) place_state(s, &in->before, p);
}

/* Of start_equilibrium.c and work.c. */
static void place_start_and_work(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const size_t nq = (size_t)s->size.nq;
  in->start_q = ali3_pool_array(p, nq);
  in->pose_0 = ali3_pool_array(p, nq);
  in->pose_cos = ali3_pool_array(p, nq);
  in->pose_sin = ali3_pool_array(p, nq);
  in->watched = ali3_pool_array(p, (size_t)s->n_work + (size_t)s->n_work_force);
  in->work_sum = ali3_pool_array(p, (size_t)s->n_work);
  in->stage_power = ali3_pool_array(p, ALI3_RADAU * (size_t)s->n_work);
}

void ali3_workspace_place(const ali3_system *loaded, ali3_instance *in, ali3_pool *pool) {
  const ali3_system *s = ali3_widest_system(loaded);
  in->road = ali3_pool_items(pool, (size_t)s->nr, sizeof *in->road);
  in->own_road = ali3_pool_items(pool, (size_t)s->nr, sizeof *in->own_road);
  in->tree = s->tree != NULL ? ali3_pool_items(pool, 1, sizeof *in->tree) : NULL;
  place_states(s, in, pool);
  place_data(loaded, in, pool);
  place_step(s, in, pool);
  place_tangents(s, in, pool);
  place_stages(s, in, pool);
  place_elements(s, in, pool);
  place_modes(s, in, pool);
  place_start_and_work(s, in, pool);
  in->idle = ali3_pool_items(pool, (size_t)s->size.ne, sizeof *in->idle);
}
