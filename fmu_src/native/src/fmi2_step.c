/* FMI 2.0: communication steps, their status, and derivatives. */
#include "fmi2_adapter.h"

FMI2_ENTRY(fmi2DoStep, (fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean no_set_state_prior),
           (c, time, step, no_set_state_prior)) {
  slave *s = fmi2_slave(c, "fmi2DoStep", FMI2_RUN);
  (void)no_set_state_prior;
  return s != NULL ? (fmi2Status)fmi2_step(s, time, step) : fmi2Error;
}

FMI2_ENTRY(fmi2CancelStep, (fmi2Component c), (c)) {
  slave *s = fmi2_slave(c, "fmi2CancelStep", FMI2_ANY);
  if (s == NULL) return fmi2Error;
  return (fmi2Status)slave_log(s, SLAVE_ERROR, "No step is under way: steps of this FMU end before fmi2DoStep does.");
}

/* Other statuses are those of asynchronous steps, which this FMU does not have. */
static fmi2Status discard_status(fmi2Component c, const char *function) {
  slave *s = fmi2_slave(c, function, FMI2_DONE);
  if (s == NULL) return fmi2Error;
  return (fmi2Status)slave_log(s, SLAVE_DISCARD, "%s: this FMU has no such status.", function);
}

FMI2_ENTRY(fmi2GetStatus, (fmi2Component c, const fmi2StatusKind kind, fmi2Status *value), (c, kind, value)) {
  slave *s = fmi2_slave(c, "fmi2GetStatus", FMI2_DONE);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2GetStatus", value != NULL)) return fmi2Error;
  if (kind != fmi2DoStepStatus) return discard_status(c, "fmi2GetStatus");
  *value = (fmi2Status)s->last_step;
  return fmi2OK;
}

FMI2_ENTRY(fmi2GetRealStatus, (fmi2Component c, const fmi2StatusKind kind, fmi2Real *value), (c, kind, value)) {
  slave *s = fmi2_slave(c, "fmi2GetRealStatus", FMI2_DONE);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2GetRealStatus", value != NULL)) return fmi2Error;
  if (kind != fmi2LastSuccessfulTime) return discard_status(c, "fmi2GetRealStatus");
  *value = ali3_time(s->fidelity.kernel);
  return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2_NAME(fmi2GetIntegerStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value) {
  (void)kind, (void)value;
  return discard_status(c, "fmi2GetIntegerStatus");
}

FMI2_ENTRY(fmi2GetBooleanStatus, (fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value), (c, kind, value)) {
  slave *s = fmi2_slave(c, "fmi2GetBooleanStatus", FMI2_DONE);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2GetBooleanStatus", value != NULL)) return fmi2Error;
  if (kind != fmi2Terminated) return discard_status(c, "fmi2GetBooleanStatus");
  *value = slave_requests_end(s);
  return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2_NAME(fmi2GetStringStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2String *value) {
  (void)kind, (void)value;
  return discard_status(c, "fmi2GetStringStatus");
}

FMI2_ENTRY(fmi2SetRealInputDerivatives,
           (fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Integer order[],
            const fmi2Real value[]),
           (c, vr, n, order, value)) {
  slave *s = fmi2_slave(c, "fmi2SetRealInputDerivatives", FMI2_SET);
  const bool valid = n == 0 || (vr != NULL && order != NULL && value != NULL);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2SetRealInputDerivatives", valid)) return fmi2Error;
  return (fmi2Status)slave_set_slopes(s, vr, n, order, value);
}

FMI2_ENTRY(fmi2GetRealOutputDerivatives,
           (fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Integer order[], fmi2Real value[]),
           (c, vr, n, order, value)) {
  slave *s = fmi2_slave(c, "fmi2GetRealOutputDerivatives", FMI2_GET);
  const bool valid = n == 0 || (vr != NULL && order != NULL && value != NULL);
  if (s == NULL || !fmi2_check_pointers(s, "fmi2GetRealOutputDerivatives", valid)) return fmi2Error;
  return (fmi2Status)slave_output_rates(s, vr, n, order, value);
}

FMI2_ENTRY(fmi2GetDirectionalDerivative,
           (fmi2Component c, const fmi2ValueReference unknown[], size_t n_unknown, const fmi2ValueReference known[],
            size_t n_known, const fmi2Real seed[], fmi2Real value[]),
           (c, unknown, n_unknown, known, n_known, seed, value)) {
  slave *s = fmi2_slave(c, "fmi2GetDirectionalDerivative", FMI2_GET);
  const bool valid =
      (n_unknown == 0 || (unknown != NULL && value != NULL)) && (n_known == 0 || (known != NULL && seed != NULL));
  if (s == NULL || !fmi2_check_pointers(s, "fmi2GetDirectionalDerivative", valid)) return fmi2Error;
  return (fmi2Status)slave_directional_derivative(s, unknown, n_unknown, known, n_known, seed, value);
}
