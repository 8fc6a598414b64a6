/* Memory of an instance: the same functions count the memory, without a block, and place the arrays in it. */
#include "workspace.h"

#include "../elements/road.h"
#include "../flexible/body_arrays.h"
#include "../lookup/lookup.h"
#include "../rows/assembly_mode.h"
#include "../system/state_coordinates.h"
#include "../tree/tree.h"
#include "axes.h"
#include "masses.h"
#include "vectors.h"

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
  place_state(s, &in->stored.start, p);
  place_state(s, &in->stored.whole, p);
  place_state(s, &in->stored.direction, p);
  place_state(s, &in->stored.origin, p);
  place_state(s, &in->stored.centre, p);
  place_state(s, &in->stored.coarse, p);
}

/* Places inputs, parameters and the data that parameters write. */
static void place_data(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const size_t nu = (size_t)s->size.nu, np = (size_t)s->size.np;
  in->inputs.set = ali3_pool_array(p, nu);
  in->inputs.work = ali3_pool_array(p, nu);
  in->inputs.middle = ali3_pool_array(p, nu);
  in->inputs.from = ali3_pool_array(p, nu);
  in->inputs.to = ali3_pool_array(p, nu);
  in->inputs.begin = ali3_pool_array(p, nu);
  in->inputs.stage = ali3_pool_array(p, ALI3_RADAU * nu);
  in->parameters.value = ali3_pool_array(p, np);
  in->parameters.work = ali3_pool_array(p, np);
  in->parameters.el_parameter = ali3_pool_array(p, (size_t)s->n_el_parameter);
  in->parameters.sen_parameter = ali3_pool_array(p, (size_t)s->n_sen_parameter);
  in->parameters.guide_parameter = ali3_pool_array(p, (size_t)s->n_guide_parameter);
  in->driving.least = ali3_pool_array(p, 3 * (size_t)s->size.ng);
  in->parameters.switch_on = ali3_pool_array(p, (size_t)s->size.n_switch);
  in->parameters.road_parameter = ali3_pool_array(p, (size_t)s->n_road_parameter);
  ali3_masses_place(s, in, p);
  ali3_axes_place(s, in, p);
}

/* Places vectors of coordinates and of rows for a step. */
static void place_step(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const size_t nq = (size_t)s->size.nq, nc = (size_t)s->size.nc;
  in->step.D = ali3_pool_padded(p, nq);
  in->step.d0 = ali3_pool_padded(p, nq);
  in->step.r = ali3_pool_padded(p, nq);
  in->step.x = ali3_pool_padded(p, nq);
  in->step.w = ali3_pool_padded(p, nq);
  in->step.shifted = ali3_pool_padded(p, nq);
  in->step.hat = ali3_pool_padded(p, nq);
  in->discrete.middle = ali3_pool_padded(p, nq);
  in->discrete.rate = ali3_pool_padded(p, nq);
  in->step.stage = ali3_pool_padded(p, ALI3_STAGES * nq);
  in->step.Q = ali3_pool_array(p, nq);
  in->step.Phi = ali3_pool_array(p, nc);
  in->step.Phit = ali3_pool_array(p, nc);
  in->step.gamma = ali3_pool_array(p, nc);
  in->step.mu = ali3_pool_array(p, nc);
  in->step.drive = ali3_pool_array(p, nc);
  in->driving.mean = ali3_pool_array(p, (size_t)s->size.ng);
  in->driving.follows = ali3_pool_array(p, (size_t)s->size.ng);
  in->step.lam = ali3_pool_array(p, nc);
  in->mixing.correction_q = ali3_pool_padded(p, nq);
  in->mixing.step_q = ali3_pool_padded(p, nq);
  in->mixing.correction_lam = ali3_pool_array(p, nc);
  in->mixing.step_lam = ali3_pool_array(p, nc);
}

/* Places Jacobians, signals and tangents. */
static void place_tangents(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const ali3_sizes *z = &s->size;
  in->tangent.J = ali3_pool_padded(p, (size_t)z->nnz_rows);
  in->tangent.J_made = ali3_pool_padded(p, (size_t)z->nnz_rows);
  in->discrete.J0 = ali3_pool_padded(p, (size_t)z->nnz_rows);
  in->discrete.at_J0 = ali3_pool_array(p, (size_t)z->nq + (size_t)z->ng + (size_t)z->n_switch);
  in->discrete.A = ali3_pool_padded(p, (size_t)z->nnz_rows);
  in->discrete.A_made = ali3_pool_padded(p, (size_t)z->nnz_rows);
  in->tangent.F = ali3_pool_array(p, (size_t)z->front_size);
  in->element.u = ali3_pool_array(p, (size_t)z->nsig);
  in->element.ud = ali3_pool_array(p, (size_t)z->nsig);
  in->element.S = ali3_pool_array(p, (size_t)s->el_S_off[z->ne]);
  const bool flexible = s->n_flexible > 0;
  in->element.S_made = ali3_pool_array(p, flexible ? (size_t)s->el_S_off[z->ne] : 0);
  in->element.ud_at = ali3_pool_array(p, flexible ? (size_t)z->nsig : 0);
  in->element.force = ali3_pool_array(p, (size_t)s->el_sig_ptr[z->ne]);
  in->element.SB = ali3_pool_array(p, ali3_signal_work(s));
  in->tangent.local = ali3_pool_array(p, ALI3_LOCAL * (size_t)s->max_front);
}

