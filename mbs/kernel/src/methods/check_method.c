/* Which method takes which System. */
#include "check_method.h"
#include "../elements/spring_damper.h"
#include "../instance.h"
#include "../method.h"
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

/* Neither elements nor flexible bodies damp. */
bool ali3_conservative(const ali3_instance *in) {
  const ali3_system *S = in->system;
  for (int64_t i = 0; i < S->n_flex_C; i++)
    if (S->flex_C[i] != 0.0) return false;
  for (int32_t e = 0; e < S->size.ne; e++)
    if (!conservative(in, e)) return false;
  return true;
}

/* ALI3_OK, or why the method of the settings cannot take the System. */
ali3_status ali3_check_method(const ali3_instance *in) {
  const ali3_method *method = ali3_method_of(in);
  return method->takes != NULL ? method->takes(in) : ALI3_OK;
}

/* ALI3_WRONG_METHOD where stages inside a step need more than q, qd and the time. */
ali3_status ali3_needs_no_memory(const ali3_instance *in) {
  return ali3_without_memory(in->system) ? ALI3_OK : ALI3_WRONG_METHOD;
}
