/* Parameters and inputs of the kernel at a communication step, to repeat it. */
#include "slave.h"

void slave_read_step(const slave *s, double *parameter, double *input) {
  const ali3_sizes z = ali3_system_sizes(s->fidelity.system);
  for (int32_t i = 0; i < z.np; i++) ali3_get_parameter(s->fidelity.kernel, i, &parameter[i]);
  for (int32_t i = 0; i < z.nu; i++) ali3_get_input(s->fidelity.kernel, i, &input[i]);
}

ali3_status slave_restore_step(const slave *s, const double *parameter, const double *input) {
  const ali3_sizes z = ali3_system_sizes(s->fidelity.system);
  ali3_instance *kernel = s->fidelity.kernel;
  ali3_status status = ALI3_OK;
  for (int32_t i = 0; i < z.np && status == ALI3_OK; i++) {
    double present;
    ali3_get_parameter(kernel, i, &present);
    if (present != parameter[i]) status = ali3_set_parameter(kernel, i, parameter[i]);
  }
  for (int32_t i = 0; i < z.nu && status == ALI3_OK; i++) status = ali3_set_input(kernel, i, input[i]);
  return status;
}
