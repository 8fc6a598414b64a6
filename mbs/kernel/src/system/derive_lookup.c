/* Derives, when a System is loaded, positions of lookup-table bodies and of the elements on them in the fronts of the
 * tangent. Elements on the same bodies form a group with its own signals, coordinates and, if all signals are points,
 * directions or numbers of these bodies, a decomposition into such parts. */
#include <string.h>

#include "../lookup/lookup.h"
#include "check.h"
#include "derive_lookup.h"

bool ali3_on_lookup(const ali3_system *s, int32_t e) {
  for (int32_t i = s->el_sig_ptr[e]; i < s->el_sig_ptr[e + 1]; i++)
    for (int32_t k = s->sig_ptr[s->el_sig[i]]; k < s->sig_ptr[s->el_sig[i] + 1]; k++)
      if (s->sig_col[k] >= s->size.nq) return true;
  return false;
}

void ali3_lookup_place(ali3_system *s, ali3_pool *p, size_t n_entry) {
  size_t n_element = 0;
  s->lookup = NULL;
  if (s->n_lookup == 0) return;
  for (int32_t e = 0; e < s->size.ne; e++) n_element += ali3_on_lookup(s, e);
  s->lookup = ali3_pool_items(p, (size_t)s->n_lookup, sizeof *s->lookup);
  s->lookup_base = ali3_pool_items(p, (size_t)s->n_lookup, sizeof *s->lookup_base);
  s->lookup_parameter = ali3_pool_items(p, 2 * (size_t)s->n_lookup, sizeof *s->lookup_parameter);
  s->lookup_group = ali3_pool_items(p, n_element, sizeof *s->lookup_group);
  s->lookup_order = ali3_pool_items(p, n_element, sizeof *s->lookup_order);
  s->lookup_signal = ali3_pool_items(p, (size_t)s->n_el_sig, sizeof *s->lookup_signal);
  s->el_lookup = ali3_pool_items(p, (size_t)s->size.ne, sizeof *s->el_lookup);
  s->el_entry_dependent = ali3_pool_items(p, n_entry, sizeof *s->el_entry_dependent);
}

/* Index of a value in a list; -1: not found. */
static int32_t find_index(const int32_t *list, int32_t n, int32_t value) {
  for (int32_t i = 0; i < n; i++)
    if (list[i] == value) return i;
  return -1;
}

/* Coordinate k of an item, first coordinates of its base, then its parameters; -1: none. */
static int32_t coordinate(const ali3_lookup *c, int32_t k) { return k < 12 ? c->frame[k] : c->param[k - 12]; }

/* Writes the local indices of the coordinates of an item in a front; false: one is not in the front. */
static bool find_local(const ali3_system *s, const ali3_lookup *c, int32_t front, int32_t *loc) {
  const int32_t *idx = s->front_idx + s->front_ptr[front], size = s->front_ptr[front + 1] - s->front_ptr[front];
  for (int32_t k = 0; k < ALI3_LOOKUP_COLUMNS; k++) {
    const int32_t i = coordinate(c, k);
    loc[k] = i < 0 ? -1 : ali3_find(idx, size, i);
    if (i >= 0 && loc[k] < 0) return false;
  }
  return true;
}

/* Initialises item i and advances *dependents and *coefficients, the counts of the items before it. */
static ali3_status derive_item(const ali3_system *s, int32_t i, int32_t *dependents, int64_t *coefficients,
                               ali3_message m) {
  ali3_lookup *c = s->lookup + i;
  const int32_t *size = s->tabled_size + 3 * (int64_t)i;
  int32_t least = s->size.nq;
  *c = (ali3_lookup){.n = size[0],
                     .count = {size[1], size[2]},
                     .first = *dependents,
                     .frame = s->tabled_frame + 12 * (int64_t)i,
                     .param = s->tabled_param + 2 * (int64_t)i,
                     .axis = s->tabled_axis + 4 * (int64_t)i,
                     .coef = s->tabled_coef + *coefficients,
                     .mass = s->tabled_mass + ALI3_LOOKUP_MOMENTS * (int64_t)i,
                     .gravity = s->tabled_gravity + 3 * (int64_t)i};
  *dependents += c->n;
  *coefficients += (int64_t)size[0] * size[1] * size[2];
  for (int32_t k = 0; k < ALI3_LOOKUP_COLUMNS; k++)
    if (coordinate(c, k) >= 0 && coordinate(c, k) < least) least = coordinate(c, k);
  while (least >= s->front_col[c->front + 1]) c->front++;
  return find_local(s, c, c->front, c->loc) ? ALI3_OK
                                            : ali3_bad(m, "a coordinate of table %d is not in its front", (int)i);
}

