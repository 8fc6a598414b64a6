/* Selects, at load, the elements that are evaluated four at a time. */
#include <string.h>

#include "element.h"
#include "element_batches.h"
#include "laws.h"
#include "road.h"

/* Whether element e has a vector law and fits into the arrays of element_batches.c. */
static bool has_vector_law(const ali3_system *s, int32_t e) {
  const ali3_element_type *type = s->el_kind[e];
  const ali3_element_size *z = s->el_size + e;
  if (!s->has_avx2 || z->nreal > ALI3_BATCH_REALS || z->nstate > ALI3_BATCH_STATES || z->nout > ALI3_BATCH_OUTPUTS ||
      z->nint > ALI3_BATCH_INTEGERS)
    return false;
#define ALI3_IS(name) || type == &ali3_##name
  return false ALI3_LAWS_OF_SIGNALS(ALI3_IS);
#undef ALI3_IS
}

/* Whether two elements have the same law, sizes and integers, so that the law takes the same branches for both. */
static bool is_same_kind(const ali3_system *s, int32_t a, int32_t b) {
  const ali3_element_size *x = s->el_size + a, *y = s->el_size + b;
  return s->el_kind[a] == s->el_kind[b] && x->nsig == y->nsig && x->nreal == y->nreal && x->nint == y->nint &&
         x->nstate == y->nstate && x->nout == y->nout && (s->el_front[a] >= 0) == (s->el_front[b] >= 0) &&
         memcmp(s->el_int + x->integer, s->el_int + y->integer, (size_t)x->nint * sizeof(int32_t)) == 0;
}

void ali3_batches_derive(ali3_system *s) {
  const int32_t ne = s->size.ne;
  int32_t *batch = s->batch;
  unsigned char *grouped = s->el_in_batch;
  memset(grouped, 0, (size_t)ne);
  s->n_batches = s->n_alone = 0;
  for (int32_t e = 0; e < ne; e++) {
    int32_t m = 0;
    for (int32_t k = e; k < ne && m < ALI3_BATCH && !grouped[e] && has_vector_law(s, e); k++)
      if (!grouped[k] && is_same_kind(s, e, k)) batch[m++] = k;
    if (m < 2) {
      if (!grouped[e]) s->alone[s->n_alone++] = e;
      continue;
    }
    for (int32_t l = 0; l < m; l++) grouped[batch[l]] = 1;
    for (; m < ALI3_BATCH; m++) batch[m] = e; /* repeated, with the same result */
    batch += ALI3_BATCH;
    s->n_batches++;
  }
}

const struct ali3_road *ali3_batches_road(const ali3_instance *in, int32_t number, int32_t *type, double *numbers,
                                          double *friction_factor) {
  *type = ali3_road_numbers(in->roads.used + number, numbers, friction_factor);
  return in->roads.used + number;
}
