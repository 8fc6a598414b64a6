/* Memory of a group, and what its lanes have of their instances. */
#include "group.h"

#include <string.h>

#include "../elements/element.h"
#include "../elements/road.h"
#include "../state/workspace.h"
#include "../system/pool.h"
#include "lanes.h"

enum { LINE = 64 }; /* bytes: the widest vector */

/* n numbers of each lane, from a multiple of LINE on. */
static void *items(const ali3_lane_group *g, ali3_pool *pool, size_t n) {
  pool->used = (pool->used + LINE - 1) / LINE * LINE;
  return ali3_pool_array(pool, n * (size_t)g->width);
}

static void place_vectors(const ali3_lane_group *g, ali3_lane_vectors *v, bool past, ali3_pool *pool) {
  const ali3_sizes *z = &g->system->size;
  const size_t nq = (size_t)z->nq, nc = (size_t)z->nc, ng = (size_t)z->ng;
  v->q = items(g, pool, nq);
  v->qd = items(g, pool, nq);
  v->qdd = items(g, pool, nq);
  v->lam = items(g, pool, nc);
  v->s = items(g, pool, ng);
  v->sd = items(g, pool, ng);
  v->sdd = items(g, pool, ng);
  v->y = items(g, pool, (size_t)z->ny);
  v->history = items(g, pool, past ? ALI3_HISTORY : 0);
  v->past_a = items(g, pool, past ? ALI3_PAST * nq : 0);
  v->past_lam = items(g, pool, past ? ALI3_PAST * nc : 0);
}

static void place_step(ali3_lane_group *g, ali3_pool *pool) {
  const ali3_sizes *z = &g->system->size;
  real **of_coordinates[] = {
      &g->mass_floor, &g->mass_floor_inverse, &g->gravity_force, &g->D,     &g->d0, &g->r, &g->x, &g->w, &g->hat, &g->Q,
      &g->shifted,    &g->correction_q,       &g->step_q,        &g->mean_a};
  real **of_rows[] = {&g->Phi,   &g->Phit,           &g->gamma,    &g->mu,        &g->lam,
                      &g->drive, &g->correction_lam, &g->step_lam, &g->newton_lam};
  for (size_t k = 0; k < sizeof of_coordinates / sizeof *of_coordinates; k++)
    *of_coordinates[k] = items(g, pool, (size_t)z->nq);
  for (size_t k = 0; k < sizeof of_rows / sizeof *of_rows; k++) *of_rows[k] = items(g, pool, (size_t)z->nc);
  g->guide_mean = items(g, pool, (size_t)z->ng);
}

static void place_tangents(ali3_lane_group *g, ali3_pool *pool) {
  const ali3_system *S = g->system;
  const ali3_sizes *z = &S->size;
  g->mass_val = items(g, pool, (size_t)z->nnz_mass);
  g->J = items(g, pool, (size_t)z->nnz_rows);
  g->J_tangent = items(g, pool, (size_t)z->nnz_rows);
  g->F = items(g, pool, (size_t)z->front_size);
  g->F_new = items(g, pool, (size_t)z->front_size);
  g->local = items(g, pool, (size_t)S->max_front);
  g->u = items(g, pool, (size_t)z->nsig);
  g->ud = items(g, pool, (size_t)z->nsig);
  g->S = items(g, pool, (size_t)S->el_S_off[z->ne]);
  g->SB = items(g, pool, ali3_signal_work(S));
  g->f = items(g, pool, (size_t)S->el_sig_ptr[z->ne]);
  g->idle = items(g, pool, (size_t)z->ne);
}

static bool has_law(const ali3_element_type *type) {
#define ALI3_IS(name) || type == &ali3_##name
  return false ALI3_LAWS(ALI3_IS);
#undef ALI3_IS
}

static void place_elements(ali3_lane_group *g, ali3_pool *pool) {
  const ali3_system *S = g->system;
  const ali3_sizes *z = &S->size;
  g->el_real = items(g, pool, (size_t)S->el_real_ptr[z->ne]);
  g->input = items(g, pool, (size_t)z->nu);
  g->out = items(g, pool, (size_t)S->el_out_ptr[z->ne]);
  g->potential = items(g, pool, (size_t)z->ne);
  g->by_law = ali3_pool_items(pool, (size_t)z->ne, sizeof *g->by_law);
  g->road = ali3_pool_items(pool, (size_t)S->nr, sizeof *g->road);
  for (int32_t e = 0; e < z->ne && pool->block != NULL; e++) g->by_law[e] = has_law(S->el_kind[e]);
  for (int32_t r = 0; r < S->nr; r++) {
    const ali3_lane_road road = {.group = g,
                                 .number = r,
                                 .numbers = items(g, pool, ALI3_ROAD_NUMBERS),
                                 .friction_factor = items(g, pool, 1)};
    if (pool->block != NULL) g->road[r] = road;
  }
}

static void place_counts(ali3_lane_group *g, ali3_pool *pool) {
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
  real **numbers[] = {&g->residual, &g->violation, &g->velocity_violation, &g->open_power, &g->work, &g->end,
                      &g->open,     &g->size};
  for (size_t k = 0; k < sizeof masks / sizeof *masks; k++) *masks[k] = items(g, pool, 1);
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) *numbers[k] = items(g, pool, 1);
}

static void place(ali3_lane_group *g, ali3_pool *pool) {
  place_vectors(g, &g->now, true, pool);
  place_vectors(g, &g->next, false, pool);
  place_step(g, pool);
  place_tangents(g, pool);
  place_elements(g, pool);
  place_counts(g, pool);
}

size_t ali3_group_bytes(const ali3_system *s, int32_t width) {
  ali3_lane_group g = {.system = s, .width = width};
  ali3_pool pool = {.block = NULL, .used = 0};
  place(&g, &pool);
  return pool.used + LINE;
}

