/* Test whether q and qd are the only states of a System. */
#include "state_coordinates.h"
#include "../rows/driving_functions.h"
#include "../system.h"

bool ali3_states_are_coordinates(const ali3_system *S) {
  if (S->size.ny > 0) return false;
  for (int32_t g = 0; g < S->size.ng; g++)
    if (ali3_driving_filters(S->guide_type[g])) return false;
  return true;
}
