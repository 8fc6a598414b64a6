/* What of tabled bodies and of elements on them is derived when a System is loaded: their places in the fronts. */
#include <stdlib.h>
#include <string.h>

#include "../tabled/tabled.h"
#include "check.h"
#include "derive_tabled.h"

bool ali3_on_tabled(const ali3_system *s, int32_t e) {
  for (int32_t i = s->el_sig_ptr[e]; i < s->el_sig_ptr[e + 1]; i++)
    for (int32_t k = s->sig_ptr[s->el_sig[i]]; k < s->sig_ptr[s->el_sig[i] + 1]; k++)
      if (s->sig_col[k] >= s->size.nq) return true;
  return false;
}

void ali3_tabled_place(ali3_system *s, ali3_pool *p, size_t n_entry) {
  size_t n_element = 0;
  s->tabled = NULL;
  if (s->n_tabled == 0) return;
  for (int32_t e = 0; e < s->size.ne; e++) n_element += ali3_on_tabled(s, e);
  s->tabled = ali3_pool_items(p, (size_t)s->n_tabled, sizeof *s->tabled);
  s->tabled_element = ali3_pool_items(p, n_element, sizeof *s->tabled_element);
  s->el_tabled = ali3_pool_items(p, (size_t)s->size.ne, sizeof *s->el_tabled);
  s->el_entry_dependent = ali3_pool_items(p, n_entry, sizeof *s->el_entry_dependent);
}

/* Coordinate k of an item: of its base, then its parameters; -1: it has none. */
static int32_t coordinate(const ali3_tabled *c, int32_t k) { return k < 12 ? c->frame[k] : c->param[k - 12]; }

/* Places of the coordinates of an item in a front; false: one is not there. */
static bool find(const ali3_system *s, const ali3_tabled *c, int32_t front, int32_t *loc) {
  const int32_t *idx = s->front_idx + s->front_ptr[front], size = s->front_ptr[front + 1] - s->front_ptr[front];
  for (int32_t k = 0; k < ALI3_TABLED_COLUMNS; k++) {
    const int32_t i = coordinate(c, k);
    loc[k] = i < 0 ? -1 : ali3_find(idx, size, i);
    if (i >= 0 && loc[k] < 0) return false;
  }
  return true;
}

static ali3_status derive_item(const ali3_system *s, int32_t i, int32_t *dependents, int64_t *coefficients,
                               ali3_message m) {
  ali3_tabled *c = s->tabled + i;
  const int32_t *size = s->tabled_size + 3 * (int64_t)i;
  int32_t least = s->size.nq;
  *c = (ali3_tabled){.n = size[0],
                     .count = {size[1], size[2]},
                     .first = *dependents,
                     .frame = s->tabled_frame + 12 * (int64_t)i,
                     .param = s->tabled_param + 2 * (int64_t)i,
                     .axis = s->tabled_axis + 4 * (int64_t)i,
                     .coef = s->tabled_coef + *coefficients,
                     .mass = s->tabled_mass + ALI3_TABLED_MOMENTS * (int64_t)i,
                     .gravity = s->tabled_gravity + 3 * (int64_t)i};
  *dependents += c->n;
  *coefficients += (int64_t)size[0] * size[1] * size[2];
  for (int32_t k = 0; k < ALI3_TABLED_COLUMNS; k++)
    if (coordinate(c, k) >= 0 && coordinate(c, k) < least) least = coordinate(c, k);
  while (least >= s->front_col[c->front + 1]) c->front++;
  return find(s, c, c->front, c->loc) ? ALI3_OK : ali3_bad(m, "a coordinate of table %d is not in its front", (int)i);
}

static int ascending(const void *a, const void *b) {
  const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return (x > y) - (x < y);
}

/* The item that has a dependent. */
static int32_t owner(const ali3_system *s, int32_t dependent) {
  int32_t i = s->n_tabled - 1;
  while (s->tabled[i].first > dependent) i--;
  return i;
}

