/* Derives, when a System is loaded, entries of the tangents of elements, their contacts, and the elements with sensed
 * work. */
#include "derive_elements.h"

#include <string.h>

#include "../elements/element.h"
#include "../elements/road.h"
#include "../elements/tyre_contact.h"
#include "check.h"
#include "derive_lookup.h"
#include "loading.h"
#include "sensor_types.h"

bool ali3_is_triple(const int32_t *ptr, const int32_t *col, const double *val, int32_t i) {
  const int32_t n = ptr[i + 1] - ptr[i];
  const int32_t *a = col + ptr[i], *b = col + ptr[i + 1], *c = col + ptr[i + 2];
  if (n == 0 || ptr[i + 2] - ptr[i + 1] != n || ptr[i + 3] - ptr[i + 2] != n) return false;
  for (int32_t k = 0; k < n; k++)
    if (b[k] != a[k] + 1 || c[k] != a[k] + 2 || (k > 0 && a[k] < a[k - 1] + ALI3_TRIPLE)) return false;
  return ali3_same_values(ptr, val, i);
}

/* Marks the triples of n rows in the order of their evaluation. */
static void derive_triples(const ali3_system *s, const int32_t *row, int32_t n, unsigned char *triple) {
  for (int32_t a = 0; a < n; a++) {
    triple[a] = a + 2 < n && row[a + 1] == row[a] + 1 && row[a + 2] == row[a] + 2 &&
                ali3_is_triple(s->sig_ptr, s->sig_col, s->sig_val, row[a]);
    if (triple[a]) triple[a + 1] = triple[a + 2] = 0, a += 2;
  }
}

/* Entries of element e: value and index of the coordinate in the element, whose coordinates ascend as in the front. */
static void derive_element(ali3_system *s, int32_t e) {
  const int32_t first = s->el_entry_ptr[e], start = s->el_coordinate_ptr[e];
  const int32_t *loc = s->el_loc + s->el_loc_ptr[e];
  int32_t *coordinate = s->el_coordinate_loc + start;
  int32_t n = 0, unique = 0;
  for (int32_t i = s->el_sig_ptr[e]; i < s->el_sig_ptr[e + 1]; i++) {
    const int32_t signal = s->el_sig[i];
    for (int32_t k = s->sig_ptr[signal]; k < s->sig_ptr[signal + 1]; k++, n++) {
      s->el_entry_value[first + n] = s->sig_val[k];
      s->el_entry_local[first + n] = 0;
    }
  }
  if (s->el_front[e] >= 0 && !ali3_on_lookup(s, e)) {
    memcpy(coordinate, loc, (size_t)n * sizeof *loc);
    ali3_sort(coordinate, n);
    for (int32_t i = 0; i < n; i++)
      if (unique == 0 || coordinate[i] != coordinate[unique - 1]) coordinate[unique++] = coordinate[i];
    for (int32_t i = 0; i < n; i++) s->el_entry_local[first + i] = ali3_find(coordinate, unique, loc[i]);
  }
  int32_t contiguous_from = unique - 1;
  while (contiguous_from > 0 && coordinate[contiguous_from - 1] == coordinate[contiguous_from] - 1) contiguous_from--;
  s->el_apart[e] = contiguous_from;
  s->el_entry_ptr[e + 1] = first + n;
  s->el_coordinate_ptr[e + 1] = start + unique;
}

/* Range of the outputs of an element that are forces of a contact or a stop. */
static ali3_contact_forces_of contact_of(const ali3_system *s, int32_t e) {
  const ali3_element_type *kind = s->el_kind[e];
  const int32_t first = s->el_out_ptr[e] + kind->first_force;
  const bool tyre = kind->depth == ali3_tyre_depth;
  return (ali3_contact_forces_of){.element = e,
                                  .first = first,
                                  .n = kind->n_forces,
                                  .judged = tyre ? first + ALI3_TYRE_LOAD : first,
                                  .n_judged = tyre ? 1 : kind->n_forces,
                                  .tyre = tyre,
                                  .touches = kind->depth != NULL};
}

void ali3_elements_derive(ali3_system *s) {
  const int32_t ne = s->size.ne;
  s->el_S_off[0] = s->el_entry_ptr[0] = s->el_coordinate_ptr[0] = 0;
  for (int32_t e = 0; e < ne; e++) {
    const int32_t n = s->el_sig_ptr[e + 1] - s->el_sig_ptr[e];
    s->el_kind[e] = ali3_element_type_get(s->el_type[e]);
    s->el_size[e] = (ali3_element_size){.nsig = n,
                                        .nreal = s->el_parameter_ptr[e + 1] - s->el_parameter_ptr[e],
                                        .nint = s->el_int_ptr[e + 1] - s->el_int_ptr[e],
                                        .nstate = s->el_state_ptr[e + 1] - s->el_state_ptr[e],
                                        .nout = s->el_out_ptr[e + 1] - s->el_out_ptr[e],
                                        .real = s->el_parameter_ptr[e],
                                        .integer = s->el_int_ptr[e],
                                        .state = s->el_state_ptr[e],
                                        .out = s->el_out_ptr[e]};
    if (s->el_kind[e]->n_forces > 0) s->contact[s->n_contact++] = contact_of(s, e);
    if (s->el_kind[e]->resolved != NULL) s->has_force_tables = true;
    s->el_S_off[e + 1] = s->el_S_off[e] + (s->el_front[e] >= 0 ? n * n : 0);
    derive_element(s, e);
  }
  memset(s->active_signal, 0, (size_t)s->size.nsig * sizeof(int32_t));
  for (int64_t i = 0; i < s->n_el_sig; i++) s->active_signal[s->el_sig[i]] = 1;
  for (int32_t i = 0; i < s->size.nsig; i++)
    if (s->active_signal[i]) s->active_signal[s->n_active++] = i;
  derive_triples(s, s->active_signal, s->n_active, s->active_triple);
  for (int32_t e = 0; e < ne; e++) {
    const int32_t first = s->el_sig_ptr[e], n = s->el_sig_ptr[e + 1] - first;
    derive_triples(s, s->el_sig + first, n, s->el_triple + first);
    s->el_beside[e] = n > 0 ? s->el_sig[first] : -1;
    for (int32_t i = 1; i < n; i++)
      if (s->el_sig[first + i] != s->el_sig[first] + i) s->el_beside[e] = -1;
  }
}

void ali3_work_derive(ali3_system *s) {
  for (int32_t e = 0; e < s->size.ne; e++) s->work_of[e] = -1;
  for (int32_t i = 0; i < s->size.ns; i++) {
    const int32_t *v = s->sen_int + s->sen_int_ptr[i];
    const bool driving_work = s->sen_type[i] == ALI3_SENSOR_DRIVING_WORK;
    if (driving_work) s->n_driving_work = 1;
    if (s->sen_type[i] == ALI3_SENSOR_WORK)
      v++; /* after the kind */
    else if (!driving_work)
      continue;
    for (int32_t k = 1; k <= v[0]; k++) s->work_of[v[k]] = 0;
  }
  s->work_ptr[0] = 0;
  for (int32_t e = 0; e < s->size.ne; e++) {
    if (s->work_of[e] < 0) continue;
    s->work_of[e] = s->n_work;
    s->work_element[s->n_work++] = e;
    s->n_work_force += s->el_sig_ptr[e + 1] - s->el_sig_ptr[e];
    s->work_ptr[s->n_work] = s->n_work_force;
  }
  for (int32_t r = 0; r < s->nr; r++)
    if (s->road_type[r] == ALI3_ROAD_PORT) s->n_input_work = s->n_work;
}
