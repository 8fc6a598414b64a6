/* The functions of fmi2_adapter.h in the native FMU: each calls the slave directly. */
#include "fmi2_adapter.h"

slave *fmi2_new(fmi2_adapter *adapter, const ali3_memory *memory, slave_logger *logger, bool logging, const char *name,
                const char *token, const char *resources) {
  return slave_new(memory, adapter, logger, logging, name, token, resources);
}

void fmi2_free(fmi2_adapter *adapter) { slave_free(adapter->s); }

slave_status fmi2_setup(slave *s, double start_time, bool stop_defined, double stop_time) {
  return slave_setup(s, start_time, stop_defined, stop_time);
}

slave_status fmi2_enter(slave *s) { return slave_enter(s); }

slave_status fmi2_exit(slave *s) { return slave_exit(s); }

slave_status fmi2_step(slave *s, double time, double step) { return slave_step(s, time, step); }

slave_status fmi2_terminate(slave *s) { return slave_terminate(s); }

slave_status fmi2_reset(slave *s) { return slave_reset(s); }

slave_status fmi2_get(slave *s, const uint32_t *reference, size_t n, double *value) {
  return slave_get(s, reference, n, value);
}

slave_status fmi2_set(slave *s, const uint32_t *reference, size_t n, const double *value) {
  return slave_set(s, reference, n, value);
}

slave_status fmi2_get_whole(slave *s, const uint32_t *reference, size_t n, int32_t *value) {
  return slave_get_whole(s, reference, n, value);
}

slave_status fmi2_set_whole(slave *s, const uint32_t *reference, size_t n, const int32_t *value) {
  return slave_set_whole(s, reference, n, value);
}
