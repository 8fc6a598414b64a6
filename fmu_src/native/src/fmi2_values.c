/* FMI 2.0: getting and setting variables. Integers can be read and set as Real too, their type before version 0.2. */
#include "fmi2_adapter.h"

FMI2_ENTRY(fmi2GetReal, (fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[]),
           (c, vr, n, value)) {
  slave *s = fmi2_slave(c, "fmi2GetReal", FMI2_GET);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2GetReal", n == 0 || (vr != NULL && value != NULL))) return fmi2Error;
  return (fmi2Status)fmi2_get(s, vr, n, value);
}

FMI2_ENTRY(fmi2SetReal, (fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Real value[]),
           (c, vr, n, value)) {
  slave *s = fmi2_slave(c, "fmi2SetReal", FMI2_SET);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2SetReal", n == 0 || (vr != NULL && value != NULL))) return fmi2Error;
  return (fmi2Status)fmi2_set(s, vr, n, value);
}

FMI2_ENTRY(fmi2GetInteger, (fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Integer value[]),
           (c, vr, n, value)) {
  slave *s = fmi2_slave(c, "fmi2GetInteger", FMI2_GET);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2GetInteger", n == 0 || (vr != NULL && value != NULL))) return fmi2Error;
  return (fmi2Status)fmi2_get_whole(s, vr, n, value);
}

FMI2_ENTRY(fmi2SetInteger, (fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Integer value[]),
           (c, vr, n, value)) {
  slave *s = fmi2_slave(c, "fmi2SetInteger", FMI2_SET);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2SetInteger", n == 0 || (vr != NULL && value != NULL))) return fmi2Error;
  return (fmi2Status)fmi2_set_whole(s, vr, n, value);
}

/* Status of a call for a type that no variable has. */
static fmi2Status refuse_type(fmi2Component c, const char *function, unsigned phases, size_t n) {
  slave *s = fmi2_slave(c, function, phases);
  if (s == NULL) return fmi2Error;
  if (n == 0) return fmi2OK;
  return (fmi2Status)slave_log(s, SLAVE_ERROR, "%s: all variables of this FMU are of type Real, Integer or String.",
                               function);
}

FMI2_EXPORT fmi2Status FMI2_NAME(fmi2GetBoolean)(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                                 fmi2Boolean value[]) {
  (void)vr, (void)value;
  return refuse_type(c, "fmi2GetBoolean", FMI2_GET, n);
}

/* Value references of text variables follow those of all others. */
FMI2_ENTRY(fmi2GetString, (fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2String value[]),
           (c, vr, n, value)) {
  slave *s = fmi2_slave(c, "fmi2GetString", FMI2_GET);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2GetString", n == 0 || (vr != NULL && value != NULL))) return fmi2Error;
  return (fmi2Status)slave_get_text(s, (uint32_t)slave_the_table.n_variables, vr, n, value);
}

FMI2_EXPORT fmi2Status FMI2_NAME(fmi2SetBoolean)(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                                 const fmi2Boolean value[]) {
  (void)vr, (void)value;
  return refuse_type(c, "fmi2SetBoolean", FMI2_SET, n);
}

FMI2_ENTRY(fmi2SetString, (fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2String value[]),
           (c, vr, n, value)) {
  slave *s = fmi2_slave(c, "fmi2SetString", FMI2_SET);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2SetString", n == 0 || (vr != NULL && value != NULL))) return fmi2Error;
  return (fmi2Status)slave_set_text(s, (uint32_t)slave_the_table.n_variables, vr, n, value);
}
