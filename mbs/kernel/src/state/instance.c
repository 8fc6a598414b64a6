/* Instances: memory, settings, inputs, parameters, the state to start from. */
#include <math.h>
#include <string.h>

#include "../algebra/elementary.h"
#include "../algebra/finite.h"
#include "../elements/road.h"
#include "../instance.h"
#include "../rows/assembly_mode.h"
#include "../rows/guides.h"
#include "../system/loading.h"
#include "../system/without_memory.h"
#include "../tree/tree.h"
#include "books.h"
#include "parameters.h"
#include "vectors.h"
#include "work.h"

const char *ali3_status_text(ali3_status s) {
  static const char *const text[ALI3_STATUS_COUNT] = {
      "ok",
      "an argument is missing, not finite or out of range",
      "the bytes are not a valid System file",
      "the bytes are not a state of this System",
      "there is not enough memory",
      "the instance must be initialised first",
      "the position problem does not close",
      "the iteration did not converge, also not in smaller steps",
      "the tangent is singular",
      "the motion or a force became infinite",
      "this method takes no element states or filtered guides (energy_momentum_4: no damping; radau_5: no rolling)",
      "a tyre starts deeper in the road than its radius",
      "the motion is too fast for the step: energy came or went without a force, also in smaller steps",
      "this method needs a System of rigid bodies that revolute and prismatic joints tie to the ground",
      "the step is too long for an explicit method, which must follow the fastest motion",
      "the start is too far away or too fast: positions must stay within 1e8 m, speeds within 1e6 m/s",
      "with these parameters there is no static equilibrium near the drawing to start from",
      "a closed loop changed its assembly mode",
  };
  return (unsigned)s < ALI3_STATUS_COUNT ? text[s] : "unknown status";
}

uint32_t ali3_version(void) { return ALI3_SYSTEM_VERSION; }

static size_t signal_work(const ali3_system *s) {
  size_t largest = 0;
  for (int32_t e = 0; e < s->size.ne; e++) {
    const size_t n = (size_t)(s->el_sig_ptr[e + 1] - s->el_sig_ptr[e]);
    const size_t m = (size_t)(s->el_coordinate_ptr[e + 1] - s->el_coordinate_ptr[e]);
    if (n * m > largest) largest = n * m;
  }
  return largest;
}

