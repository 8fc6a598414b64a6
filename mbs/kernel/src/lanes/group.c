/* Memory of a group, and copies of numbers between its lanes and their instances. */
#include "group.h"

#include <string.h>

#include "../elements/element.h"
#include "../elements/laws.h"
#include "../elements/road.h"
#include "../flexible/body_arrays.h"
#include "../lookup/lookup.h"
#include "../state/vectors.h"
#include "../state/workspace.h"
#include "../system/pool.h"
#include "lanes.h"

enum { LINE = 64 }; /* bytes of the widest vector */
enum { BASE_NUMBERS = sizeof(ali3_lookup_base_work) / sizeof(double) };

/* Allocates n numbers for each lane, aligned to LINE. */
static void *lane_items(const ali3_lane_group *g, ali3_pool *pool, size_t n) {
  pool->used = (pool->used + LINE - 1) / LINE * LINE;
  return ali3_pool_array(pool, n * (size_t)g->width);
}

/* `with_history`: with data of past steps. */
static void allocate_vectors(const ali3_lane_group *g, ali3_lane_vectors *v, bool with_history, ali3_pool *pool) {
  const ali3_sizes *z = &g->system->size;
  const size_t nq = (size_t)z->nq, nc = (size_t)z->nc, ng = (size_t)z->ng;
  const bool flexible = g->system->n_flexible > 0;
  v->q = lane_items(g, pool, nq);
  v->qd = lane_items(g, pool, nq);
  v->qdd = lane_items(g, pool, nq);
  v->lam = lane_items(g, pool, nc);
  v->s = lane_items(g, pool, ng);
  v->sd = lane_items(g, pool, ng);
  v->sdd = lane_items(g, pool, ng);
  v->y = lane_items(g, pool, (size_t)z->ny);
  v->mean = lane_items(g, pool, with_history && flexible ? nq : 0);
  v->mean_before = lane_items(g, pool, with_history && flexible ? nq : 0);
  with_history = with_history && !flexible;
  v->history = lane_items(g, pool, with_history ? ALI3_HISTORY : 0);
  v->past_a = lane_items(g, pool, with_history ? ALI3_PAST * nq : 0);
  v->past_lam = lane_items(g, pool, with_history ? ALI3_PAST * nc : 0);
}

/* Vectors of the iteration. */
static void allocate_step(ali3_lane_group *g, ali3_pool *pool) {
  const ali3_sizes *z = &g->system->size;
  real **of_coordinates[] = {&g->mass.floor,    &g->mass.floor_inverse,
                             &g->mass.gravity,  &g->step.D,
                             &g->step.d0,       &g->step.r,
                             &g->step.x,        &g->step.w,
                             &g->step.hat,      &g->step.Q,
                             &g->step.shifted,  &g->mixing.correction_q,
                             &g->mixing.step_q, &g->mean_a};
  real **of_rows[] = {&g->step.Phi,
                      &g->step.Phit,
                      &g->step.gamma,
                      &g->step.mu,
                      &g->step.lam,
                      &g->step.drive,
                      &g->mixing.correction_lam,
                      &g->mixing.step_lam,
                      &g->newton_lam};
  for (size_t k = 0; k < sizeof of_coordinates / sizeof *of_coordinates; k++)
    *of_coordinates[k] = lane_items(g, pool, (size_t)z->nq);
  for (size_t k = 0; k < sizeof of_rows / sizeof *of_rows; k++) *of_rows[k] = lane_items(g, pool, (size_t)z->nc);
  g->driving.mean = lane_items(g, pool, (size_t)z->ng);
  g->driving.follows = lane_items(g, pool, (size_t)z->ng);
  g->discarded = ali3_pool_array(pool, ali3_vector_count(g->system) + (size_t)g->system->n_lookup_base * BASE_NUMBERS);
}

