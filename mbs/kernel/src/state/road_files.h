/* Files in place of the roads of a System. */
#ifndef ALI3_ROAD_FILES_H
#define ALI3_ROAD_FILES_H
#include "../instance.h"

/* ALI3_ROAD_LOST where a part of a file could not be read since ali3_roads_forgive. */
ali3_status ali3_roads_status(const ali3_instance *in);
void ali3_roads_forgive(ali3_instance *in);
bool ali3_roads_from_files(const ali3_instance *in);
/* Checksum of the System and of what its roads are. */
uint32_t ali3_model_crc(const ali3_instance *in);
void ali3_roads_close(ali3_instance *in);
#endif
