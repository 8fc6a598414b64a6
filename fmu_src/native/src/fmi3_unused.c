/* FMI 3.0: functions for features that this FMU does not have: clocks, events, model exchange, structural parameters.
 * Hosts require that the library has them. */
#include "fmi3_adapter.h"

/* Status of a call for a feature that the FMU does not have. */
static fmi3Status refuse(fmi3Instance instance, const char *function, const char *feature) {
  fmi3_adapter *adapter = instance;
  if (adapter == NULL) return fmi3Error;
  return (fmi3Status)slave_log(adapter->s, SLAVE_ERROR, "%s: this FMU has no %s.", function, feature);
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3EnterEventMode)(fmi3Instance instance) {
  return refuse(instance, "fmi3EnterEventMode", "event mode");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3EnterStepMode)(fmi3Instance instance) {
  return refuse(instance, "fmi3EnterStepMode", "event mode");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3EvaluateDiscreteStates)(fmi3Instance instance) {
  return refuse(instance, "fmi3EvaluateDiscreteStates", "event mode");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3UpdateDiscreteStates)(fmi3Instance instance, fmi3Boolean *more,
                                                           fmi3Boolean *terminate, fmi3Boolean *nominals,
                                                           fmi3Boolean *values, fmi3Boolean *next_defined,
                                                           fmi3Float64 *next) {
  (void)more, (void)terminate, (void)nominals, (void)values, (void)next_defined, (void)next;
  return refuse(instance, "fmi3UpdateDiscreteStates", "event mode");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetIntervalDecimal)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                         fmi3Float64 interval[], fmi3IntervalQualifier qualifier[]) {
  (void)vr, (void)n, (void)interval, (void)qualifier;
  return refuse(instance, "fmi3GetIntervalDecimal", "clocks");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetIntervalFraction)(fmi3Instance instance, const fmi3ValueReference vr[],
                                                          size_t n, fmi3UInt64 counter[], fmi3UInt64 resolution[],
                                                          fmi3IntervalQualifier qualifier[]) {
  (void)vr, (void)n, (void)counter, (void)resolution, (void)qualifier;
  return refuse(instance, "fmi3GetIntervalFraction", "clocks");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetShiftDecimal)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                      fmi3Float64 shift[]) {
  (void)vr, (void)n, (void)shift;
  return refuse(instance, "fmi3GetShiftDecimal", "clocks");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetShiftFraction)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                       fmi3UInt64 counter[], fmi3UInt64 resolution[]) {
  (void)vr, (void)n, (void)counter, (void)resolution;
  return refuse(instance, "fmi3GetShiftFraction", "clocks");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetIntervalDecimal)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                         const fmi3Float64 interval[]) {
  (void)vr, (void)n, (void)interval;
  return refuse(instance, "fmi3SetIntervalDecimal", "clocks");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetIntervalFraction)(fmi3Instance instance, const fmi3ValueReference vr[],
                                                          size_t n, const fmi3UInt64 counter[],
                                                          const fmi3UInt64 resolution[]) {
  (void)vr, (void)n, (void)counter, (void)resolution;
  return refuse(instance, "fmi3SetIntervalFraction", "clocks");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetShiftDecimal)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                      const fmi3Float64 shift[]) {
  (void)vr, (void)n, (void)shift;
  return refuse(instance, "fmi3SetShiftDecimal", "clocks");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetShiftFraction)(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                                       const fmi3UInt64 counter[], const fmi3UInt64 resolution[]) {
  (void)vr, (void)n, (void)counter, (void)resolution;
  return refuse(instance, "fmi3SetShiftFraction", "clocks");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3ActivateModelPartition)(fmi3Instance instance, fmi3ValueReference clock,
                                                             fmi3Float64 time) {
  (void)clock, (void)time;
  return refuse(instance, "fmi3ActivateModelPartition", "clocks");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3EnterConfigurationMode)(fmi3Instance instance) {
  return refuse(instance, "fmi3EnterConfigurationMode", "structural parameters");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3ExitConfigurationMode)(fmi3Instance instance) {
  return refuse(instance, "fmi3ExitConfigurationMode", "structural parameters");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetNumberOfVariableDependencies)(fmi3Instance instance, fmi3ValueReference vr,
                                                                      size_t *n) {
  (void)vr, (void)n;
  return refuse(instance, "fmi3GetNumberOfVariableDependencies", "dependencies per element");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetVariableDependencies)(fmi3Instance instance, fmi3ValueReference dependent,
                                                              size_t dependent_index[],
                                                              fmi3ValueReference independent[],
                                                              size_t independent_index[], fmi3DependencyKind kind[],
                                                              size_t n) {
  (void)dependent, (void)dependent_index, (void)independent, (void)independent_index, (void)kind, (void)n;
  return refuse(instance, "fmi3GetVariableDependencies", "dependencies per element");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3EnterContinuousTimeMode)(fmi3Instance instance) {
  return refuse(instance, "fmi3EnterContinuousTimeMode", "model exchange");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3CompletedIntegratorStep)(fmi3Instance instance, fmi3Boolean no_set_state_prior,
                                                              fmi3Boolean *event, fmi3Boolean *terminate) {
  (void)no_set_state_prior, (void)event, (void)terminate;
  return refuse(instance, "fmi3CompletedIntegratorStep", "model exchange");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetTime)(fmi3Instance instance, fmi3Float64 time) {
  (void)time;
  return refuse(instance, "fmi3SetTime", "model exchange");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetContinuousStates)(fmi3Instance instance, const fmi3Float64 x[], size_t n) {
  (void)x, (void)n;
  return refuse(instance, "fmi3SetContinuousStates", "model exchange");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetContinuousStateDerivatives)(fmi3Instance instance, fmi3Float64 dx[], size_t n) {
  (void)dx, (void)n;
  return refuse(instance, "fmi3GetContinuousStateDerivatives", "model exchange");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetEventIndicators)(fmi3Instance instance, fmi3Float64 z[], size_t n) {
  (void)z, (void)n;
  return refuse(instance, "fmi3GetEventIndicators", "model exchange");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetContinuousStates)(fmi3Instance instance, fmi3Float64 x[], size_t n) {
  (void)x, (void)n;
  return refuse(instance, "fmi3GetContinuousStates", "model exchange");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetNominalsOfContinuousStates)(fmi3Instance instance, fmi3Float64 nominal[],
                                                                    size_t n) {
  (void)nominal, (void)n;
  return refuse(instance, "fmi3GetNominalsOfContinuousStates", "model exchange");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetNumberOfEventIndicators)(fmi3Instance instance, size_t *n) {
  (void)n;
  return refuse(instance, "fmi3GetNumberOfEventIndicators", "model exchange");
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetNumberOfContinuousStates)(fmi3Instance instance, size_t *n) {
  (void)n;
  return refuse(instance, "fmi3GetNumberOfContinuousStates", "model exchange");
}