/* Phi_q and the tangent. */
static void allocate_tangents(ali3_lane_group *g, ali3_pool *pool) {
  const ali3_system *S = g->system;
  const ali3_sizes *z = &S->size;
  g->mass.val = lane_items(g, pool, (size_t)z->nnz_mass);
  g->tangent.J = lane_items(g, pool, (size_t)z->nnz_rows);
  g->tangent.J_made = lane_items(g, pool, (size_t)z->nnz_rows);
  g->tangent.F = lane_items(g, pool, (size_t)z->front_size);
  g->tangent.F_new = lane_items(g, pool, (size_t)z->front_size);
  g->tangent.local = lane_items(g, pool, ALI3_LOCAL * (size_t)S->max_front);
  g->element.u = lane_items(g, pool, (size_t)z->nsig);
  g->element.ud = lane_items(g, pool, (size_t)z->nsig);
  g->element.S = lane_items(g, pool, (size_t)S->el_S_off[z->ne]);
  g->element.SB = lane_items(g, pool, ali3_signal_work(S));
  g->element.force = lane_items(g, pool, (size_t)S->el_sig_ptr[z->ne]);
  g->ways = lane_items(g, pool, (size_t)S->n_work_force);
  g->element.idle = lane_items(g, pool, (size_t)z->ne);
}

/* Arrays of flexible bodies and of defect_correction.c, which is used with them. */
static void allocate_flexible(ali3_lane_group *g, ali3_pool *pool) {
  const ali3_system *S = g->system;
  const size_t is_flexible = S->n_flexible > 0, modes = (size_t)S->n_flex_mode;
  g->flexible.prepared = lane_items(g, pool, ALI3_FLEX_COUPLING * (size_t)S->n_flexible + ALI3_FLEX_OF_MODE * modes);
  g->flexible.work = lane_items(g, pool, 3 * (size_t)S->max_modes);
  g->flexible.P = lane_items(g, pool, 3 * modes);
  g->flexible.c = lane_items(g, pool, 9 * modes);
  g->step.stage = lane_items(g, pool, is_flexible * 3 * (size_t)S->size.nq);
  g->element.S_made = lane_items(g, pool, is_flexible * (size_t)S->el_S_off[S->size.ne]);
  g->element.ud_at = lane_items(g, pool, is_flexible * (size_t)S->size.nsig);
}

/* Lookup-table bodies. */
static void allocate_lookup(ali3_lane_group *g, ali3_pool *pool) {
  const ali3_system *S = g->system;
  const size_t extended = S->n_lookup > 0 ? (size_t)(S->size.nq + S->n_dependent) : 0;
  g->lookup.item = lane_items(g, pool, (size_t)S->n_lookup * (sizeof *g->lookup.item / sizeof(double)));
  g->lookup.base = lane_items(g, pool, (size_t)S->n_lookup_base * BASE_NUMBERS);
  g->lookup.parameter =
      lane_items(g, pool, (size_t)S->n_lookup_parameter * (sizeof *g->lookup.parameter / sizeof(double)));
  g->lookup.square = lane_items(g, pool, (size_t)S->lookup_square);
  for (int k = 0; k < 3; k++) g->lookup.extended[k] = lane_items(g, pool, extended);
  g->lookup.force = lane_items(g, pool, extended);
}

/* Whether the law of an element type exists for lanes. */
static bool has_law(const ali3_element_type *type) {
#define ALI3_IS(name) || type == &ali3_##name
  return false ALI3_LAWS(ALI3_IS);
#undef ALI3_IS
}