ali3_status ali3_instance_new(const ali3_system *s, ali3_instance **out) {
  if (s == NULL || out == NULL) return ALI3_BAD_ARGUMENT;
  const ali3_sizes *z = &s->size;
  const size_t nq = (size_t)z->nq, nc = (size_t)z->nc, ny = (size_t)z->ny, nout = (size_t)z->nout, ne = (size_t)z->ne;
  const size_t n_vector = ali3_vector_count(s);
  const size_t n_S = (size_t)s->el_S_off[z->ne], n_work = signal_work(s), nu = (size_t)z->nu, np = (size_t)z->np;
  const size_t data = (size_t)s->n_el_real + (size_t)s->n_guide_real + (size_t)s->n_road_real;
  const size_t stages = ali3_without_memory(s) ? ALI3_RADAU : 0;
  const size_t total = 8 * n_vector + (4 + ALI3_RADAU) * nu + 2 * np + data + (11 + ALI3_STAGES) * nq + 7 * nc +
                       5 * (size_t)z->nnz_rows + (size_t)z->front_size + 2 * nq + (size_t)z->ng + (size_t)z->n_switch +
                       2 * (size_t)z->nsig + n_S + n_work + ALI3_RADAU * (size_t)s->max_front + ny + nout + ne +
                       stages * (2 * nc + 2 * (size_t)z->nnz_rows + nq + stages * (size_t)z->front_size) +
                       (stages > 0 ? 2 * (size_t)z->front_size : 0);
  const size_t triads = (size_t)ali3_triad_count(s), loops = (size_t)ali3_loop_count(s);
  const size_t n_modes = 5 * triads + loops + (triads > 0 ? n_vector : 0), n_start = 4 * nq;
  const size_t n_sensed = (2 + ALI3_RADAU) * (size_t)s->n_work + (size_t)s->n_work_force;
  const size_t n_flex = 21 * (size_t)s->n_flexible + 9 * (size_t)s->n_flex_mode, n_flex_work = 3 * (size_t)s->max_modes;
  const size_t head = (sizeof(ali3_instance) + 15u) / 16u * 16u,
               roads = ((size_t)s->nr * sizeof(ali3_road) + 15u) / 16u * 16u,
               tree = s->tree != NULL ? (sizeof(ali3_tree_work) + 15u) / 16u * 16u : 0;
  *out = NULL;
  const size_t numbers = (total + n_flex + n_flex_work + n_modes + n_start + n_sensed) * sizeof(double);
  char *block = s->memory.allocate(1, head + roads + tree + numbers + ne);
  if (block == NULL) return ALI3_NO_MEMORY;
  ali3_instance *in = (ali3_instance *)block;
  double *pool = (double *)(block + head + roads + tree);
  in->system = s;
  in->release = s->memory.release;
  in->road = (ali3_road *)(block + head);
  in->idle = (unsigned char *)(block + head + roads + tree + numbers);
  if (s->tree != NULL) {
    in->tree = (ali3_tree_work *)(block + head + roads);
    ali3_tree_start(s, in->tree);
  }
  in->n_vector = n_vector;
  ali3_vectors_place(s, &in->now, &pool);
  ali3_vectors_place(s, &in->next, &pool);
  ali3_vectors_place(s, &in->start, &pool);
  ali3_vectors_place(s, &in->whole, &pool);
  ali3_vectors_place(s, &in->tangent, &pool);
  ali3_vectors_place(s, &in->origin, &pool);
  ali3_vectors_place(s, &in->centre, &pool);
  ali3_vectors_place(s, &in->coarse, &pool);
  in->input = ali3_take(&pool, nu);
  in->input_work = ali3_take(&pool, nu);
  in->input_middle = ali3_take(&pool, nu);
  in->input_begin = ali3_take(&pool, nu);
  in->stage_input = ali3_take(&pool, ALI3_RADAU * nu);
  in->force_input = in->input;
  in->parameter = ali3_take(&pool, np);
  in->parameter_work = ali3_take(&pool, np);
  in->el_real = ali3_take(&pool, (size_t)s->n_el_real);
  in->guide_real = ali3_take(&pool, (size_t)s->n_guide_real);
  in->road_real = ali3_take(&pool, (size_t)s->n_road_real);
  in->D = ali3_take(&pool, nq);
  in->d0 = ali3_take(&pool, nq);
  in->r = ali3_take(&pool, nq);
  in->x = ali3_take(&pool, nq);
  in->w = ali3_take(&pool, nq);
  in->shifted = ali3_take(&pool, nq);
  in->hat = ali3_take(&pool, nq);
  in->middle = ali3_take(&pool, nq);
  in->rate = ali3_take(&pool, nq);
  in->stage = ali3_take(&pool, ALI3_STAGES * nq);
  in->Q = ali3_take(&pool, nq);
  in->Phi = ali3_take(&pool, nc);
  in->Phit = ali3_take(&pool, nc);
  in->gamma = ali3_take(&pool, nc);
  in->mu = ali3_take(&pool, nc);
  in->lam = ali3_take(&pool, nc);
  in->correction_q = ali3_take(&pool, nq);
  in->step_q = ali3_take(&pool, nq);
  in->correction_lam = ali3_take(&pool, nc);
  in->step_lam = ali3_take(&pool, nc);
  in->J = ali3_take(&pool, (size_t)z->nnz_rows);
  in->J_tangent = ali3_take(&pool, (size_t)z->nnz_rows);
  in->J0 = ali3_take(&pool, (size_t)z->nnz_rows);
  in->at_J0 = ali3_take(&pool, nq + (size_t)z->ng + (size_t)z->n_switch);
  in->A = ali3_take(&pool, (size_t)z->nnz_rows);
  in->A_tangent = ali3_take(&pool, (size_t)z->nnz_rows);
  in->F = ali3_take(&pool, (size_t)z->front_size);
  in->u = ali3_take(&pool, (size_t)z->nsig);
  in->ud = ali3_take(&pool, (size_t)z->nsig);
  in->S = ali3_take(&pool, n_S);
  in->SB = ali3_take(&pool, n_work);
  in->local = ali3_take(&pool, ALI3_RADAU * (size_t)s->max_front);
  in->stage_Phi = ali3_take(&pool, stages * nc);
  in->stage_lam = ali3_take(&pool, stages * nc);
  in->stage_J = ali3_take(&pool, stages * (size_t)z->nnz_rows);
  in->stage_J_tangent = ali3_take(&pool, stages * (size_t)z->nnz_rows);
  in->stage_x = ali3_take(&pool, stages * nq);
  in->F_stages = ali3_take(&pool, stages * stages * (size_t)z->front_size);
  in->F_C = ali3_take(&pool, stages > 0 ? (size_t)z->front_size : 0);
  in->F_K = ali3_take(&pool, stages > 0 ? (size_t)z->front_size : 0);
  in->flex = ali3_take(&pool, n_flex);
  in->flex_work = ali3_take(&pool, n_flex_work);
  in->y_work = ali3_take(&pool, ny);
  in->out_work = ali3_take(&pool, nout);
  in->potential_work = ali3_take(&pool, ne);
  in->mode_sine = ali3_take(&pool, triads);
  in->mode_cosine = ali3_take(&pool, triads);
  in->sine_before = ali3_take(&pool, triads);
  in->sine_after = ali3_take(&pool, triads);
  in->sine_few = ali3_take(&pool, triads);
  in->mode_left = ali3_take(&pool, loops);
  if (triads > 0) ali3_vectors_place(s, &in->before, &pool);
  in->start_q = ali3_take(&pool, nq);
  in->pose_0 = ali3_take(&pool, nq);
  in->pose_cos = ali3_take(&pool, nq);
  in->pose_sin = ali3_take(&pool, nq);
  in->watched = ali3_take(&pool, (size_t)s->n_work + (size_t)s->n_work_force);
  in->work_sum = ali3_take(&pool, (size_t)s->n_work);
  in->stage_power = ali3_take(&pool, ALI3_RADAU * (size_t)s->n_work);
  const ali3_status status = ali3_reset(in);
  if (status != ALI3_OK) {
    s->memory.release(block);
    return status;
  }
  *out = in;
  return ALI3_OK;
}

