/* Which method takes which System. */
#include "check_method.h"
#include "../elements/spring_damper.h"
#include "../instance.h"
#include "../system/without_memory.h"

/* Whether the stops of a spring-damper take energy. */
static bool lossy_stops(const ali3_instance *in, int32_t e) {
  const int32_t first = in->system->el_real_ptr[e], n = in->system->el_real_ptr[e + 1] - first;
  const double *loss = in->el_real + first + ALI3_SPRING_STOP_LOSS;
  return n == ALI3_SPRING_REALS && (loss[0] != 0.0 || loss[1] != 0.0);
}

static bool conservative(const ali3_instance *in, int32_t e) {
  const double *real = in->el_real + in->system->el_real_ptr[e];
  switch (in->system->el_type[e]) {
  case ALI3_SPRING_DAMPER:
    return real[ALI3_SPRING_DAMPING] == 0.0 && !lossy_stops(in, e);
  case ALI3_SCALAR_SPRING_DAMPER:
    return real[1] == 0.0; /* damping */
  case ALI3_INPUT_FORCE:
  case ALI3_BODY_FORCE:
  case ALI3_BODY_TORQUE:
  case ALI3_GYROSCOPIC_SPIN:
  case ALI3_SPIN_TORQUE:
    return true;
  default:
    return false;
  }
}

/* Whether the method of the settings steps relative coordinates. */
bool ali3_relative(const ali3_instance *in) {
  const int32_t method = in->settings.method;
  return method == ALI3_METHOD_SEMI_RECURSIVE || method == ALI3_METHOD_SEMI_RECURSIVE_4;
}

/* ALI3_WRONG_METHOD where the method of the settings cannot take what the System has. */
ali3_status ali3_check_method(ali3_instance *in) {
  const ali3_system *S = in->system;
  const int32_t method = in->settings.method;
  const bool relative = ali3_relative(in);
  if (relative && S->tree == NULL) return ALI3_NO_TREE;
  if (!relative && method != ALI3_METHOD_ENERGY_MOMENTUM_4 && method != ALI3_METHOD_RUNGE_KUTTA_8 &&
      method != ALI3_METHOD_RADAU_5)
    return ALI3_OK;
  if (!ali3_without_memory(S)) return ALI3_WRONG_METHOD;
  if (method == ALI3_METHOD_RADAU_5 && S->n_velocity_row > 0) return ALI3_WRONG_METHOD; /* its tangent has no rate */
  for (int64_t i = 0; i < S->n_flex_C && method == ALI3_METHOD_ENERGY_MOMENTUM_4; i++)
    if (S->flex_C[i] != 0.0) return ALI3_WRONG_METHOD;
  for (int32_t e = 0; e < S->size.ne && method == ALI3_METHOD_ENERGY_MOMENTUM_4; e++)
    if (!conservative(in, e)) return ALI3_WRONG_METHOD;
  return ALI3_OK;
}