/* Places the arrays of radau.c, only for Systems whose stages depend on q, qd and the time alone. */
static void place_stages(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const ali3_sizes *z = &s->size;
  const size_t nq = (size_t)z->nq, nc = (size_t)z->nc, stages = ali3_states_are_coordinates(s) ? ALI3_RADAU : 0;
  in->radau.Phi = ali3_pool_array(p, stages * nc);
  in->radau.lam = ali3_pool_array(p, stages * nc);
  in->radau.J = ali3_pool_padded(p, stages * (size_t)z->nnz_rows);
  in->radau.J_made = ali3_pool_padded(p, stages * (size_t)z->nnz_rows);
  in->radau.x = ali3_pool_padded(p, stages * nq);
  in->radau.F = ali3_pool_array(p, stages * stages * (size_t)z->front_size);
  in->radau.F_C = ali3_pool_array(p, stages > 0 ? (size_t)z->front_size : 0);
  in->radau.F_K = ali3_pool_array(p, stages > 0 ? (size_t)z->front_size : 0);
}

/* Places the arrays of flexible bodies, lookup-table bodies and elements. */
static void place_elements(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const ali3_sizes *z = &s->size;
  in->flexible.prepared =
      ali3_pool_array(p, ALI3_FLEX_COUPLING * (size_t)s->n_flexible + ALI3_FLEX_OF_MODE * (size_t)s->n_flex_mode);
  in->flexible.work = ali3_pool_array(p, 3 * (size_t)s->max_modes);
  const size_t extended = s->n_lookup > 0 ? (size_t)(z->nq + s->n_dependent) : 0;
  in->lookup.item = ali3_pool_items(p, (size_t)s->n_lookup, sizeof *in->lookup.item);
  in->lookup.base = ali3_pool_items(p, (size_t)s->n_lookup_base, sizeof *in->lookup.base);
  in->lookup.parameter = ali3_pool_items(p, (size_t)s->n_lookup_parameter, sizeof *in->lookup.parameter);
  in->lookup.square = ali3_pool_array(p, (size_t)s->lookup_square);
  for (int k = 0; k < 3; k++) in->lookup.extended[k] = ali3_pool_padded(p, extended);
  in->lookup.force = ali3_pool_array(p, extended);
  in->element.y = ali3_pool_array(p, (size_t)z->ny);
  in->element.out = ali3_pool_array(p, (size_t)z->nout);
  in->element.potential = ali3_pool_array(p, (size_t)z->ne);
}

/* Places the arrays of branch_watch.c. */
static void place_modes(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const size_t triads = (size_t)ali3_triad_count(s), loops = (size_t)ali3_loop_count(s);
  in->branch.sine = ali3_pool_array(p, triads);
  in->branch.cosine = ali3_pool_array(p, triads);
  in->branch.sine_before = ali3_pool_array(p, triads);
  in->branch.sine_after = ali3_pool_array(p, triads);
  in->branch.sine_few = ali3_pool_array(p, triads);
  in->branch.left = ali3_pool_array(p, loops);
  if (triads > 0) place_state(s, &in->stored.near_branch, p);
}

/* Places the arrays of start_equilibrium.c and work.c. */
static void place_start_and_work(const ali3_system *s, ali3_instance *in, ali3_pool *p) {
  const size_t nq = (size_t)s->size.nq;
  in->start.q = ali3_pool_array(p, nq);
  in->start.pose_0 = ali3_pool_array(p, nq);
  in->start.pose_cos = ali3_pool_array(p, nq);
  in->start.pose_sin = ali3_pool_array(p, nq);
  in->watch.now = ali3_pool_array(p, (size_t)s->n_work + (size_t)s->n_work_force);
  in->watch.sum = ali3_pool_array(p, (size_t)s->n_work);
  in->watch.stages = ali3_pool_array(p, ALI3_RADAU * (size_t)s->n_work);
}

void ali3_workspace_place(const ali3_system *loaded, ali3_instance *in, ali3_pool *pool) {
  const ali3_system *s = ali3_widest_system(loaded);
  in->roads.used = ali3_pool_items(pool, (size_t)s->nr, sizeof *in->roads.used);
  in->roads.own = ali3_pool_items(pool, (size_t)s->nr, sizeof *in->roads.own);
  in->tree = s->tree != NULL ? ali3_pool_items(pool, 1, sizeof *in->tree) : NULL;
  place_states(s, in, pool);
  place_data(loaded, in, pool);
  place_step(s, in, pool);
  place_tangents(s, in, pool);
  place_stages(s, in, pool);
  place_elements(s, in, pool);
  place_modes(s, in, pool);
  place_start_and_work(s, in, pool);
  in->element.idle = ali3_pool_items(pool, (size_t)s->size.ne, sizeof *in->element.idle);
}