/* The item to which a dependent belongs. */
static int32_t item_of(const ali3_system *s, int32_t dependent) {
  int32_t i = s->n_lookup - 1;
  while (s->lookup[i].first > dependent) i--;
  return i;
}

/* Lists for each item its vectors on which a signal of an element depends. */
static void derive_seen(ali3_system *s) {
  for (int32_t a = 0; a < s->n_active; a++)
    for (int32_t k = s->sig_ptr[s->active_signal[a]]; k < s->sig_ptr[s->active_signal[a] + 1]; k++) {
      const int32_t d = s->sig_col[k] - s->size.nq;
      if (d < 0) continue;
      ali3_lookup *c = s->lookup + item_of(s, d);
      const int32_t vector = (d - c->first) / 3;
      int32_t n = 0;
      while (n < c->n_seen && c->seen[n] != vector) n++;
      if (n == c->n_seen) c->seen[c->n_seen++] = vector;
    }
}

/* Index in the array of all fronts of the entry at local indices i and j of a front. */
static int32_t entry_at(const ali3_system *s, int32_t front, int32_t i, int32_t j) {
  const int32_t size = s->front_ptr[front + 1] - s->front_ptr[front];
  return (int32_t)s->front_off[front] + (i >= j ? j * size + i : i * size + j);
}

/* Indices of the entries that couple the coordinates of a base with the one at local index `loc`. */
static void entries_of_base(const ali3_system *s, const ali3_lookup_base *base, int32_t loc, int32_t *at) {
  for (int i = 0; i < ALI3_LOOKUP_BODY; i++) at[i] = entry_at(s, base->front, base->loc[i], loc);
}

/* Index of the parameter of a base with coordinate `column`, at `loc` in its front; adds a new one. */
static int32_t parameter_of(ali3_system *s, ali3_lookup_base *base, int32_t column, int32_t loc) {
  int32_t p = base->first;
  while (p < base->end && s->lookup_parameter[p].column != column) p++;
  if (p < base->end) return p;
  s->lookup_parameter[base->end++] = (ali3_lookup_parameter){.column = column};
  entries_of_base(s, base, loc, s->lookup_parameter[p].at);
  return p;
}

/* Collects the bodies with the same base, front and gravity. */
static void derive_bases(ali3_system *s) {
  for (int32_t i = 0; i < s->n_lookup; i++) s->lookup[i].base = -1;
  for (int32_t i = 0; i < s->n_lookup; i++) {
    const ali3_lookup *c = s->lookup + i;
    if (c->n != ALI3_LOOKUP_BODY || c->base >= 0) continue;
    ali3_lookup_base *base = s->lookup_base + s->n_lookup_base;
    *base = (ali3_lookup_base){.front = c->front,
                               .first = s->n_lookup_parameter,
                               .end = s->n_lookup_parameter,
                               .frame = c->frame,
                               .gravity = c->gravity};
    memcpy(base->loc, c->loc, sizeof base->loc);
    for (int k = 0; k < ALI3_LOOKUP_BODY; k++) entries_of_base(s, base, base->loc[k], base->at[k]);
    for (int32_t k = i; k < s->n_lookup; k++) {
      ali3_lookup *d = s->lookup + k;
      if (d->n != ALI3_LOOKUP_BODY || d->base >= 0 || d->front != c->front ||
          memcmp(d->frame, c->frame, 12 * sizeof *c->frame) != 0 ||
          memcmp(d->gravity, c->gravity, 3 * sizeof *c->gravity) != 0)
        continue;
      d->base = s->n_lookup_base;
      for (int p = 0; p < 2 && d->param[p] >= 0; p++) d->along[p] = parameter_of(s, base, d->param[p], d->loc[12 + p]);
    }
    s->n_lookup_parameter = base->end;
    s->n_lookup_base++;
  }
}