/* Signals, forces and tangents of elements. */
static void allocate_elements(ali3_lane_group *g, ali3_pool *pool) {
  const ali3_system *S = g->system;
  const ali3_sizes *z = &S->size;
  g->el_parameter = lane_items(g, pool, (size_t)S->el_parameter_ptr[z->ne]);
  g->input = lane_items(g, pool, (size_t)z->nu);
  g->out = lane_items(g, pool, (size_t)S->el_out_ptr[z->ne]);
  g->potential = lane_items(g, pool, (size_t)z->ne);
  g->by_law = ali3_pool_items(pool, (size_t)z->ne, sizeof *g->by_law);
  g->road = ali3_pool_items(pool, (size_t)S->nr, sizeof *g->road);
  for (int32_t e = 0; e < z->ne && pool->block != NULL; e++) g->by_law[e] = has_law(S->el_kind[e]);
  for (int32_t r = 0; r < S->nr; r++) {
    const ali3_lane_road road = {.numbers = lane_items(g, pool, ALI3_ROAD_NUMBERS),
                                 .friction_factor = lane_items(g, pool, 1)};
    if (pool->block != NULL) g->road[r] = road;
  }
}

/* Numbers of one entry for each lane, and masks. */
static void allocate_scalars(ali3_lane_group *g, ali3_pool *pool) {
  ali3_mask **masks[] = {&g->lanes,
                         &g->at_work,
                         &g->evaluated,
                         &g->good,
                         &g->singular,
                         &g->iterations,
                         &g->worst_row,
                         &g->worst_coordinate,
                         &g->report.factorizations,
                         &g->report.solves,
                         &g->report.negative_pivots};
  real **numbers[] = {
      &g->residual, &g->reach, &g->violation, &g->velocity_violation, &g->open_power,         &g->work,
      &g->end,      &g->open,  &g->size,      &g->driving_work,       &g->mass.gravity_const, &g->weight};
  for (size_t k = 0; k < sizeof masks / sizeof *masks; k++) *masks[k] = lane_items(g, pool, 1);
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) *numbers[k] = lane_items(g, pool, 1);
  g->squares = lane_items(g, pool, 3);
}

/* All arrays of a group. */
static void allocate(ali3_lane_group *g, ali3_pool *pool) {
  allocate_vectors(g, &g->now, true, pool);
  allocate_vectors(g, &g->next, false, pool);
  allocate_step(g, pool);
  allocate_tangents(g, pool);
  allocate_flexible(g, pool);
  allocate_lookup(g, pool);
  allocate_elements(g, pool);
  allocate_scalars(g, pool);
}

size_t ali3_group_bytes(const ali3_system *s, int32_t width) {
  ali3_lane_group g = {.system = s, .width = width};
  ali3_pool pool = {.block = NULL, .used = 0};
  allocate(&g, &pool);
  return pool.used + LINE;
}

void ali3_group_place(ali3_lane_group *g, void *block) {
  const size_t past_line = (uintptr_t)block % LINE;
  ali3_pool pool = {.block = (char *)block + (past_line > 0 ? LINE - past_line : 0), .used = 0};
  allocate(g, &pool);
}

/* Copies a vector of each instance to the group; unused lanes get the vector of the first. */
#define PUT(g, to, n, in, from)                                                                                        \
  do {                                                                                                                 \
    const double *vector[ALI3_MAX_LANES];                                                                              \
    for (int32_t l = 0; l < (g)->width; l++) {                                                                         \
      const ali3_instance *in = (g)->lane[l < (g)->used ? l : 0];                                                      \
      vector[l] = from;                                                                                                \
    }                                                                                                                  \
    (g)->code->spread(to, vector, n);                                                                                  \
  } while (0)

/* Copies a vector to the instances of the lanes in group->good. */
#define TAKE(g, in, to, from, n)                                                                                       \
  do {                                                                                                                 \
    double *vector[ALI3_MAX_LANES];                                                                                    \
    for (int32_t l = 0; l < (g)->width; l++) {                                                                         \
      ali3_instance *in = (g)->lane[l < (g)->used ? l : 0];                                                            \
      vector[l] = (g)->good[l] ? (to) : (g)->discarded;                                                                \
    }                                                                                                                  \
    (g)->code->collect(vector, from, n);                                                                               \
  } while (0)

/* End of the run of elements that begins at e, all evaluated in vectors or all one by one. */
static int32_t end_of_run(const ali3_lane_group *g, int32_t e) {
  int32_t end = e + 1;
  while (end < g->system->size.ne && g->by_law[end] == g->by_law[e]) end++;
  return end;
}