void ali3_instance_free(ali3_instance *in) {
  if (in != NULL) in->release(in);
}

ali3_settings ali3_default_settings(void) {
  const ali3_settings settings = {
      0.0, 1e-7, 1e-10, 1e-11, 0.8, 30, 8, 1, ALI3_UPDATE_LINEARISED, 1, ALI3_METHOD_ALI3P, ALI3_PREDICTOR_PARABOLA};
  return settings;
}

bool ali3_settings_valid(const ali3_settings *s) {
  return s->alpha >= 0.0 && s->alpha < 1e300 && s->eps_rel > 0.0 && s->eps_rel < 1e300 && s->tolerance_r > 0.0 &&
         s->tolerance_r < 1e300 && s->tolerance_phi > 0.0 && s->tolerance_phi < 1e300 && s->max_iterations >= 1 &&
         s->max_iterations <= 1000 && s->max_halvings >= 0 && s->max_halvings <= 16 &&
         (s->project == 0 || s->project == 1) &&
         (s->update == ALI3_UPDATE_LINEARISED || s->update == ALI3_UPDATE_PAPER) &&
         (s->geometric == 0 || s->geometric == 1) && s->rho_infinity >= 0.0 && s->rho_infinity <= 1.0 &&
         s->method >= 0 && s->method < ALI3_METHOD_COUNT && s->predictor >= 0 && s->predictor < ALI3_PREDICTOR_COUNT;
}

ali3_status ali3_set_settings(ali3_instance *in, const ali3_settings *settings) {
  if (in == NULL || settings == NULL || !ali3_settings_valid(settings)) return ALI3_BAD_ARGUMENT;
  const bool other = settings->method != in->settings.method;
  in->settings = *settings;
  if (in->initialised) ali3_books_open(in); /* another method may have kept none */
  if (in->initialised && other) ali3_work_reopen(in);
  return ALI3_OK;
}

ali3_status ali3_get_settings(const ali3_instance *in, ali3_settings *settings) {
  if (in == NULL || settings == NULL) return ALI3_BAD_ARGUMENT;
  *settings = in->settings;
  return ALI3_OK;
}

/* The data of elements, guides and roads from the file and the parameters; refused as a whole when an element cannot
 * take it. */
ali3_status ali3_parameters_apply(ali3_instance *in) {
  const ali3_system *S = in->system;
  double *target[3] = {in->el_real, in->guide_real, in->road_real};
  for (int32_t p = 0; p < S->size.np; p++)
    for (int32_t k = S->par_ptr[p]; k < S->par_ptr[p + 1]; k++)
      target[S->par_target[k]][S->par_index[k]] = S->par_scale[k] * in->parameter[p];
  return ali3_check_data(S, in->el_real, in->guide_real, in->road_real) == NULL ? ALI3_OK : ALI3_BAD_ARGUMENT;
}

static void copy(double *to, const double *from, int64_t n) {
  if (n > 0) memcpy(to, from, (size_t)n * sizeof(double));
}