/* Adds a value to a list unless it is in it; false: the list is full. */
static bool add_once(int32_t *list, int32_t *count, int32_t capacity, int32_t value) {
  if (find_index(list, *count, value) >= 0) return true;
  if (*count == capacity) return false;
  list[(*count)++] = value;
  return true;
}

/* Collects the signals of element e, the items on which they depend, and the local indices of all their coordinates. */
static ali3_status collect_element(const ali3_system *s, int32_t e, ali3_lookup_group *of, ali3_message m) {
  const int32_t *loc = s->el_loc + s->el_loc_ptr[e];
  bool fits = true;
  for (int32_t i = s->el_sig_ptr[e]; i < s->el_sig_ptr[e + 1]; i++) {
    fits = fits && add_once(of->signal, &of->n_signal, ALI3_LOOKUP_SIGNALS, s->el_sig[i]);
    for (int32_t k = s->sig_ptr[s->el_sig[i]]; k < s->sig_ptr[s->el_sig[i] + 1]; k++, loc++) {
      const int32_t d = s->sig_col[k] - s->size.nq;
      if (d < 0)
        fits = fits && add_once(of->loc, &of->m, ALI3_LOOKUP_MOST, *loc);
      else
        fits = fits && add_once(of->item, &of->n_item, ALI3_LOOKUP_ITEMS, item_of(s, d));
    }
  }
  for (int32_t n = 0; n < of->n_item; n++) {
    int32_t loc_of_item[ALI3_LOOKUP_COLUMNS];
    if (!find_local(s, s->lookup + of->item[n], of->front, loc_of_item))
      return ali3_bad(m, "a coordinate of table %d is not in the front of element %d", (int)of->item[n], (int)e);
    for (int32_t k = 0; k < ALI3_LOOKUP_COLUMNS; k++)
      fits = fits && (loc_of_item[k] < 0 || add_once(of->loc, &of->m, ALI3_LOOKUP_MOST, loc_of_item[k]));
  }
  return fits ? ALI3_OK : ali3_bad(m, "element %d is on too many lookup-table bodies and coordinates", (int)e);
}

/* Adds the coordinates and signals of an element, `of`, to a group with the same items; false: they do not fit. */
static bool try_join(ali3_lookup_group *group, const ali3_lookup_group *of) {
  ali3_lookup_group joined = *group;
  if (group->front != of->front || group->n_item != of->n_item) return false;
  if (memcmp(group->item, of->item, (size_t)of->n_item * sizeof *of->item) != 0) return false;
  for (int32_t i = 0; i < of->m; i++)
    if (!add_once(joined.loc, &joined.m, ALI3_LOOKUP_MOST, of->loc[i])) return false;
  for (int32_t i = 0; i < of->n_signal; i++)
    if (!add_once(joined.signal, &joined.n_signal, ALI3_LOOKUP_SIGNALS, of->signal[i])) return false;
  *group = joined;
  return true;
}

/* Stores for each entry of the signals of element e its coordinate in the group, or its item and dependent. */
static void derive_entries(ali3_system *s, int32_t e, ali3_lookup_group *group) {
  const int32_t *loc = s->el_loc + s->el_loc_ptr[e];
  int32_t at = s->el_entry_ptr[e];
  for (int32_t i = s->el_sig_ptr[e]; i < s->el_sig_ptr[e + 1]; i++) {
    const int32_t signal = s->el_sig[i], index = find_index(group->signal, group->n_signal, signal);
    s->lookup_signal[i] = index;
    group->entry[index] = at;
    group->n_entry[index] = s->sig_ptr[signal + 1] - s->sig_ptr[signal];
    for (int32_t k = s->sig_ptr[signal]; k < s->sig_ptr[signal + 1]; k++, at++, loc++) {
      const int32_t d = s->sig_col[k] - s->size.nq;
      s->el_entry_dependent[at] = d < 0 ? -1 : d - s->lookup[item_of(s, d)].first;
      s->el_entry_local[at] =
          d < 0 ? ali3_find(group->loc, group->m, *loc) : find_index(group->item, group->n_item, item_of(s, d));
    }
  }
}

/* Index of the vector of whose component x entry k of a group is part: 0 for r and 1 to 3 for the axes of the base, 4 +
 * 4 item + vector for an item; -1: none. */
