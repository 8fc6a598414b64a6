/* Checks the content of a System: mass, signals, inputs, driving functions, roads, parameters. Indices are used only
 * after their check. */
#include <math.h>

#include "../elements/element.h"
#include "../elements/road.h"
#include "../rows/driving_functions.h"
#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"

enum { MAX_COORDINATES = 1 << 20, MAX_OUTPUTS = 1 << 20 };

/* Derives the sizes of the System from the lengths of its arrays. */
static ali3_status check_sizes(ali3_system *s, ali3_message m) {
  ali3_sizes *z = &s->size;
  if (s->n_q0 < 1 || s->n_q0 > MAX_COORDINATES) return ali3_bad(m, "%lld coordinates", (long long)s->n_q0);
  if (s->n_front_parent < 1) return ali3_bad(m, "there are no fronts");
  z->nq = (int32_t)s->n_q0;
  z->nc = (int32_t)s->n_row_const;
  z->nu = (int32_t)s->n_input_start;
  z->ng = (int32_t)s->n_guide_type;
  z->ne = (int32_t)s->n_el_type;
  z->ny = (int32_t)s->n_y0;
  z->ns = (int32_t)s->n_sen_type;
  z->np = (int32_t)s->n_par_value;
  z->nf = (int32_t)s->n_front_parent;
  z->nnz_mass = (int32_t)s->n_mass_col;
  z->nnz_rows = (int32_t)s->n_row_col;
  z->nsig = (int32_t)s->n_sig_const;
  z->has_pose = s->n_pose_0 > 0;
  z->n_switch = (int32_t)s->n_switch_start;
  s->nr = (int32_t)s->n_road_type;
  return ALI3_OK;
}

/* Columns ascend; the matrix is symmetric with a diagonal that is not negative. */
static ali3_status check_mass(const ali3_system *s, ali3_message m) {
  const int32_t nq = s->size.nq;
  for (int32_t i = 0; i < nq; i++)
    for (int32_t k = s->mass_ptr[i]; k < s->mass_ptr[i + 1]; k++) {
      const int32_t j = s->mass_col[k];
      if (k > s->mass_ptr[i] && j <= s->mass_col[k - 1])
        return ali3_bad(m, "columns of mass row %d do not ascend", (int)i);
      if (i == j && s->mass_val[k] < 0.0) return ali3_bad(m, "the mass of coordinate %d is %g", (int)i, s->mass_val[k]);
      if (j >= i) continue;
      const int32_t other = ali3_find(s->mass_col + s->mass_ptr[j], s->mass_ptr[j + 1] - s->mass_ptr[j], i);
      const double a = s->mass_val[k], b = other < 0 ? 0.0 : s->mass_val[s->mass_ptr[j] + other];
      if (other < 0 || fabs(a - b) > 1e-9 * (fabs(a) + fabs(b)))
        return ali3_bad(m, "the mass matrix is not symmetric at (%d, %d)", (int)i, (int)j);
    }
  return ALI3_OK;
}

/* Columns of signals are coordinates or dependents; inputs start within their ranges. */
static ali3_status check_signals(const ali3_system *s, ali3_message m) {
  CHECK(ali3_check_indices(m, "sig_col", s->sig_col, s->n_sig_col, 0, s->size.nq + s->n_dependent));
  for (int64_t i = 0; i < s->size.nu; i++)
    if (!(s->input_min[i] <= s->input_start[i] && s->input_start[i] <= s->input_max[i]))
      return ali3_bad(m, "input %lld starts at %g, outside its range", (long long)i, s->input_start[i]);
  return ALI3_OK;
}

