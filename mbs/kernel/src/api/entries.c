/* The functions of the kernel for callers that may round in another way: entry_NAME for ali3_NAME.
 * Written by `python mbs/kernel/read_headers.py`. */
#include "../instance.h"

/* An instance keeps what its caller has, for the function that it is asked for inputs. */
static ali3_float_control set_for(ali3_instance *in) {
  const ali3_float_control before = ali3_float_control_set();
  if (in != NULL) in->inputs.host_control = before;
  return before;
}

/* clang-format off */
#define ENTRY(type, name, parameters, arguments, instance) \
  ALI3_API type entry_##name parameters; \
  ALI3_API type entry_##name parameters { \
    const ali3_float_control before = set_for(instance); \
    type result = name arguments; \
    ali3_float_control_restore(before); \
    return result; \
  }
#define PROCEDURE(name, parameters, arguments, instance) \
  ALI3_API void entry_##name parameters; \
  ALI3_API void entry_##name parameters { \
    const ali3_float_control before = set_for(instance); \
    name arguments; \
    ali3_float_control_restore(before); \
  }

ENTRY(const char *, ali3_status_text, (ali3_status s), (s), NULL)
ENTRY(const char *, ali3_status_remedy, (ali3_status s), (s), NULL)
ENTRY(ali3_cause, ali3_status_cause, (ali3_status s), (s), NULL)
ENTRY(uint32_t, ali3_version, (void), (), NULL)
ENTRY(size_t, ali3_structure_size, (const char *name), (name), NULL)
ENTRY(ali3_status, ali3_system_load, (const void *bytes, size_t size, ali3_system **out, char *message, size_t message_size), (bytes, size, out, message, message_size), NULL)
ENTRY(ali3_status, ali3_system_load_with, (const void *bytes, size_t size, const ali3_memory *memory, ali3_system **out, char *message, size_t message_size), (bytes, size, memory, out, message, message_size), NULL)
PROCEDURE(ali3_system_free, (ali3_system *s), (s), NULL)
ENTRY(uint32_t, ali3_system_structure, (const ali3_system *s), (s), NULL)
ENTRY(ali3_status, ali3_system_attach, (ali3_system *s, const ali3_generated *generated, char *message, size_t message_size), (s, generated, message, message_size), NULL)
ENTRY(ali3_sizes, ali3_system_sizes, (const ali3_system *s), (s), NULL)
ENTRY(int32_t, ali3_road_count, (const ali3_system *s), (s), NULL)
ENTRY(size_t, ali3_instance_size, (const ali3_system *s), (s), NULL)
ENTRY(ali3_status, ali3_instance_new, (const ali3_system *s, ali3_instance **out), (s, out), NULL)
PROCEDURE(ali3_instance_free, (ali3_instance *in), (in), in)
ENTRY(ali3_status, ali3_set_road, (ali3_instance *in, int32_t road, const char *path, char *message, size_t message_size), (in, road, path, message, message_size), in)
ENTRY(const char *, ali3_road_lost, (const ali3_instance *in), (in), NULL)
PROCEDURE(ali3_grid_heights, (int32_t nx, int32_t ny, const double grid[4], const double *z, int64_t n, const double *places, double *heights), (nx, ny, grid, z, n, places, heights), NULL)
ENTRY(int, ali3_is_road_normal, (const double n[3]), (n), NULL)
ENTRY(ali3_status, ali3_wheel_in_road, (const ali3_instance *in, int32_t *element, char *text, size_t size), (in, element, text, size), NULL)
ENTRY(ali3_status, ali3_beyond_table, (const ali3_instance *in, int32_t *column, double value_and_ends[3]), (in, column, value_and_ends), NULL)
ENTRY(ali3_status, ali3_rim_text, (const ali3_instance *in, int32_t *element, char *text, size_t size), (in, element, text, size), NULL)
ENTRY(ali3_status, ali3_reset, (ali3_instance *in), (in), in)
ENTRY(ali3_settings, ali3_default_settings, (void), (), NULL)
ENTRY(ali3_status, ali3_set_settings, (ali3_instance *in, const ali3_settings *settings), (in, settings), in)
ENTRY(ali3_status, ali3_get_settings, (const ali3_instance *in, ali3_settings *settings), (in, settings), NULL)
ENTRY(ali3_status, ali3_set_input, (ali3_instance *in, int32_t index, double value), (in, index, value), in)
ENTRY(ali3_status, ali3_set_input_function, (ali3_instance *in, ali3_input_function *function, void *context), (in, function, context), in)
ENTRY(ali3_status, ali3_set_input_breaks, (ali3_instance *in, const double *time, int64_t n), (in, time, n), in)
ENTRY(int32_t, ali3_input_of_tables, (void *tables, double t, int32_t after, double *input), (tables, t, after, input), NULL)
ENTRY(ali3_status, ali3_get_input, (const ali3_instance *in, int32_t index, double *value), (in, index, value), NULL)
ENTRY(ali3_status, ali3_set_parameter, (ali3_instance *in, int32_t index, double value), (in, index, value), in)
ENTRY(ali3_status, ali3_try_parameter, (ali3_instance *in, int32_t index, double value), (in, index, value), in)
ENTRY(ali3_status, ali3_get_parameter, (const ali3_instance *in, int32_t index, double *value), (in, index, value), NULL)
ENTRY(ali3_status, ali3_set_pose, (ali3_instance *in, const double *pose), (in, pose), in)
ENTRY(ali3_status, ali3_set_q, (ali3_instance *in, const double *q, const double *qd), (in, q, qd), in)
ENTRY(ali3_status, ali3_set_switch, (ali3_instance *in, int32_t number, int32_t on), (in, number, on), in)
ENTRY(ali3_status, ali3_get_switch, (const ali3_instance *in, int32_t number, int32_t *on), (in, number, on), NULL)
ENTRY(ali3_status, ali3_initialise, (ali3_instance *in, double t0), (in, t0), in)
ENTRY(ali3_status, ali3_settle, (ali3_instance *in, double duration, double h), (in, duration, h), in)
PROCEDURE(ali3_count_work, (ali3_instance *in, int64_t *left), (in, left), in)
ENTRY(double, ali3_unsettled, (const ali3_instance *in), (in), NULL)
ENTRY(double, ali3_start_excess, (const ali3_instance *in, int32_t *element, const char **words), (in, element, words), NULL)
ENTRY(ali3_status, ali3_start_text, (const ali3_instance *in, char *text, size_t size), (in, text, size), NULL)
ENTRY(double, ali3_no_force, (const ali3_instance *in), (in), NULL)
ENTRY(const char *, ali3_method_excludes, (const ali3_instance *in), (in), NULL)
ENTRY(ali3_status, ali3_static_equilibrium, (ali3_instance *in, double t0, double tolerance, int32_t max_iterations), (in, t0, tolerance, max_iterations), in)
ENTRY(ali3_status, ali3_step, (ali3_instance *in, double h), (in, h), in)
ENTRY(ali3_status, ali3_run, (ali3_instance *in, double h, int64_t n_steps, const double *inputs, int64_t every, double *out, double *positions, int64_t *done), (in, h, n_steps, inputs, every, out, positions, done), in)
ENTRY(int32_t, ali3_widest_lanes, (void), (), NULL)
ENTRY(size_t, ali3_many_size, (const ali3_system *s, int32_t width), (s, width), NULL)
ENTRY(ali3_status, ali3_many_new, (const ali3_system *s, int32_t width, ali3_many **out), (s, width, out), NULL)
PROCEDURE(ali3_many_free, (ali3_many *many), (many), NULL)
ENTRY(ali3_status, ali3_many_run, (ali3_many *many, int32_t n, ali3_lane *lane, double h, int64_t n_steps, int64_t every), (many, n, lane, h, n_steps, every), NULL)
ENTRY(ali3_status, ali3_control_run, (ali3_instance *in, ali3_control *control, const double *scale, double t_end, int64_t most_steps, const ali3_record *record, int64_t *done), (in, control, scale, t_end, most_steps, record, done), in)
ENTRY(ali3_status, ali3_refresh, (ali3_instance *in), (in), in)
ENTRY(ali3_status, ali3_sensors, (ali3_instance *in, double *out), (in, out), in)
ENTRY(ali3_status, ali3_some_sensors, (ali3_instance *in, int32_t n, const int32_t *number, double *out), (in, n, number, out), in)
ENTRY(ali3_status, ali3_ports_follow, (ali3_instance *in, const ali3_instance *source), (in, source), in)
ENTRY(ali3_status, ali3_sensor_rates, (ali3_instance *in, double *rates, unsigned char *known), (in, rates, known), in)
ENTRY(ali3_status, ali3_report_get, (const ali3_instance *in, ali3_report *out), (in, out), NULL)
ENTRY(double, ali3_energy_balance, (const ali3_report *report), (report), NULL)
PROCEDURE(ali3_compare, (const ali3_judged *judged, int32_t n, int64_t rows, const double *time, const double *one, const double *other, ali3_compared *seen), (judged, n, rows, time, one, other, seen), NULL)
PROCEDURE(ali3_compared_sizes, (const ali3_judged *judged, int32_t n, const ali3_compared *seen, double length, double energy, int32_t exclude_prescribed, double *size), (judged, n, seen, length, energy, exclude_prescribed, size), NULL)
ENTRY(double, ali3_compared_error, (int32_t n, const ali3_compared *seen, const double *size, int32_t latest, int32_t *worst), (n, seen, size, latest, worst), NULL)
ENTRY(ali3_status, ali3_branch_text, (const ali3_instance *in, char *text, size_t size), (in, text, size), NULL)
ENTRY(double, ali3_time, (const ali3_instance *in), (in), NULL)
ENTRY(double, ali3_solver_value, (const ali3_instance *in, int32_t kind), (in, kind), NULL)
ENTRY(double, ali3_capped_residual, (const ali3_instance *in), (in), NULL)
ENTRY(size_t, ali3_state_size, (const ali3_system *s), (s), NULL)
ENTRY(ali3_status, ali3_state_save, (const ali3_instance *in, void *bytes, size_t size), (in, bytes, size), NULL)
ENTRY(ali3_status, ali3_state_restore, (ali3_instance *in, const void *bytes, size_t size), (in, bytes, size), in)
ENTRY(size_t, ali3_snapshot_size, (const ali3_system *s), (s), NULL)
PROCEDURE(ali3_snapshot_take, (const ali3_instance *in, void *snapshot), (in, snapshot), NULL)
PROCEDURE(ali3_snapshot_restore, (ali3_instance *in, const void *snapshot), (in, snapshot), in)
ENTRY(ali3_status, ali3_snapshot_check, (ali3_instance *in, const void *snapshot), (in, snapshot), in)
PROCEDURE(ali3_contacts, (const ali3_instance *in, unsigned char *touching), (in, touching), NULL)
PROCEDURE(ali3_law_pieces, (ali3_instance *in, uint32_t *piece), (in, piece), in)
ENTRY(ali3_status, ali3_get_state, (const ali3_instance *in, double *q, double *qd, double *qdd, double *lam, double *y), (in, q, qd, qdd, lam, y), NULL)
ENTRY(ali3_status, ali3_evaluate, (ali3_instance *in, const double *q, const double *qd, const double *y, double t, double *phi, double *jacobian_values, double *phi_t, double *gamma , double *force , double *outputs), (in, q, qd, y, t, phi, jacobian_values, phi_t, gamma, force, outputs), in)
ENTRY(ali3_status, ali3_tangent, (ali3_instance *in, double h, const double *lam, double *dense), (in, h, lam, dense), in)
ENTRY(ali3_status, ali3_mass_matrix, (ali3_instance *in, const double *q, double *dense), (in, q, dense), in)
ENTRY(ali3_status, ali3_element_step, (ali3_instance *in, const double *q, const double *qd, const double *y_old, double h, double *y_new, double *force), (in, q, qd, y_old, h, y_new, force), in)