static int32_t source_of(const ali3_system *s, const ali3_lookup_group *group, const int32_t *frame, int32_t k, int x) {
  const int32_t d = s->el_entry_dependent[k], local = s->el_entry_local[k];
  if (d >= 0) return s->lookup[group->item[local]].n == ALI3_LOOKUP_BODY && d % 3 == x ? 4 + 4 * local + d / 3 : -1;
  const int32_t at = frame == NULL ? -1 : find_index(frame, ALI3_LOOKUP_BODY, local);
  return at >= 0 && at % 3 == x ? at / 3 : -1;
}

/* Whether signals i to i + 2 of a group are the components of a vector; *place: whether it is a point, thus has r. */
static bool is_vector(const ali3_system *s, const ali3_lookup_group *group, const int32_t *frame, int32_t i,
                      bool *is_point) {
  const int32_t first = group->entry[i], n = group->n_entry[i];
  *is_point = false;
  if (i + 2 >= group->n_signal || group->n_entry[i + 1] != n || group->n_entry[i + 2] != n) return false;
  for (int32_t k = first; k < first + n; k++) {
    const int32_t source = source_of(s, group, frame, k, 0);
    for (int x = 0; x < 3; x++) {
      int32_t same = 0; /* 1: found once, with the same value */
      for (int32_t o = group->entry[i + x], end = o + n; o < end; o++)
        if (source_of(s, group, frame, o, x) == source) same += s->el_entry_value[o] == s->el_entry_value[k] ? 1 : 2;
      if (source < 0 || same != 1) return false;
    }
    *is_point = *is_point || source == 0;
  }
  return true;
}

/* Whether signal i of a group depends only on lookup-table numbers and on coordinates other than those of its base. */
static bool is_number(const ali3_system *s, const ali3_lookup_group *group, const int32_t *frame, int32_t i) {
  for (int32_t k = group->entry[i], end = k + group->n_entry[i]; k < end; k++) {
    const int32_t local = s->el_entry_local[k];
    if (s->el_entry_dependent[k] >= 0) {
      if (s->lookup[group->item[local]].n != 1) return false;
    } else if (frame != NULL && find_index(frame, 12, local) >= 0) {
      return false;
    }
  }
  return true;
}

/* Lists for each vector those with which it shares an element; false: an element has only part of a vector, or not in
 * order. */
static bool derive_beside(const ali3_system *s, ali3_lookup_group *group) {
  for (int32_t o = group->first; o < group->end; o++) {
    const int32_t *signal = s->lookup_signal + s->el_sig_ptr[s->lookup_order[o]];
    const int32_t n = s->el_sig_ptr[s->lookup_order[o] + 1] - s->el_sig_ptr[s->lookup_order[o]];
    int32_t vectors[ALI3_LOOKUP_SIGNALS], n_vectors = 0;
    for (int32_t i = 0; i < n; i++) {
      const int32_t part = group->part[signal[i]];
      if (part == ALI3_LOOKUP_COMPONENT) return false;
      if (part < 0) continue;
      if (i + 2 >= n || signal[i + 1] != signal[i] + 1 || signal[i + 2] != signal[i] + 2) return false;
      vectors[n_vectors++] = part;
      i += 2;
    }
    for (int32_t i = 0; i < n_vectors; i++)
      for (int32_t k = 0; k < n_vectors; k++) {
        ali3_lookup_list *list = group->beside + vectors[i];
        if (memchr(list->at, vectors[k], list->n) == NULL) list->at[list->n++] = (uint8_t)vectors[k];
      }
  }
  return true;
}

