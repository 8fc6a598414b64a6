/* Steps of loading a System: checks of its content, the derived block. */
#ifndef ALI3_LOADING_H
#define ALI3_LOADING_H
#include "../system.h"
#include "message.h"

ali3_status ali3_system_check(ali3_system *s, ali3_message m);
ali3_status ali3_check_fronts(ali3_system *s, ali3_message m);
ali3_status ali3_check_rows(const ali3_system *s, ali3_message m);
ali3_status ali3_check_elements(const ali3_system *s, ali3_message m);
ali3_status ali3_check_sensors(const ali3_system *s, ali3_message m);
ali3_status ali3_check_flexible(ali3_system *s, ali3_message m);
ali3_status ali3_check_tree(const ali3_system *s, ali3_message m);
ali3_status ali3_check_modes(const ali3_system *s, ali3_message m);
ali3_status ali3_check_start(const ali3_system *s, ali3_message m);
const char *ali3_check_data(const ali3_system *s, const double *el_real, const double *guide_real,
                            const double *road_real);
const char *ali3_check_target(const ali3_system *s, int64_t k, const double *el_real, const double *guide_real,
                              const double *road_real);
ali3_status ali3_system_derive(ali3_system *s, ali3_message m);
int32_t ali3_find(const int32_t *sorted, int32_t n, int32_t value); /* position or -1 */
#endif
