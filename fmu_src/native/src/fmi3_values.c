/* FMI 3.0: getting and setting. All variables are of type Float64. */
#include "fmi3_face.h"

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetFloat64)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                 fmi3Float64 value[], size_t n_values) {
  fmi3_face *face = fmi3_slave(instance, "fmi3GetFloat64", FMI3_GET);
  if (face == NULL || !fmi3_given(face, "fmi3GetFloat64", n == 0 || (vr != NULL && value != NULL))) return fmi3Error;
  if (n == 1 && n_values == 1 && vr[0] == fmi3_the_table.n_arrays) {
    value[0] = face->s->calls.phase == SLAVE_INITIALISING ? face->s->calls.start_time : ali3_time(face->s->rung.kernel);
    return fmi3OK;
  }
  if (!fmi3_expand(face, 0, vr, n, n_values)) return fmi3Error;
  return (fmi3Status)slave_get(face->s, face->items[0], n_values, value);
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetFloat64)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                 const fmi3Float64 value[], size_t n_values) {
  fmi3_face *face = fmi3_slave(instance, "fmi3SetFloat64", FMI3_SET);
  if (face == NULL || !fmi3_given(face, "fmi3SetFloat64", n == 0 || (vr != NULL && value != NULL))) return fmi3Error;
  if (!fmi3_expand(face, 0, vr, n, n_values)) return fmi3Error;
  return (fmi3Status)slave_set(face->s, face->items[0], n_values, value);
}

static fmi3Status other_type(fmi3Instance instance, const char *function, unsigned mask, size_t n) {
  fmi3_face *face = fmi3_slave(instance, function, mask);
  if (face == NULL) return fmi3Error;
  if (n == 0) return fmi3OK;
  return (fmi3Status)slave_say(face->s, SLAVE_ERROR, "%s: all variables of this FMU are of type Float64.", function);
}

#define OTHER_TYPE(Type)                                                                                               \
  FMI3_EXPORT fmi3Status FMI3_NAME(fmi3Get##Type)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,      \
                                                  fmi3##Type value[], size_t n_values) {                               \
    (void)vr, (void)value, (void)n_values;                                                                             \
    return other_type(instance, "fmi3Get" #Type, FMI3_GET, n);                                                         \
  }                                                                                                                    \
  FMI3_EXPORT fmi3Status FMI3_NAME(fmi3Set##Type)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,      \
                                                  const fmi3##Type value[], size_t n_values) {                         \
    (void)vr, (void)value, (void)n_values;                                                                             \
    return other_type(instance, "fmi3Set" #Type, FMI3_SET, n);                                                         \
  }

OTHER_TYPE(Float32)
OTHER_TYPE(Int8)
OTHER_TYPE(UInt8)
OTHER_TYPE(Int16)
OTHER_TYPE(UInt16)
OTHER_TYPE(Int32)
OTHER_TYPE(UInt32)
OTHER_TYPE(Int64)
OTHER_TYPE(UInt64)
OTHER_TYPE(Boolean)
OTHER_TYPE(String)

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetBinary)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                size_t size[], fmi3Binary value[], size_t n_values) {
  (void)vr, (void)size, (void)value, (void)n_values;
  return other_type(instance, "fmi3GetBinary", FMI3_GET, n);
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetBinary)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                const size_t size[], const fmi3Binary value[], size_t n_values) {
  (void)vr, (void)size, (void)value, (void)n_values;
  return other_type(instance, "fmi3SetBinary", FMI3_SET, n);
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetClock)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                               fmi3Clock value[]) {
  (void)vr, (void)value;
  return other_type(instance, "fmi3GetClock", FMI3_GET, n);
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetClock)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                               const fmi3Clock value[]) {
  (void)vr, (void)value;
  return other_type(instance, "fmi3SetClock", FMI3_SET, n);
}