/* Inputs and tabulated driving functions that driving functions refer to. */
static ali3_status check_driving_functions_and_roads(const ali3_system *s, ali3_message m) {
  const int32_t ng = s->size.ng;
  for (int32_t g = 0; g < ng; g++) {
    if (s->guide_type[g] == ALI3_DRIVING_BY_TABLE) {
      CHECK(ali3_check_indices(m, "guide_input", s->guide_input + g, 1, 0, g));
      if (s->guide_type[s->guide_input[g]] == ALI3_DRIVING_BY_TABLE)
        return ali3_bad(m, "driving function %d is by a table over a driving function that is by a table too", (int)g);
    }
    if (!ali3_driving_filters(s->guide_type[g])) continue;
    CHECK(ali3_check_indices(m, "guide_input", s->guide_input + g, 1, 0, s->size.nu));
    if (s->guide_type[g] != ALI3_DRIVING_OF_TWO_INPUTS) continue;
    if (s->n_guide_second == 0)
      return ali3_bad(m, "driving function %d has two inputs and guide_second is missing", (int)g);
    CHECK(ali3_check_indices(m, "guide_second", s->guide_second + g, 1, 0, s->size.nu));
  }
  return ALI3_OK;
}

/* Parameters of masses and switches are fixed during a run: a changed mass would violate the balance of momentum,
 * switched rows would cause an impact. */
static ali3_status check_fixed_parameters(const ali3_system *s, ali3_message m) {
  for (int32_t p = 0; p < s->size.np; p++)
    for (int32_t k = s->par_ptr[p]; k < s->par_ptr[p + 1]; k++)
      if (s->par_target[k] >= ALI3_TARGET_PAYLOAD && s->par_target[k] != ALI3_TARGET_SENSOR &&
          (s->n_par_fixed == 0 || !s->par_fixed[p]))
        return ali3_bad(m, "parameter %d writes %s and is not fixed", (int)p,
                        s->par_target[k] == ALI3_TARGET_PAYLOAD   ? "the mass of a payload"
                        : s->par_target[k] == ALI3_TARGET_SWITCH  ? "a switch"
                        : s->par_target[k] == ALI3_TARGET_INERTIA ? "the inertia of a body"
                        : s->par_target[k] == ALI3_TARGET_AXIS    ? "the axis of a wheel"
                                                                  : "the ratio of an armature");
  return ALI3_OK;
}

/* Indices that parameters write to; values within their ranges. */
static ali3_status check_parameters(const ali3_system *s, ali3_message m) {
  const int32_t np = s->size.np;
  const int64_t length[ALI3_TARGET_COUNT] = {
      [ALI3_TARGET_ELEMENT] = s->n_el_parameter,      [ALI3_TARGET_DRIVING] = s->n_guide_parameter,
      [ALI3_TARGET_ROAD] = s->n_road_parameter,       [ALI3_TARGET_PAYLOAD] = s->n_payload_mass,
      [ALI3_TARGET_SWITCH] = s->n_switch_start,       [ALI3_TARGET_ARMATURE] = s->n_armature_ratio,
      [ALI3_TARGET_INERTIA] = s->n_inertia_parameter, [ALI3_TARGET_SENSOR] = s->n_sen_parameter,
      [ALI3_TARGET_AXIS] = s->n_axis_parameter};
  for (int64_t k = 0; k < s->n_par_target; k++)
    CHECK(ali3_check_indices(m, "par_index", s->par_index + k, 1, 0, length[s->par_target[k]]));
  for (int32_t p = 0; s->n_par_inverse != 0 && p < np; p++)
    for (int32_t k = s->par_ptr[p]; k < s->par_ptr[p + 1]; k++)
      if (s->par_inverse[k] && !(s->par_min[p] > 0.0))
        return ali3_bad(m, "parameter %d writes its inverse and may be %g; it must be above 0", (int)p, s->par_min[p]);
  for (int32_t p = 0; p < np; p++)
    if (!(s->par_min[p] <= s->par_value[p] && s->par_value[p] <= s->par_max[p]))
      return ali3_bad(m, "parameter %d is %g, outside its range", (int)p, s->par_value[p]);
  return check_fixed_parameters(s, m);
}

/* NULL, or what is wrong with the data of element e; el_parameter: numbers of all elements. */
static const char *check_element(const ali3_system *s, int32_t e, const double *el_parameter) {
  const ali3_element_type *type = ali3_element_type_get(s->el_type[e]);
  const int32_t real = s->el_parameter_ptr[e], integer = s->el_int_ptr[e];
  return ali3_element_check(type, s->el_sig_ptr[e + 1] - s->el_sig_ptr[e], el_parameter + real,
                            s->el_parameter_ptr[e + 1] - real, s->el_int + integer, s->el_int_ptr[e + 1] - integer,
                            s->size.nu, s->nr);
}

