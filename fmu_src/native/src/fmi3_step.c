/* FMI 3.0: communication steps and derivatives. */
#include <string.h>

#include "fmi3_adapter.h"

FMI3_ENTRY(fmi3DoStep,
           (fmi3Instance instance, fmi3Float64 time, fmi3Float64 step, fmi3Boolean no_set_state_prior,
            fmi3Boolean *event_needed, fmi3Boolean *terminate, fmi3Boolean *early_return,
            fmi3Float64 *last_successful_time),
           (instance, time, step, no_set_state_prior, event_needed, terminate, early_return, last_successful_time)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3DoStep", FMI3_RUN);
  (void)no_set_state_prior;
  if (adapter == NULL) return fmi3Error;
  const slave_status status = slave_step(adapter->s, time, step);
  if (event_needed != NULL) *event_needed = false;
  if (terminate != NULL) *terminate = slave_requests_end(adapter->s);
  if (early_return != NULL) *early_return = adapter->s->returned_early;
  if (last_successful_time != NULL) *last_successful_time = ali3_time(adapter->s->fidelity.kernel);
  return (fmi3Status)status;
}

FMI3_ENTRY(fmi3GetOutputDerivatives,
           (fmi3Instance instance, const fmi3ValueReference vr[], size_t n, const fmi3Int32 order[],
            fmi3Float64 value[], size_t n_values),
           (instance, vr, n, order, value, n_values)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3GetOutputDerivatives", FMI3_DERIVE);
  const bool valid = n == 0 || (vr != NULL && order != NULL && value != NULL);
  if (adapter == NULL || !fmi3_check_pointers(adapter, "fmi3GetOutputDerivatives", valid)) return fmi3Error;
  if (!fmi3_expand(adapter, 0, vr, n, n_values)) return fmi3Error;
  int32_t *orders = (int32_t *)adapter->items[1]; /* one per value */
  for (size_t i = 0, k = 0; i < n; i++)
    for (size_t j = fmi3_the_table.first[vr[i]]; j < fmi3_the_table.first[vr[i] + 1]; j++) orders[k++] = order[i];
  return (fmi3Status)slave_output_rates(adapter->s, adapter->items[0], n_values, orders, value);
}

/* Expands the unknowns and knowns of a call. False: pointers or counts do not fit, and an error was logged. */
static bool expand_arguments(fmi3_adapter *adapter, const char *function, const fmi3ValueReference *unknown,
                             size_t n_unknown, size_t n_unknown_values, const fmi3ValueReference *known, size_t n_known,
                             size_t n_known_values, bool valid) {
  return fmi3_check_pointers(adapter, function,
                             valid && (n_unknown == 0 || unknown != NULL) && (n_known == 0 || known != NULL)) &&
         fmi3_expand(adapter, 0, unknown, n_unknown, n_unknown_values) &&
         fmi3_expand(adapter, 1, known, n_known, n_known_values);
}

FMI3_ENTRY(fmi3GetDirectionalDerivative,
           (fmi3Instance instance, const fmi3ValueReference unknown[], size_t n_unknown,
            const fmi3ValueReference known[], size_t n_known, const fmi3Float64 seed[], size_t n_seed,
            fmi3Float64 sensitivity[], size_t n_sensitivity),
           (instance, unknown, n_unknown, known, n_known, seed, n_seed, sensitivity, n_sensitivity)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3GetDirectionalDerivative", FMI3_DERIVE);
  const bool valid = (n_seed == 0 || seed != NULL) && (n_sensitivity == 0 || sensitivity != NULL);
  if (adapter == NULL || !expand_arguments(adapter, "fmi3GetDirectionalDerivative", unknown, n_unknown, n_sensitivity,
                                           known, n_known, n_seed, valid))
    return fmi3Error;
  return (fmi3Status)slave_directional_derivative(adapter->s, adapter->items[0], n_sensitivity, adapter->items[1],
                                                  n_seed, seed, sensitivity);
}

/* One directional derivative for each known, as there are few inputs. */
FMI3_ENTRY(fmi3GetAdjointDerivative,
           (fmi3Instance instance, const fmi3ValueReference unknown[], size_t n_unknown,
            const fmi3ValueReference known[], size_t n_known, const fmi3Float64 seed[], size_t n_seed,
            fmi3Float64 sensitivity[], size_t n_sensitivity),
           (instance, unknown, n_unknown, known, n_known, seed, n_seed, sensitivity, n_sensitivity)) {
  fmi3_adapter *adapter = fmi3_slave(instance, "fmi3GetAdjointDerivative", FMI3_DERIVE);
  const bool valid = (n_seed == 0 || seed != NULL) && (n_sensitivity == 0 || sensitivity != NULL);
  if (adapter == NULL || !expand_arguments(adapter, "fmi3GetAdjointDerivative", unknown, n_unknown, n_seed, known,
                                           n_known, n_sensitivity, valid))
    return fmi3Error;
  slave_status status = SLAVE_OK;
  memset(adapter->unit, 0, n_sensitivity * sizeof(double));
  for (size_t k = 0; k < n_sensitivity && status == SLAVE_OK; k++) {
    adapter->unit[k] = 1.0;
    status = slave_directional_derivative(adapter->s, adapter->items[0], n_seed, adapter->items[1], n_sensitivity,
                                          adapter->unit, adapter->derivative);
    adapter->unit[k] = 0.0;
    double sum = 0.0;
    for (size_t i = 0; i < n_seed && status == SLAVE_OK; i++) sum += seed[i] * adapter->derivative[i];
    if (status == SLAVE_OK) sensitivity[k] = sum;
  }
  return (fmi3Status)status;
}
