/* Checks the payloads of a System (point masses at signals, with entries in the mass matrix), its armatures, and bodies
 * with inertia set by parameters. */
#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"

bool ali3_mass_has_room(const ali3_system *s, int32_t one, int32_t other) {
  for (int32_t a = s->sig_ptr[one]; a < s->sig_ptr[one + 1]; a++)
    for (int32_t b = s->sig_ptr[other]; b < s->sig_ptr[other + 1]; b++) {
      const int32_t row = s->sig_col[a], first = s->mass_ptr[row];
      if (ali3_find(s->mass_col + first, s->mass_ptr[row + 1] - first, s->sig_col[b]) < 0) return false;
    }
  return true;
}

ali3_status ali3_check_payloads(const ali3_system *s, ali3_message m) {
  const int64_t n = s->n_payload_mass;
  for (int64_t i = 0; i < 3 * n; i++) CHECK(ali3_check_independent(s, s->payload_signal[i], "a payload", m));
  for (int64_t i = 0; i < 3 * n; i++)
    if (!ali3_mass_has_room(s, s->payload_signal[i], s->payload_signal[i]))
      return ali3_bad(m, "payload %d is at coordinates between which the mass matrix has no entry", (int)(i / 3));
  return ALI3_OK;
}

ali3_status ali3_check_inertias(const ali3_system *s, ali3_message m) {
  const int64_t n = s->n_inertia_parameter / ALI3_INERTIA_REALS;
  for (int64_t i = 0; i < ALI3_INERTIA_SIGNALS * n; i++)
    CHECK(ali3_check_independent(s, s->inertia_signal[i], "a body whose inertia parameters write", m));
  /* each signal of a body with the same component of its four vectors */
  for (int64_t i = 0; i < ALI3_INERTIA_SIGNALS * n; i++)
    for (int64_t v = 0; v < ALI3_INERTIA_SIGNALS; v += 3)
      if (!ali3_mass_has_room(s, s->inertia_signal[i],
                              s->inertia_signal[i / ALI3_INERTIA_SIGNALS * ALI3_INERTIA_SIGNALS + i % 3 + v]))
        return ali3_bad(m, "the mass matrix has no entry for the inertia %d that parameters write",
                        (int)(i / ALI3_INERTIA_SIGNALS));
  if (n > 0 && s->n_tree_parent > 0) return ali3_bad(m, "a parameter writes the inertia of a body of a tree");
  return ALI3_OK;
}

ali3_status ali3_check_armatures(const ali3_system *s, ali3_message m) {
  const int64_t n = s->n_armature_ratio;
  for (int64_t k = 0; k < n; k++) {
    const int32_t row = s->armature_col[k], first = s->mass_ptr[row];
    const int32_t entry = ali3_find(s->mass_col + first, s->mass_ptr[row + 1] - first, row);
    const double armature_inertia = s->armature_inertia[k] * s->armature_ratio[k] * s->armature_ratio[k];
    if (!(s->armature_inertia[k] >= 0.0) || entry < 0 ||
        !(armature_inertia <= (1.0 + 1e-9) * s->mass_val[first + entry]))
      return ali3_bad(m, "the inertia of armature %d is not in that of its coordinate", (int)k);
  }
  return ALI3_OK;
}
