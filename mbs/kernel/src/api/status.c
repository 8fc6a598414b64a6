/* What a status says. */
#include "../../include/ali3.h"

static const struct {
  ali3_cause cause;
  const char *words, *remedy;
} statuses[ALI3_STATUS_COUNT] = {
#define ALI3_STATUS(NAME, cause, words, remedy) {ALI3_CAUSE_##cause, words, remedy},
    ALI3_STATUSES(ALI3_STATUS)
#undef ALI3_STATUS
};

static int known(ali3_status s) { return (unsigned)s < ALI3_STATUS_COUNT; }

const char *ali3_status_text(ali3_status s) { return known(s) ? statuses[s].words : "unknown status"; }

const char *ali3_status_remedy(ali3_status s) { return known(s) ? statuses[s].remedy : ""; }

ali3_cause ali3_status_cause(ali3_status s) { return known(s) ? statuses[s].cause : ALI3_CAUSE_CALL; }