ali3_status ali3_reset(ali3_instance *in) {
  if (in == NULL) return ALI3_BAD_ARGUMENT;
  const ali3_system *S = in->system;
  const ali3_report none = {0};
  in->settings = ali3_default_settings();
  in->report = none;
  in->t_base = in->h_last = 0.0;
  in->count = 0;
  in->initialised = 0;
  in->input_function = NULL;
  in->mode_known = false;
  in->placed = ALI3_PLACED_BY_FILE;
  in->start_moved = false;
  ali3_start_of_file(in);
  memset(in->now.q, 0, in->n_vector * sizeof(double));
  copy(in->now.q, S->q0, S->size.nq);
  copy(in->now.qd, S->qd0, S->size.nq);
  copy(in->now.y, S->y0, S->size.ny);
  for (int32_t k = 0; k < S->size.n_switch; k++) in->now.on[k] = (double)S->switch_start[k];
  copy(in->input, S->input_start, S->size.nu);
  copy(in->now.used, S->input_start, S->size.nu);
  copy(in->parameter, S->par_value, S->size.np);
  copy(in->el_real, S->el_real, S->n_el_real);
  copy(in->guide_real, S->guide_real, S->n_guide_real);
  copy(in->road_real, S->road_real, S->n_road_real);
  for (int32_t g = 0; g < S->size.ng; g++)
    if (S->guide_type[g] == ALI3_GUIDE_OF_INPUT) in->now.s[g] = in->guide_real[S->guide_real_ptr[g] + 2];
  for (int32_t r = 0; r < S->nr; r++) {
    const ali3_road road = {S->road_type[r], S->road_real_ptr[r + 1] - S->road_real_ptr[r],
                            in->road_real + S->road_real_ptr[r]};
    in->road[r] = road;
  }
  return ali3_parameters_apply(in);
}

/* Clamped to the range of the input. */
ali3_status ali3_set_input(ali3_instance *in, int32_t index, double value) {
  if (in == NULL || index < 0 || index >= in->system->size.nu || !(value - value == 0.0)) return ALI3_BAD_ARGUMENT;
  in->input[index] = fmax(in->system->input_min[index], fmin(in->system->input_max[index], value));
  return ALI3_OK;
}

ali3_status ali3_get_input(const ali3_instance *in, int32_t index, double *value) {
  if (in == NULL || value == NULL || index < 0 || index >= in->system->size.nu) return ALI3_BAD_ARGUMENT;
  *value = in->input[index];
  return ALI3_OK;
}

ali3_status ali3_set_parameter(ali3_instance *in, int32_t index, double value) {
  if (in == NULL || index < 0 || index >= in->system->size.np) return ALI3_BAD_ARGUMENT;
  if (!(value - value == 0.0 && value >= in->system->par_min[index] && value <= in->system->par_max[index]))
    return ALI3_BAD_ARGUMENT;
  const double before = in->parameter[index];
  in->parameter[index] = value;
  if (ali3_parameters_apply(in) == ALI3_OK) return ALI3_OK;
  in->parameter[index] = before;
  ali3_parameters_apply(in);
  return ALI3_BAD_ARGUMENT;
}

ali3_status ali3_get_parameter(const ali3_instance *in, int32_t index, double *value) {
  if (in == NULL || value == NULL || index < 0 || index >= in->system->size.np) return ALI3_BAD_ARGUMENT;
  *value = in->parameter[index];
  return ALI3_OK;
}

ali3_status ali3_set_pose(ali3_instance *in, double x, double y, double z, double yaw, double speed) {
  const double given[5] = {x, y, z, yaw, speed};
  if (in == NULL || !in->system->size.has_pose || !ali3_finite(given, 5)) return ALI3_BAD_ARGUMENT;
  if (fmax(fabs(x), fmax(fabs(y), fabs(z))) > ALI3_FARTHEST || fabs(speed) > ALI3_FASTEST) return ALI3_TOO_FAR;
  const ali3_system *S = in->system;
  const double c = ali3_cos(yaw), s = ali3_sin(yaw);
  for (int32_t i = 0; i < S->size.nq; i++) {
    in->now.q[i] = in->pose_0[i] + c * in->pose_cos[i] + s * in->pose_sin[i] + x * S->pose_x[i] + y * S->pose_y[i] +
                   z * S->pose_z[i];
    in->now.qd[i] = speed * (c * S->pose_x[i] + s * S->pose_y[i] + S->pose_speed[i]);
  }
  memcpy(in->pose, given, sizeof given);
  in->placed = ALI3_PLACED_BY_POSE;
  in->initialised = 0;
  return ALI3_OK;
}

ali3_status ali3_set_q(ali3_instance *in, const double *q, const double *qd) {
  if (in == NULL) return ALI3_BAD_ARGUMENT;
  const int32_t nq = in->system->size.nq;
  if ((q != NULL && !ali3_finite(q, nq)) || (qd != NULL && !ali3_finite(qd, nq))) return ALI3_BAD_ARGUMENT;
  if (q != NULL) {
    copy(in->now.q, q, nq);
    in->placed = ALI3_PLACED_BY_Q;
  }
  if (qd != NULL) copy(in->now.qd, qd, nq);
  in->initialised = 0;
  return ALI3_OK;
}
