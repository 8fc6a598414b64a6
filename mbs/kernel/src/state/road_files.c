/* Road files of an instance: set before a start, read while the scene moves. */
#include "road_files.h"

#include <stdio.h>
#include <string.h>

#include "../elements/road_port.h"
#include "../files/crc32.h"
#include "../roads/road_file.h"

ali3_status ali3_set_road(ali3_instance *in, int32_t road, const char *path, char *message, size_t message_size) {
  if (message != NULL && message_size > 0) message[0] = 0;
  if (in == NULL || road < 0 || road >= in->system->nr) return ALI3_BAD_ARGUMENT;
  ali3_road_file *file = NULL;
  if (path != NULL && path[0] != 0) {
    const ali3_memory *memory = &in->system->memory;
    file = ali3_road_file_open(path, memory->allocate, memory->release, message, message_size);
    if (file == NULL) return ALI3_BAD_ROAD;
  }
  ali3_road_file_close(in->roads.used[road].file);
  in->roads.used[road].file = file;
  in->start.initialised = 0;
  in->start.to_lift = in->start.placed != ALI3_PLACED_BY_Q;
  return ALI3_OK;
}

ali3_status ali3_roads_status(const ali3_instance *in) { return ali3_road_lost(in)[0] != 0 ? ALI3_ROAD_LOST : ALI3_OK; }

void ali3_roads_clear_read_errors(ali3_instance *in) {
  for (int32_t r = 0; r < in->system->nr; r++)
    if (in->roads.used[r].file != NULL) ali3_road_file_clear_read_error(in->roads.used[r].file);
}

bool ali3_roads_from_outside(const ali3_instance *in) {
  for (int32_t r = 0; r < in->system->nr; r++)
    if (in->roads.used[r].file != NULL || in->roads.used[r].type == ALI3_ROAD_PORT) return true;
  return false;
}

ali3_status ali3_roads_normals(const ali3_instance *in) {
  for (int32_t r = 0; r < in->system->nr; r++)
    if (!ali3_port_normals(&in->roads.used[r])) return ALI3_BAD_NORMAL;
  return ALI3_OK;
}

const char *ali3_road_lost(const ali3_instance *in) {
  for (int32_t r = 0; in != NULL && r < in->system->nr; r++)
    if (in->roads.used[r].file != NULL && ali3_road_file_read_error(in->roads.used[r].file) != NULL)
      return ali3_road_file_read_error(in->roads.used[r].file);
  return "";
}

uint32_t ali3_model_crc(const ali3_instance *in) {
  uint32_t crc = in->system->crc;
  for (int32_t r = 0; r < in->system->nr; r++)
    if (in->roads.used[r].file != NULL) {
      const uint32_t parts[3] = {crc, (uint32_t)r, ali3_road_file_identity(in->roads.used[r].file)};
      crc = ali3_crc32(parts, sizeof parts);
    }
  return crc;
}

void ali3_roads_close(ali3_instance *in) {
  for (int32_t r = 0; r < in->roads.n; r++) ali3_road_file_close(in->roads.used[r].file);
}
