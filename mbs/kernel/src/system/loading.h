/* Steps of loading a System: checks of its content, the derived block. Functions with a status return ALI3_OK,
 * ALI3_NO_MEMORY, or ALI3_BAD_FILE after writing what is wrong to the message. A check of one part uses indices that
 * earlier checks of ali3_system_check have found valid. */
#ifndef ALI3_LOADING_H
#define ALI3_LOADING_H
#include "../system.h"
#include "message.h"

/* Checks all parts and sets s->size. */
ali3_status ali3_system_check(ali3_system *s, ali3_message m);
/* Lengths and values of all arrays. */
ali3_status ali3_check_arrays(const ali3_system *s, ali3_message m);
/* Fronts, their tree and their storage; sets front_size and max_front. */
ali3_status ali3_check_fronts(ali3_system *s, ali3_message m);
/* Rows, their terms and their places in the fronts. */
ali3_status ali3_check_rows(const ali3_system *s, ali3_message m);
/* Elements: types, sizes and places in the fronts. */
ali3_status ali3_check_elements(const ali3_system *s, ali3_message m);
/* Sensors: integers by sensor_types.h. */
ali3_status ali3_check_sensors(const ali3_system *s, ali3_message m);
/* Lengths of the arrays of lookup-table bodies and numbers; sets n_lookup and n_dependent. */
ali3_status ali3_check_lookup_sizes(ali3_system *s, ali3_message m);
/* Refuses a signal of dependent coordinates for a purpose, `what`, that reads coordinates directly. */
ali3_status ali3_check_independent(const ali3_system *s, int32_t signal, const char *what, ali3_message m);
/* Flexible bodies. */
ali3_status ali3_check_flexible(ali3_system *s, ali3_message m);
/* Tree of relative coordinates. */
ali3_status ali3_check_tree(const ali3_system *s, ali3_message m);
/* Assembly modes of closed loops. */
ali3_status ali3_check_modes(const ali3_system *s, ali3_message m);
/* Coordinates and pose of the start. */
ali3_status ali3_check_start(const ali3_system *s, ali3_message m);
/* Payloads; requires checked signals and mass matrix. */
ali3_status ali3_check_payloads(const ali3_system *s, ali3_message m);
/* Armatures. */
ali3_status ali3_check_armatures(const ali3_system *s, ali3_message m);
/* Bodies with inertia set by parameters. */
ali3_status ali3_check_inertias(const ali3_system *s, ali3_message m);
/* Whether ten numbers (mass, first moments, xx, yy, zz, xy, xz, yz) are those of a body: no principal moment exceeds
 * the sum of the two others. */
bool ali3_inertia_possible(const double *real);
/* Whether the mass matrix has an entry for every coordinate of one signal with one of another. */
bool ali3_mass_has_room(const ali3_system *s, int32_t one, int32_t other);
/* Checks the two angles of a wheel axis, rad; NULL: valid, otherwise a sentence. */
const char *ali3_check_axis(const double *real);
/* Wheel axes set by parameters; requires checked signals, tables and mass matrix. */
ali3_status ali3_check_axes(const ali3_system *s, ali3_message m);
/* Creates s->turned, and drops the entries of s that are zero as drawn; before s is derived. */
ali3_status ali3_system_turn(ali3_system *s, ali3_message m);
/* Coordinates with ports. */
ali3_status ali3_check_ported(const ali3_system *s, ali3_message m);
/* NULL, or what is wrong with the numbers that parameters write, in the order of ALI3_TARGET_*; a sentence. */
const char *ali3_check_data(const ali3_system *s, const double *const data[ALI3_TARGET_COUNT]);
/* The same for the data that target k of a parameter writes. */
const char *ali3_check_target(const ali3_system *s, int64_t k, const double *const data[ALI3_TARGET_COUNT]);
/* Derives all arrays of s that are not in the file, in one block. */
ali3_status ali3_system_derive(ali3_system *s, ali3_message m);
/* Whether rows i to i + 2 of a sparse matrix, all of one length, have the same values. */
bool ali3_same_values(const int32_t *ptr, const double *val, int32_t i);
/* Whether a mass matrix with values val (nnz_mass) has equal rows for the three coordinates of each point. */
bool ali3_mass_isotropic(const ali3_system *s, const double *val);
/* Writes such a mass matrix in front storage, the floor (nq) of its diagonal, M_ii or a typical mass for massless
 * coordinates, its inverse, and that typical mass where it stands for none, otherwise 0. */
void ali3_mass_in_fronts(const ali3_system *s, const double *val, double *front, double *floor, double *floor_inverse,
                         double *missing);
#endif
