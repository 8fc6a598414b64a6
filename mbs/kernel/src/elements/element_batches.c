/* Forces of elements that are evaluated four at a time. */
#if defined(__x86_64__)
#include <xmmintrin.h>

#define ALI3_WIDTH 4
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC target("avx2")
#endif
#include "laws.h"

#include "../algebra/lane_copies.h"
#include "element_batches.h"

typedef struct { /* numbers of four elements, as in ali3_element_args */
  real u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS], f[ALI3_MAX_SIGNALS], S[ALI3_MAX_SIGNALS * ALI3_MAX_SIGNALS];
  real numbers[ALI3_BATCH_REALS], y_old[ALI3_BATCH_STATES], y_new[ALI3_BATCH_STATES], out[ALI3_BATCH_OUTPUTS];
} four_numbers;

/* Road `number` as the same road of four discs; its numbers go to `numbers`, its factor on friction to *factor. */
static ali3_lane_road load_road(const ali3_instance *in, int32_t number, real *numbers, real *factor) {
  double element_reals[ALI3_ROAD_NUMBERS], friction;
  ali3_lane_road road = {.numbers = numbers, .friction_factor = factor};
  const struct ali3_road *shared_road = ali3_batches_road(in, number, &road.type, element_reals, &friction);
  for (int l = 0; l < ALI3_BATCH; l++) road.lane[l] = shared_road;
  for (int i = 0; i < ALI3_ROAD_NUMBERS; i++) numbers[i] = ali3_same(element_reals[i]);
  *factor = ali3_same(friction);
  return road;
}

/* Where the numbers of each of four elements are. */
typedef struct {
  const int32_t *signal[ALI3_BATCH];
  const double *numbers[ALI3_BATCH], *y_old[ALI3_BATCH];
  double *f[ALI3_BATCH], *S[ALI3_BATCH], *y_new[ALI3_BATCH], *out[ALI3_BATCH];
} batch_places;

static batch_places find_places(const ali3_instance *in, const ali3_force_call *call, const int32_t e[ALI3_BATCH]) {
  const ali3_system *S = in->system;
  batch_places at;
  for (int l = 0; l < ALI3_BATCH; l++) {
    const ali3_element_size *size = S->el_size + e[l];
    at.signal[l] = S->el_sig + S->el_sig_ptr[e[l]];
    at.numbers[l] = in->parameters.el_parameter + size->real;
    at.y_old[l] = call->y_old + size->state;
    at.f[l] = in->element.force + S->el_sig_ptr[e[l]];
    at.S[l] = in->element.S + S->el_S_off[e[l]];
    at.y_new[l] = call->y_new + size->state;
    at.out[l] = call->out + size->out;
  }
  return at;
}

/* Copies signals, numbers and states of four elements, and sets their forces and tangents to zero. */
static void load_numbers(const ali3_instance *in, const batch_places *at, const ali3_element_size *size, bool tangent,
                         four_numbers *to) {
  const int32_t n = size->nsig;
  for (int32_t i = 0; i < n; i++)
    for (int l = 0; l < ALI3_BATCH; l++)
      to->u[i][l] = in->element.u[at->signal[l][i]], to->ud[i][l] = in->element.ud[at->signal[l][i]];
  interleave((double *)to->numbers, at->numbers, size->nreal);
  interleave((double *)to->y_old, at->y_old, size->nstate);
  memset(to->f, 0, (size_t)n * sizeof *to->f);
  if (tangent) memset(to->S, 0, (size_t)(n * n) * sizeof *to->S);
}

/* Copies forces, tangents, states and outputs back. */
static void store_numbers(const four_numbers *from, const batch_places *at, const ali3_element_size *size,
                          bool tangent) {
  const int32_t n = size->nsig;
  separate(at->f, (const double *)from->f, n);
  if (tangent) separate(at->S, (const double *)from->S, n * n);
  separate(at->y_new, (const double *)from->y_new, size->nstate);
  separate(at->out, (const double *)from->out, size->nout);
}

/* Evaluates four elements e of one type with one law; to: work memory. */
static void evaluate(ali3_instance *in, const ali3_force_call *call, const int32_t e[ALI3_BATCH], four_numbers *to) {
  const ali3_system *S = in->system;
  const ali3_element_size *size = S->el_size + e[0];
  const bool tangent = call->tangent && S->el_front[e[0]] >= 0;
  const batch_places at = find_places(in, call, e);
  real road_numbers[ALI3_ROAD_NUMBERS], factor;
  int32_t integer[ALI3_BATCH_INTEGERS];
  load_numbers(in, &at, size, tangent, to);
  memcpy(integer, S->el_int + size->integer, (size_t)size->nint * sizeof *integer);
  ali3_lane_road road;
  if (S->el_kind[e[0]]->depth != NULL) road = load_road(in, integer[0], road_numbers, &factor), integer[0] = 0;
  ali3_element_args a = {.nsig = size->nsig,
                         .nreal = size->nreal,
                         .nint = size->nint,
                         .nstate = size->nstate,
                         .nout = size->nout,
                         .u = to->u,
                         .ud = to->ud,
                         .y_old = to->y_old,
                         .y_new = to->y_new,
                         .h = call->h,
                         .reach = ali3_same(call->reach),
                         .wC = call->wC,
                         .wK = call->wK,
                         .real = to->numbers,
                         .integer = integer,
                         .roads = &road,
                         .f = to->f,
                         .S = tangent ? to->S : NULL,
                         .out = to->out};
  law_of(S->el_kind[e[0]])(&a);
  store_numbers(to, &at, size, tangent);
  for (int l = 0; l < ALI3_BATCH; l++) call->potential[e[l]] = a.potential[l], in->element.idle[e[l]] = a.idle != 0;
}

/* Vector laws also evaluate branches that are not taken: their floating-point exceptions are masked and not left to the
 * host. */
void ali3_batches_forces(ali3_instance *in, const ali3_force_call *call) {
  four_numbers numbers;
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | _MM_MASK_MASK);
  for (int32_t k = 0; k < in->system->n_batches; k++) evaluate(in, call, in->system->batch + k * ALI3_BATCH, &numbers);
  _mm_setcsr(before);
}

#if defined(__clang__)
#pragma clang attribute pop
#endif
#else
#include "element_batches.h"

void ali3_batches_forces(ali3_instance *in, const ali3_force_call *call) { (void)in, (void)call; } /* there are none */
#endif