/* Copies the numbers of the roads of all lanes. */
static void copy_roads(ali3_lane_group *g) {
  for (int32_t r = 0; r < g->system->nr; r++) {
    ali3_lane_road *road = &g->road[r];
    for (int32_t l = 0; l < g->used; l++) {
      double numbers[ALI3_ROAD_NUMBERS];
      const int32_t type = ali3_road_numbers(&g->lane[l]->roads.used[r], numbers, &road->friction_factor[l]);
      road->type = l == 0 || road->type == type ? type : ALI3_ROAD_COUNT;
      for (int32_t i = 0; i < ALI3_ROAD_NUMBERS; i++) road->numbers[i * g->width + l] = numbers[i];
    }
  }
}

void ali3_group_parameters(ali3_lane_group *g) {
  const ali3_sizes *z = &g->system->size;
  PUT(g, g->mass.val, z->nnz_mass, in, in->mass.val);
  g->mass.isotropic = true;
  for (int32_t l = 0; l < g->used; l++) g->mass.isotropic &= g->lane[l]->mass.isotropic;
  PUT(g, g->mass.floor, z->nq, in, in->mass.floor);
  PUT(g, g->mass.floor_inverse, z->nq, in, in->mass.floor_inverse);
  PUT(g, g->mass.gravity, z->nq, in, in->mass.gravity);
  PUT(g, g->mass.gravity_const, 1, in, &in->mass.gravity_const);
  PUT(g, g->flexible.P, 3 * (int32_t)g->system->n_flex_mode, in, in->system->flex_P);
  PUT(g, g->flexible.c, 9 * (int32_t)g->system->n_flex_mode, in, in->system->flex_c);
  PUT(g, g->el_parameter, g->system->el_parameter_ptr[z->ne], in, in->parameters.el_parameter);
  copy_roads(g);
}

void ali3_group_from(ali3_lane_group *g) {
  const ali3_system *S = g->system;
  const int32_t nq = S->size.nq, nc = S->size.nc, ng = S->size.ng;
  PUT(g, g->now.q, nq, in, in->now.q);
  PUT(g, g->now.qd, nq, in, in->now.qd);
  PUT(g, g->now.qdd, nq, in, in->now.qdd);
  PUT(g, g->now.lam, nc, in, in->now.lam);
  PUT(g, g->now.s, ng, in, in->now.s);
  PUT(g, g->now.sd, ng, in, in->now.sd);
  PUT(g, g->now.sdd, ng, in, in->now.sdd);
  PUT(g, g->driving.follows, ng, in, in->driving.follows);
  PUT(g, g->next.s, ng, in, in->next.s);
  PUT(g, g->next.sd, ng, in, in->next.sd);
  PUT(g, g->next.sdd, ng, in, in->next.sdd);
  if (S->n_flexible > 0) {
    PUT(g, g->now.mean, nq, in, in->now.mean);
    PUT(g, g->now.mean_before, nq, in, in->now.mean_before);
  } else {
    PUT(g, g->now.history, ALI3_HISTORY, in, in->now.history);
    PUT(g, g->now.past_a, ALI3_PAST * nq, in, in->now.past_a);
    PUT(g, g->now.past_lam, ALI3_PAST * nc, in, in->now.past_lam);
  }
  PUT(g, g->input, S->size.nu, in, in->inputs.forces);
  for (int32_t r = 0; r < S->nr; r++) /* lanes that do not step may have no instance or no valid position */
    for (int32_t l = 0; l < g->width; l++) g->road[r].lane[l] = g->lanes[l] ? &g->lane[l]->roads.used[r] : NULL;
  for (int32_t e = 0, end; e < S->size.ne; e = end) {
    end = end_of_run(g, e);
    const int32_t first = S->el_state_ptr[e], n = S->el_state_ptr[end] - first;
    if (g->by_law[e] && n > 0) PUT(g, g->now.y + first * g->width, n, in, in->now.y + first);
  }
  for (int32_t l = 0; l < g->used; l++) {
    const ali3_report *r = &g->lane[l]->report;
    g->open_power[l] = r->open_power;
    g->worst_row[l] = r->worst_row;
    g->worst_coordinate[l] = r->worst_coordinate;
    g->report.factorizations[l] = r->factorizations;
    g->report.solves[l] = r->solves;
    g->report.negative_pivots[l] = r->negative_pivots;
  }
}