/* NULL, or what is wrong with the numbers of driving function g. */
static const char *check_driving_function(const ali3_system *s, int32_t g, const double *guide_parameter) {
  const int32_t real = s->guide_parameter_ptr[g];
  return ali3_driving_check(s->guide_type[g], guide_parameter + real, s->guide_parameter_ptr[g + 1] - real);
}

/* NULL, or what is wrong with the numbers of road k. */
static const char *check_road(const ali3_system *s, int32_t k, const double *road_parameter) {
  const int32_t real = s->road_parameter_ptr[k];
  const int32_t n = s->road_parameter_ptr[k + 1] - real;
  const char *text = ali3_road_check(s->road_type[k], road_parameter + real, n);
  for (int32_t i = 1; text == NULL && s->road_type[k] == ALI3_ROAD_PORT && i < n; i++) {
    const double first = road_parameter[real + i];
    if (!(first >= 0.0 && first <= s->size.nu - ALI3_ROAD_INPUTS && first == floor(first)))
      text = "a road at a port names inputs that do not exist";
  }
  return text;
}

static const char *check_payload(double mass) {
  return mass >= 0.0 && mass - mass == 0.0 ? NULL : "the mass of a payload must be a number and not negative";
}

static const char *check_ratio(double ratio) {
  return ratio > 0.0 && ratio - ratio == 0.0 ? NULL : "the ratio of an armature must be a number above 0";
}

/* Whether no principal moment exceeds the sum of the two others: tr(I) / 2 - I has no negative eigenvalue. */
bool ali3_inertia_possible(const double *real) {
  const double half = 0.5 * (real[4] + real[5] + real[6]);
  const double x = half - real[4], y = half - real[5], z = half - real[6], xy = real[7], xz = real[8], yz = real[9];
  const double tolerance = -1e-9 * half;
  const double det = x * (y * z - yz * yz) - xy * (xy * z + yz * xz) - xz * (xy * yz + y * xz);
  return half > 0.0 && x >= tolerance && y >= tolerance && z >= tolerance && x * y - xy * xy >= tolerance * half &&
         x * z - xz * xz >= tolerance * half && y * z - yz * yz >= tolerance * half && det >= tolerance * half * half;
}

/* Checks the numbers of an inertia separately, as they are set one after the other; together they are checked at a
 * start. */
static const char *check_inertia(const double *real) {
  for (int i = 0; i < ALI3_INERTIA_REALS; i++)
    if (!(real[i] - real[i] == 0.0)) return "the inertia of a body must be numbers";
  return real[0] > 0.0 ? NULL : "the mass of a body must be above 0";
}

static const char *check_switch(double on) {
  return on == 0.0 || on == 1.0 ? NULL : "a parameter writes to a switch what is neither 0 nor 1";
}

const char *ali3_check_data(const ali3_system *s, const double *const data[ALI3_TARGET_COUNT]) {
  const char *text = NULL;
  for (int32_t e = 0; text == NULL && e < s->size.ne; e++) text = check_element(s, e, data[ALI3_TARGET_ELEMENT]);
  for (int32_t g = 0; text == NULL && g < s->size.ng; g++)
    text = check_driving_function(s, g, data[ALI3_TARGET_DRIVING]);
  for (int32_t k = 0; text == NULL && k < s->nr; k++) text = check_road(s, k, data[ALI3_TARGET_ROAD]);
  for (int64_t k = 0; text == NULL && k < s->n_payload_mass; k++) text = check_payload(data[ALI3_TARGET_PAYLOAD][k]);
  for (int64_t k = 0; text == NULL && k < s->n_armature_ratio; k++) text = check_ratio(data[ALI3_TARGET_ARMATURE][k]);
  for (int64_t k = 0; text == NULL && k < s->n_inertia_parameter; k += ALI3_INERTIA_REALS)
    text = check_inertia(data[ALI3_TARGET_INERTIA] + k);
  for (int64_t k = 0; text == NULL && k < s->n_axis_parameter; k += ALI3_AXIS_REALS)
    text = ali3_check_axis(data[ALI3_TARGET_AXIS] + k);
  const double *on = data[ALI3_TARGET_SWITCH]; /* NULL: of a file, whose values are checked with its arrays */
  for (int32_t k = 0; text == NULL && on != NULL && k < s->size.n_switch; k++) text = check_switch(on[k]);
  return text;
}

