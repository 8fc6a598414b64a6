/* Table of the methods. */
#include "../method.h"

static const ali3_method *const methods[ALI3_METHOD_COUNT] = {
#define ALI3_METHOD_ENTRY(NAME, name, order) [ALI3_METHOD_##NAME] = &ali3_method_##name,
    ALI3_METHODS(ALI3_METHOD_ENTRY)
#undef ALI3_METHOD_ENTRY
};

static const int32_t orders[ALI3_METHOD_COUNT] = {
#define ALI3_METHOD_ENTRY(NAME, name, order) [ALI3_METHOD_##NAME] = order,
    ALI3_METHODS(ALI3_METHOD_ENTRY)
#undef ALI3_METHOD_ENTRY
};

const ali3_method *ali3_method_of(const ali3_instance *in) { return methods[in->settings.method]; }

const char *ali3_method_excludes(const ali3_instance *in) {
  return in == NULL || ali3_method_of(in)->excludes == NULL ? "" : ali3_method_of(in)->excludes;
}

ali3_status ali3_check_method(const ali3_instance *in) {
  const ali3_method *method = ali3_method_of(in);
  return method->check_system != NULL ? method->check_system(in) : ALI3_OK;
}

bool ali3_has_balance(const ali3_instance *in) {
  const ali3_method *method = ali3_method_of(in);
  return method->has_balance != NULL && method->has_balance(in);
}

int32_t ali3_method_order(const ali3_instance *in) { return orders[in->settings.method]; }