/* Copies counters and residuals of lane l to the report of its instance. */
static void copy_report(const ali3_lane_group *g, int32_t l) {
  ali3_report *r = &g->lane[l]->report;
  r->last_iterations = (int32_t)g->iterations[l];
  r->iterations += r->last_iterations;
  if (r->last_iterations > r->max_iterations) r->max_iterations = r->last_iterations;
  r->factorizations = g->report.factorizations[l];
  r->solves = g->report.solves[l];
  r->negative_pivots = (int32_t)g->report.negative_pivots[l];
  r->residual = g->residual[l];
  r->violation = g->violation[l];
  r->worst_row = (int32_t)g->worst_row[l];
  r->worst_coordinate = (int32_t)g->worst_coordinate[l];
  r->velocity_violation = g->velocity_violation[l];
}

void ali3_group_to(const ali3_lane_group *g) {
  const ali3_system *S = g->system;
  const int32_t nq = S->size.nq;
  TAKE(g, in, in->next.q, g->next.q, nq);
  TAKE(g, in, in->next.qd, g->next.qd, nq);
  TAKE(g, in, in->next.qdd, g->next.qdd, nq);
  TAKE(g, in, in->next.lam, g->next.lam, S->size.nc);
  if (S->n_flexible > 0) {
    TAKE(g, in, in->step.D, g->step.D, nq);
  } else {
    TAKE(g, in, in->next.past_a, g->mean_a, nq);
    TAKE(g, in, in->next.past_lam, g->newton_lam, S->size.nc);
  }
  for (int32_t b = 0; b < S->n_flexible; b++) { /* axes and moments, for the energy of gravity */
    const int32_t offset = ALI3_FLEX_COUPLING * b + ALI3_FLEX_OF_MODE * S->flex_mode_ptr[b];
    TAKE(g, in, in->flexible.prepared + offset, g->flexible.prepared + offset * g->width, ALI3_FLEX_COUPLING);
  }
  if (S->n_lookup_base > 0) /* for the energy of gravity */
    TAKE(g, in, (double *)in->lookup.base, (const double *)g->lookup.base, S->n_lookup_base * BASE_NUMBERS);
  for (int32_t e = 0, end; e < S->size.ne; e = end) {
    end = end_of_run(g, e);
    const int32_t state = S->el_state_ptr[e], n_state = S->el_state_ptr[end] - state;
    const int32_t out = S->el_out_ptr[e], n_out = S->el_out_ptr[end] - out;
    if (!g->by_law[e]) continue;
    if (n_state > 0) TAKE(g, in, in->next.y + state, g->next.y + state * g->width, n_state);
    if (n_out > 0) TAKE(g, in, in->next.out + out, g->out + out * g->width, n_out);
    TAKE(g, in, in->next.potential + e, g->potential + e * g->width, end - e);
  }
  TAKE(g, in, in->next.step_displacement, g->ways, S->n_work_force);
  for (int32_t k = 0, end; k < S->n_work; k = end) {
    const int32_t first = S->el_sig_ptr[S->work_element[k]];
    for (end = k + 1; end < S->n_work && S->work_element[end] == S->work_element[end - 1] + 1;) end++;
    TAKE(g, in, in->element.force + first, g->element.force + first * g->width, S->work_ptr[end] - S->work_ptr[k]);
  }
  for (int32_t l = 0; l < g->used; l++)
    if (g->good[l]) copy_report(g, l);
}