static ali3_status derive_element(ali3_system *s, int32_t e, ali3_tabled_element *of, ali3_message m) {
  const int32_t *loc = s->el_loc + s->el_loc_ptr[e];
  int32_t at = s->el_entry_ptr[e], found[ALI3_TABLED_ITEMS][ALI3_TABLED_COLUMNS], n = 0, plain = at;
  if (s->el_sig_ptr[e + 1] - s->el_sig_ptr[e] > ALI3_TABLED_SIGNALS)
    return ali3_bad(m, "element %d on a tabled body has too many signals", (int)e);
  for (int32_t i = s->el_sig_ptr[e]; i < s->el_sig_ptr[e + 1]; i++)
    for (int32_t k = s->sig_ptr[s->el_sig[i]]; k < s->sig_ptr[s->el_sig[i] + 1]; k++, at++, loc++) {
      const int32_t d = s->sig_col[k] - s->size.nq;
      s->el_entry_dependent[at] = -1;
      if (s->el_front[e] < 0) continue;
      if (d < 0) {
        if (n == ALI3_TABLED_MOST) return ali3_bad(m, "element %d has too many coordinates", (int)e);
        of->loc[n++] = s->el_entry_local[at] = *loc;
        continue;
      }
      const int32_t item = owner(s, d);
      int32_t which = 0;
      while (which < of->n_item && of->item[which] != item) which++;
      if (which == ALI3_TABLED_ITEMS) return ali3_bad(m, "element %d is on too many tabled bodies", (int)e);
      if (which == of->n_item) {
        of->item[of->n_item++] = item;
        if (!find(s, s->tabled + item, s->el_front[e], found[which]))
          return ali3_bad(m, "a coordinate of table %d is not in the front of element %d", (int)item, (int)e);
      }
      s->el_entry_dependent[at] = d - s->tabled[item].first;
      s->el_entry_local[at] = which;
    }
  for (int32_t i = 0; i < of->n_item; i++)
    for (int32_t k = 0; k < ALI3_TABLED_COLUMNS; k++) {
      if (found[i][k] < 0) continue;
      if (n == ALI3_TABLED_MOST) return ali3_bad(m, "element %d has too many coordinates", (int)e);
      of->loc[n++] = found[i][k];
    }
  qsort(of->loc, (size_t)n, sizeof *of->loc, ascending);
  for (int32_t i = 0; i < n; i++)
    if (of->m == 0 || of->loc[i] != of->loc[of->m - 1]) of->loc[of->m++] = of->loc[i];
  for (int32_t i = 0; i < of->n_item; i++)
    for (int32_t k = 0; k < ALI3_TABLED_COLUMNS; k++)
      of->slot[i][k] = found[i][k] < 0 ? -1 : ali3_find(of->loc, of->m, found[i][k]);
  for (int32_t k = plain; k < at; k++)
    if (s->el_front[e] >= 0 && s->el_entry_dependent[k] < 0)
      s->el_entry_local[k] = ali3_find(of->loc, of->m, s->el_entry_local[k]);
  return ALI3_OK;
}

ali3_status ali3_tabled_derive(ali3_system *s, ali3_message m) {
  int32_t dependents = 0, n = 0;
  int64_t coefficients = 0;
  if (s->n_tabled == 0) return ALI3_OK;
  for (int32_t i = 0; i < s->n_tabled; i++) CHECK(derive_item(s, i, &dependents, &coefficients, m));
  for (int32_t e = 0; e < s->size.ne; e++) {
    s->el_tabled[e] = -1;
    if (!ali3_on_tabled(s, e)) continue;
    s->tabled_element[n] = (ali3_tabled_element){0};
    CHECK(derive_element(s, e, s->tabled_element + n, m));
    s->el_tabled[e] = n++;
  }
  return ALI3_OK;
}
