/* Steps of loading a System: checks of its content, the derived block. */
#ifndef ALI3_LOADING_H
#define ALI3_LOADING_H
#include "../system.h"
#include "message.h"

ali3_status ali3_system_check(ali3_system *s, ali3_message m);
ali3_status ali3_check_arrays(const ali3_system *s, ali3_message m);
ali3_status ali3_check_fronts(ali3_system *s, ali3_message m);
ali3_status ali3_check_rows(const ali3_system *s, ali3_message m);
ali3_status ali3_check_elements(const ali3_system *s, ali3_message m);
ali3_status ali3_check_sensors(const ali3_system *s, ali3_message m);
ali3_status ali3_check_tabled_sizes(ali3_system *s, ali3_message m);
ali3_status ali3_check_independent(const ali3_system *s, int32_t signal, const char *what, ali3_message m);
ali3_status ali3_check_flexible(ali3_system *s, ali3_message m);
ali3_status ali3_check_tree(const ali3_system *s, ali3_message m);
ali3_status ali3_check_modes(const ali3_system *s, ali3_message m);
ali3_status ali3_check_start(const ali3_system *s, ali3_message m);
ali3_status ali3_check_payloads(const ali3_system *s, ali3_message m);
ali3_status ali3_check_armatures(const ali3_system *s, ali3_message m);
ali3_status ali3_check_inertias(const ali3_system *s, ali3_message m);
bool ali3_inertia_possible(const double *real);
bool ali3_mass_has_room(const ali3_system *s, int32_t one, int32_t other);
const char *ali3_check_axis(const double *real);
ali3_status ali3_check_axes(const ali3_system *s, ali3_message m);
ali3_status ali3_system_turn(ali3_system *s, ali3_message m);
ali3_status ali3_check_ported(const ali3_system *s, ali3_message m);
/* Checks data in the order of ALI3_TARGET_*: all of them, or those that target k of a parameter writes. NULL: valid. */
const char *ali3_check_data(const ali3_system *s, const double *const data[ALI3_TARGET_COUNT]);
const char *ali3_check_target(const ali3_system *s, int64_t k, const double *const data[ALI3_TARGET_COUNT]);
ali3_status ali3_system_derive(ali3_system *s, ali3_message m);
/* A mass matrix in front storage, its diagonal, and the floor of massless coordinates; also for the masses of an
 * instance. */
bool ali3_same_values(const int32_t *ptr, const double *val, int32_t i);
bool ali3_mass_isotropic(const ali3_system *s, const double *val);
void ali3_mass_in_fronts(const ali3_system *s, const double *val, double *front, double *floor, double *floor_inverse,
                         double *missing);
#endif
