/* Settings of an instance. */
#include "../instance.h"
#include "../method.h"
#include "../methods/energy_balance.h"
#include "../state/parameters.h"
#include "../state/work.h"

void ali3_count_work(ali3_instance *in, int64_t *left) {
  if (in != NULL) in->bound.work_left = left;
}

ali3_status ali3_set_settings(ali3_instance *in, const ali3_settings *settings) {
  if (in == NULL || settings == NULL || !ali3_settings_valid(settings)) return ALI3_BAD_ARGUMENT;
  const bool changed = settings->method != in->settings.method;
  in->settings = *settings;
  if (in->start.initialised) ali3_balance_start(in, ali3_has_balance(in)); /* the last method may have had none */
  if (in->start.initialised && changed) ali3_work_reopen(in);
  return ALI3_OK;
}

ali3_status ali3_get_settings(const ali3_instance *in, ali3_settings *settings) {
  if (in == NULL || settings == NULL) return ALI3_BAD_ARGUMENT;
  *settings = in->settings;
  return ALI3_OK;
}
