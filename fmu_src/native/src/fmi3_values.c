/* FMI 3.0: getting and setting variables. Int32 can be read and set as Float64 too, their type before version 0.2. */
#include "fmi3_adapter.h"

/* s; before the first step the start time. */
static double current_time(const slave *s) {
  const bool before = (s->calls.phase & (SLAVE_INSTANTIATED | SLAVE_INITIALISING)) != 0;
  return before ? s->calls.start_time : ali3_time(s->fidelity.kernel);
}

/* Time may be read anywhere in a call and more than once; the variables between are read together. */
FMI3_ENTRY(fmi3GetFloat64,
           (fmi3Instance instance, const fmi3ValueReference vr[], size_t n, fmi3Float64 value[], size_t n_values),
           (instance, vr, n, value, n_values)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3GetFloat64", FMI3_ANY);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3GetFloat64", n == 0 || (vr != NULL && value != NULL)))
    return fmi3Error;
  const fmi3ValueReference time = fmi3_the_table.time;
  if (!fmi3_check_count(adapter, vr, n, n_values)) return fmi3Error;
  size_t n_read = 0;
  for (size_t i = 0; i < n;) {
    if (vr[i] == time) {
      value[n_read++] = current_time(adapter->s);
      i++;
      continue;
    }
    size_t end = i, count = 0, size = fmi3_array_size(vr[i]);
    while (end < n && vr[end] != time && count + (size = fmi3_array_size(vr[end])) <= adapter->capacity) {
      count += size;
      end++;
    }
    if (!fmi3_expand(adapter, 0, vr + i, end - i, count)) return fmi3Error;
    const slave_status status = slave_get(adapter->s, adapter->items[0], count, value + n_read);
    if (status != SLAVE_OK) return (fmi3Status)status;
    n_read += count;
    i = end;
  }
  return fmi3OK;
}

FMI3_ENTRY(fmi3GetInt32,
           (fmi3Instance instance, const fmi3ValueReference vr[], size_t n, fmi3Int32 value[], size_t n_values),
           (instance, vr, n, value, n_values)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3GetInt32", FMI3_ANY);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3GetInt32", n == 0 || (vr != NULL && value != NULL)))
    return fmi3Error;
  if (!fmi3_expand(adapter, 0, vr, n, n_values)) return fmi3Error;
  return (fmi3Status)slave_get_whole(adapter->s, adapter->items[0], n_values, value);
}

FMI3_ENTRY(fmi3SetInt32,
           (fmi3Instance instance, const fmi3ValueReference vr[], size_t n, const fmi3Int32 value[], size_t n_values),
           (instance, vr, n, value, n_values)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3SetInt32", FMI3_SET);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3SetInt32", n == 0 || (vr != NULL && value != NULL)))
    return fmi3Error;
  if (!fmi3_expand(adapter, 0, vr, n, n_values)) return fmi3Error;
  return (fmi3Status)slave_set_whole(adapter->s, adapter->items[0], n_values, value);
}

FMI3_ENTRY(fmi3SetFloat64,
           (fmi3Instance instance, const fmi3ValueReference vr[], size_t n, const fmi3Float64 value[], size_t n_values),
           (instance, vr, n, value, n_values)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3SetFloat64", FMI3_SET);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3SetFloat64", n == 0 || (vr != NULL && value != NULL)))
    return fmi3Error;
  if (!fmi3_expand(adapter, 0, vr, n, n_values)) return fmi3Error;
  return (fmi3Status)(adapter->updating ? slave_set_intermediate(adapter->s, adapter->items[0], n_values, value)
                                        : slave_set(adapter->s, adapter->items[0], n_values, value));
}

/* Whether the numbers of references and values are equal; if not, an error is logged. */
static bool check_text_count(fmi3_adapter *adapter, size_t n, size_t n_values) {
  if (n == n_values) return true;
  slave_log(adapter->s, SLAVE_ERROR, "The variables have %zu values, the call gives room for %zu.", n, n_values);
  return false;
}

/* Status of a call for a type that no variable has. */
static fmi3Status refuse_type(fmi3Instance instance, const char *function, unsigned phases, size_t n) {
  fmi3_adapter *adapter = fmi3_slave(instance, function, phases);
  if (adapter == NULL) return fmi3Error;
  if (n == 0) return fmi3OK;
  return (fmi3Status)slave_log(adapter->s, SLAVE_ERROR,
                               "%s: all variables of this FMU are of type Float64, Int32 or String.", function);
}

#define REFUSE_TYPE(Type)                                                                                              \
  FMI3_EXPORT fmi3Status FMI3_NAME(fmi3Get##Type)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,      \
                                                  fmi3##Type value[], size_t n_values) {                               \
    (void)vr, (void)value, (void)n_values;                                                                             \
    return refuse_type(instance, "fmi3Get" #Type, FMI3_ANY, n);                                                        \
  }                                                                                                                    \
  FMI3_EXPORT fmi3Status FMI3_NAME(fmi3Set##Type)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,      \
                                                  const fmi3##Type value[], size_t n_values) {                         \
    (void)vr, (void)value, (void)n_values;                                                                             \
    return refuse_type(instance, "fmi3Set" #Type, FMI3_SET, n);                                                        \
  }

REFUSE_TYPE(Float32)
REFUSE_TYPE(Int8)
REFUSE_TYPE(UInt8)
REFUSE_TYPE(Int16)
REFUSE_TYPE(UInt16)
REFUSE_TYPE(UInt32)
REFUSE_TYPE(Int64)
REFUSE_TYPE(UInt64)
REFUSE_TYPE(Boolean)

/* Value references of text variables follow those of all others. */
FMI3_ENTRY(fmi3GetString,
           (fmi3Instance instance, const fmi3ValueReference vr[], size_t n, fmi3String value[], size_t n_values),
           (instance, vr, n, value, n_values)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3GetString", FMI3_ANY);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3GetString", n == 0 || (vr != NULL && value != NULL)))
    return fmi3Error;
  if (!check_text_count(adapter, n, n_values)) return fmi3Error;
  return (fmi3Status)slave_get_text(adapter->s, (uint32_t)fmi3_the_table.n_arrays, vr, n, value);
}

FMI3_ENTRY(fmi3SetString,
           (fmi3Instance instance, const fmi3ValueReference vr[], size_t n, const fmi3String value[], size_t n_values),
           (instance, vr, n, value, n_values)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3SetString", FMI3_SET);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3SetString", n == 0 || (vr != NULL && value != NULL)))
    return fmi3Error;
  if (!check_text_count(adapter, n, n_values)) return fmi3Error;
  return (fmi3Status)slave_set_text(adapter->s, (uint32_t)fmi3_the_table.n_arrays, vr, n, value);
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetBinary)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                size_t size[], fmi3Binary value[], size_t n_values) {
  (void)vr, (void)size, (void)value, (void)n_values;
  return refuse_type(instance, "fmi3GetBinary", FMI3_ANY, n);
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetBinary)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                const size_t size[], const fmi3Binary value[], size_t n_values) {
  (void)vr, (void)size, (void)value, (void)n_values;
  return refuse_type(instance, "fmi3SetBinary", FMI3_SET, n);
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetClock)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                               fmi3Clock value[]) {
  (void)vr, (void)value;
  return refuse_type(instance, "fmi3GetClock", FMI3_ANY, n);
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetClock)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                               const fmi3Clock value[]) {
  (void)vr, (void)value;
  return refuse_type(instance, "fmi3SetClock", FMI3_SET, n);
}
