/* Road files of an instance, replacing roads of the System. */
#ifndef ALI3_ROAD_FILES_H
#define ALI3_ROAD_FILES_H
#include "../instance.h"

/* ALI3_ROAD_LOST if part of a file could not be read since ali3_roads_clear_read_errors. */
ali3_status ali3_roads_status(const ali3_instance *in);
/* Forgets read errors of all road files. */
void ali3_roads_clear_read_errors(ali3_instance *in);
/* Whether a road is a file or at a port, so that its height under the start is unknown when the System is made. */
bool ali3_roads_from_outside(const ali3_instance *in);
/* ALI3_BAD_NORMAL if the inputs in use give a road at a port an invalid normal. */
ali3_status ali3_roads_normals(const ali3_instance *in);
/* Checksum of the System and of its road files. */
uint32_t ali3_model_crc(const ali3_instance *in);
/* Closes the road files. */
void ali3_roads_close(ali3_instance *in);
#endif