/* `block` has ali3_group_bytes. */
void ali3_group_place(ali3_lane_group *g, void *block) {
  const size_t past_line = (uintptr_t)block % LINE;
  ali3_pool pool = {.block = (char *)block + (past_line > 0 ? LINE - past_line : 0), .used = 0};
  place(g, &pool);
}

/* n numbers of an instance become those of lane l, and back. */
static void put(const ali3_lane_group *g, int32_t l, real *to, const double *from, int32_t n) {
  for (int32_t i = 0; i < n; i++) to[i * g->width + l] = from[i];
}

static void take(const ali3_lane_group *g, int32_t l, double *to, const real *from, int32_t n) {
  for (int32_t i = 0; i < n; i++) to[i] = from[i * g->width + l];
}

/* The same for the elements that are computed in vectors; those of e begin at ptr[e]. */
static void put_of_laws(const ali3_lane_group *g, int32_t l, real *to, const double *from, const int32_t *ptr) {
  for (int32_t e = 0; e < g->system->size.ne; e++)
    if (g->by_law[e]) put(g, l, to + (int64_t)ptr[e] * g->width, from + ptr[e], ptr[e + 1] - ptr[e]);
}

static void take_of_laws(const ali3_lane_group *g, int32_t l, double *to, const real *from, const int32_t *ptr) {
  for (int32_t e = 0; e < g->system->size.ne; e++)
    if (g->by_law[e]) take(g, l, to + ptr[e], from + (int64_t)ptr[e] * g->width, ptr[e + 1] - ptr[e]);
}

static void roads(ali3_lane_group *g, int32_t l) {
  for (int32_t r = 0; r < g->system->nr; r++) {
    double numbers[ALI3_ROAD_NUMBERS], factor;
    ali3_lane_road *road = &g->road[r];
    const int32_t type = ali3_road_numbers(&g->lane[l]->road[r], numbers, &factor);
    road->type = l == 0 || road->type == type ? type : ALI3_ROAD_COUNT;
    put(g, l, road->numbers, numbers, ALI3_ROAD_NUMBERS);
    put(g, l, road->friction_factor, &factor, 1);
  }
}

/* What parameters change and steps do not. */
void ali3_group_parameters(ali3_lane_group *g, int32_t l) {
  const ali3_instance *in = g->lane[l];
  const ali3_sizes *z = &g->system->size;
  put(g, l, g->mass_val, in->mass_val, z->nnz_mass);
  put(g, l, g->mass_floor, in->mass_floor, z->nq);
  put(g, l, g->mass_floor_inverse, in->mass_floor_inverse, z->nq);
  put(g, l, g->gravity_force, in->gravity_force, z->nq);
  put(g, l, g->el_real, in->el_real, g->system->el_real_ptr[z->ne]);
  roads(g, l);
}

/* A step begins from in->now with the guides of in->next. */
void ali3_group_from(ali3_lane_group *g, int32_t l) {
  const ali3_instance *in = g->lane[l];
  const ali3_vectors *from = &in->now;
  const int32_t nq = g->system->size.nq, nc = g->system->size.nc, ng = g->system->size.ng;
  put(g, l, g->now.q, from->q, nq);
  put(g, l, g->now.qd, from->qd, nq);
  put(g, l, g->now.qdd, from->qdd, nq);
  put(g, l, g->now.lam, from->lam, nc);
  put(g, l, g->now.s, from->s, ng);
  put(g, l, g->now.sd, from->sd, ng);
  put(g, l, g->now.sdd, from->sdd, ng);
  put(g, l, g->next.s, in->next.s, ng);
  put(g, l, g->next.sd, in->next.sd, ng);
  put(g, l, g->next.sdd, in->next.sdd, ng);
  put(g, l, g->now.history, from->history, ALI3_HISTORY);
  put(g, l, g->now.past_a, from->past_a, ALI3_PAST * nq);
  put(g, l, g->now.past_lam, from->past_lam, ALI3_PAST * nc);
  put(g, l, g->input, in->force_input, g->system->size.nu);
  put_of_laws(g, l, g->now.y, from->y, g->system->el_state_ptr);
  g->open_power[l] = in->report.open_power;
  g->worst_row[l] = in->report.worst_row;
  g->worst_coordinate[l] = in->report.worst_coordinate;
  g->report.factorizations[l] = in->report.factorizations;
  g->report.solves[l] = in->report.solves;
  g->report.negative_pivots[l] = in->report.negative_pivots;
}

/* What Newton's loop and its counters left: in->next, its multipliers those of the loop, in->x the mean acceleration. */
void ali3_group_to(const ali3_lane_group *g, int32_t l) {
  ali3_instance *in = g->lane[l];
  ali3_report *r = &in->report;
  const int32_t nq = g->system->size.nq;
  take(g, l, in->next.q, g->next.q, nq);
  take(g, l, in->next.qd, g->next.qd, nq);
  take(g, l, in->next.qdd, g->next.qdd, nq);
  take(g, l, in->next.lam, g->newton_lam, g->system->size.nc);
  take_of_laws(g, l, in->next.y, g->next.y, g->system->el_state_ptr);
  take_of_laws(g, l, in->next.out, g->out, g->system->el_out_ptr);
  for (int32_t e = 0; e < g->system->size.ne; e++)
    if (g->by_law[e]) in->next.potential[e] = g->potential[e * g->width + l];
  take(g, l, in->D, g->D, nq);
  take(g, l, in->x, g->mean_a, nq);
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

/* The multipliers after (25), which the history does not take. */
void ali3_group_multipliers(const ali3_lane_group *g, int32_t l) {
  take(g, l, g->lane[l]->next.lam, g->next.lam, g->system->size.nc);
}
