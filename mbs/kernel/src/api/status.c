/* Text, remedy and cause of each status, from the list ALI3_STATUSES. */
#include "../../include/ali3.h"

static const struct {
  ali3_cause cause;
  const char *text, *remedy;
} statuses[ALI3_STATUS_COUNT] = {
#define ALI3_STATUS(NAME, cause, text, remedy) {ALI3_CAUSE_##cause, text, remedy},
    ALI3_STATUSES(ALI3_STATUS)
#undef ALI3_STATUS
};

static int is_status(ali3_status s) { return (unsigned)s < ALI3_STATUS_COUNT; }

const char *ali3_status_text(ali3_status s) { return is_status(s) ? statuses[s].text : "unknown status"; }

const char *ali3_status_remedy(ali3_status s) { return is_status(s) ? statuses[s].remedy : ""; }

ali3_cause ali3_status_cause(ali3_status s) { return is_status(s) ? statuses[s].cause : ALI3_CAUSE_CALL; }
