/* Checks the start of a System: values for the search of the equilibrium, partners of its pose. */
#include <stdlib.h>

#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"

ali3_status ali3_check_start(const ali3_system *s, ali3_message m) {
  if (s->n_static_q != 0 && s->n_static_q != s->size.nq + s->size.ny)
    CHECK(ali3_check_length(m, "static_q", s->n_static_q, s->size.nq));
  for (int64_t i = 0; i < s->n_static_par; i++)
    if (!(s->static_value[i] >= s->par_min[s->static_par[i]] && s->static_value[i] <= s->par_max[s->static_par[i]]))
      return ali3_bad(m, "the search for the equilibrium sets parameter %d to %g, outside its range",
                      (int)s->static_par[i], s->static_value[i]);
  if (s->n_static_start > 0) CHECK(ali3_check_length(m, "pose_partner", s->n_pose_partner, s->n_pose_0));
  for (int64_t i = 0; i < s->n_pose_partner; i++)
    if (s->pose_partner[i] != 0) CHECK(ali3_check_independent(s, abs(s->pose_partner[i]) - 1, "a pose", m));
  return ALI3_OK;
}
