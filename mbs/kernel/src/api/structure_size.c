/* Sizes of the structures of ali3.h, for callers that declare them in another language. */
#include <string.h>

#include "../../include/ali3.h"

#define ALI3_SIZE(structure) {.name = #structure, .size = sizeof(structure)}
static const struct {
  const char *name;
  size_t size;
} structures[] = {
    ALI3_SIZE(ali3_settings), ALI3_SIZE(ali3_report), ALI3_SIZE(ali3_sizes),       ALI3_SIZE(ali3_control),
    ALI3_SIZE(ali3_record),   ALI3_SIZE(ali3_memory), ALI3_SIZE(ali3_input_table), ALI3_SIZE(ali3_input_tables),
    ALI3_SIZE(ali3_lane),     ALI3_SIZE(ali3_judged), ALI3_SIZE(ali3_compared),
};
#undef ALI3_SIZE

size_t ali3_structure_size(const char *name) {
  for (size_t i = 0; name != NULL && i < sizeof structures / sizeof structures[0]; i++)
    if (strcmp(structures[i].name, name) == 0) return structures[i].size;
  return 0;
}