/* Divides the signals of a group into vectors and numbers; false: this is not possible. */
static bool derive_parts(const ali3_system *s, ali3_lookup_group *group) {
  const int32_t *frame = NULL;
  int32_t slots[ALI3_LOOKUP_SINGLES], base = -1;
  group->base = -1;
  for (int32_t n = 0; n < group->n_item; n++) {
    const ali3_lookup *c = s->lookup + group->item[n];
    if (c->n != ALI3_LOOKUP_BODY || c->base == base) continue;
    if (base >= 0) return false;
    base = c->base;
    if (c->frame[0] < 0) continue;
    frame = group->slot[n];
    group->base = base;
  }
  for (int32_t i = 0; i < group->n_signal; i++) {
    bool is_point;
    if (is_vector(s, group, frame, i, &is_point)) {
      if (group->n_vector == ALI3_LOOKUP_VECTORS) return false;
      group->place[group->n_vector] = is_point;
      group->part[i] = (int8_t)group->n_vector;
      group->part[i + 1] = group->part[i + 2] = ALI3_LOOKUP_COMPONENT;
      group->vector[group->n_vector++] = i;
      i += 2;
    } else {
      if (group->n_number == ALI3_LOOKUP_NUMBERS || !is_number(s, group, frame, i)) return false;
      group->part[i] = (int8_t)(-1 - group->n_number);
      group->number[group->n_number++] = i;
    }
  }
  for (int32_t j = 0; frame != NULL && j < 12; j++) group->axis[frame[j]] = (int8_t)(j / 3);
  for (int32_t n = 0; n < group->n_item; n++)
    for (int p = 0; p < 2; p++) {
      const int32_t slot = group->slot[n][12 + p];
      if (slot >= 0 && !add_once(slots, &group->n_along, ALI3_LOOKUP_SINGLES, slot)) return false;
      group->along[n][p] = (int8_t)(slot < 0 ? -1 : find_index(slots, group->n_along, slot));
    }
  group->n_single = group->n_along;
  for (int32_t j = 0; j < group->m; j++)
    if (frame == NULL || find_index(frame, 12, j) < 0)
      if (!add_once(slots, &group->n_single, ALI3_LOOKUP_SINGLES, j)) return false;
  for (int32_t i = 0; i < group->n_single; i++) {
    const int32_t loc = group->loc[slots[i]];
    group->axis[slots[i]] = (int8_t)i;
    if (frame != NULL) entries_of_base(s, s->lookup_base + group->base, loc, group->to_base[i]);
    for (int32_t k = 0; k < group->n_single; k++)
      group->to_single[i][k] = entry_at(s, group->front, loc, group->loc[slots[k]]);
  }
  return derive_beside(s, group);
}

/* Orders the coordinates of group g and derives its elements, entries, parts and the size of its work array. */
static void derive_group(ali3_system *s, int32_t g) {
  ali3_lookup_group *group = s->lookup_group + g;
  int32_t loc[ALI3_LOOKUP_COLUMNS];
  ali3_sort(group->loc, group->m);
  for (int32_t n = 0; n < group->n_item; n++) {
    find_local(s, s->lookup + group->item[n], group->front, loc);
    for (int32_t k = 0; k < ALI3_LOOKUP_COLUMNS; k++) group->slot[n][k] = find_index(group->loc, group->m, loc[k]);
  }
  group->first = group->end = g == 0 ? 0 : group[-1].end;
  for (int32_t e = 0; e < s->size.ne; e++) {
    if (s->el_lookup[e] != g) continue;
    s->lookup_order[group->end++] = e;
    derive_entries(s, e, group);
  }
  group->parted = derive_parts(s, group);
  const int32_t n = group->n_signal, m = group->m, whole = n * (n + 2 * m);
  const int32_t work = group->parted ? (int32_t)(sizeof(ali3_lookup_parts) / sizeof(double)) : whole;
  if (work > s->lookup_square) s->lookup_square = work;
}

/* Assigns each element on lookup-table bodies to a group. */
static ali3_status derive_groups(ali3_system *s, ali3_message m) {
  for (int32_t e = 0; e < s->size.ne; e++) {
    ali3_lookup_group of = {.front = s->el_front[e]};
    int32_t g = 0;
    s->el_lookup[e] = -1;
    if (s->el_front[e] < 0 || !ali3_on_lookup(s, e)) continue;
    CHECK(collect_element(s, e, &of, m));
    while (g < s->n_lookup_group && !try_join(s->lookup_group + g, &of)) g++;
    s->el_lookup[e] = g;
    if (g == s->n_lookup_group) s->lookup_group[s->n_lookup_group++] = of;
  }
  for (int32_t g = 0; g < s->n_lookup_group; g++) derive_group(s, g);
  return ALI3_OK;
}

ali3_status ali3_lookup_derive(ali3_system *s, ali3_message m) {
  int32_t dependents = 0;
  int64_t coefficients = 0;
  if (s->n_lookup == 0) return ALI3_OK;
  for (int32_t i = 0; i < s->n_lookup; i++) CHECK(derive_item(s, i, &dependents, &coefficients, m));
  derive_seen(s);
  derive_bases(s);
  return derive_groups(s, m);
}