/* Owner i of data item `index`: ptr[i] <= index < ptr[i + 1]. */
static int32_t find_owner(const int32_t *ptr, int32_t n, int32_t index) {
  int32_t low = 0, high = n - 1;
  while (low < high) {
    const int32_t middle = low + (high - low + 1) / 2;
    if (ptr[middle] <= index)
      low = middle;
    else
      high = middle - 1;
  }
  return low;
}

const char *ali3_check_target(const ali3_system *s, int64_t k, const double *const data[ALI3_TARGET_COUNT]) {
  const int32_t index = s->par_index[k], family = s->par_target[k];
  if (family == ALI3_TARGET_ELEMENT)
    return check_element(s, find_owner(s->el_parameter_ptr, s->size.ne, index), data[family]);
  if (family == ALI3_TARGET_DRIVING)
    return check_driving_function(s, find_owner(s->guide_parameter_ptr, s->size.ng, index), data[family]);
  if (family == ALI3_TARGET_ROAD) return check_road(s, find_owner(s->road_parameter_ptr, s->nr, index), data[family]);
  if (family == ALI3_TARGET_PAYLOAD) return check_payload(data[family][index]);
  if (family == ALI3_TARGET_SENSOR) return NULL;
  if (family == ALI3_TARGET_INERTIA)
    return check_inertia(data[family] + index / ALI3_INERTIA_REALS * ALI3_INERTIA_REALS);
  if (family == ALI3_TARGET_AXIS) return ali3_check_axis(data[family] + index / ALI3_AXIS_REALS * ALI3_AXIS_REALS);
  return family == ALI3_TARGET_SWITCH ? check_switch(data[family][index]) : check_ratio(data[family][index]);
}

ali3_status ali3_system_check(ali3_system *s, ali3_message m) {
  CHECK(check_sizes(s, m));
  CHECK(ali3_check_arrays(s, m));
  CHECK(check_mass(s, m));
  CHECK(ali3_check_lookup_sizes(s, m));
  CHECK(check_signals(s, m));
  CHECK(ali3_check_payloads(s, m));
  CHECK(ali3_check_armatures(s, m));
  CHECK(ali3_check_inertias(s, m));
  CHECK(ali3_check_axes(s, m));
  CHECK(check_driving_functions_and_roads(s, m));
  CHECK(check_parameters(s, m));
  CHECK(ali3_check_fronts(s, m));
  CHECK(ali3_check_rows(s, m));
  CHECK(ali3_check_flexible(s, m));
  CHECK(ali3_check_elements(s, m));
  s->size.nout = s->size.ne > 0 ? s->el_out_ptr[s->size.ne] : 0;
  if (s->size.nout > MAX_OUTPUTS) return ali3_bad(m, "%d element outputs", (int)s->size.nout);
  CHECK(ali3_check_sensors(s, m));
  CHECK(ali3_check_tree(s, m));
  CHECK(ali3_check_modes(s, m));
  CHECK(ali3_check_start(s, m));
  CHECK(ali3_check_ported(s, m));
  const double *const data[ALI3_TARGET_COUNT] = {
      [ALI3_TARGET_ELEMENT] = s->el_parameter,    [ALI3_TARGET_DRIVING] = s->guide_parameter,
      [ALI3_TARGET_ROAD] = s->road_parameter,     [ALI3_TARGET_PAYLOAD] = s->payload_mass,
      [ALI3_TARGET_ARMATURE] = s->armature_ratio, [ALI3_TARGET_INERTIA] = s->inertia_parameter,
      [ALI3_TARGET_AXIS] = s->axis_parameter};
  const char *text = ali3_check_data(s, data);
  return text == NULL ? ALI3_OK : ali3_bad(m, "%s", text);
}
