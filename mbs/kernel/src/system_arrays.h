/* The arrays of a System file, in one list. From it come their place in `ali3_system`, what the loader checks of each
 * (check_arrays.c), `ARRAYS` in Python and the tables of docs/system_file.md; the last two are written by
 * `python mbs/kernel/read_headers.py`. What is neither a length nor a range of one array is checked in check_*.c. */
#ifndef ALI3_SYSTEM_ARRAYS_H
#define ALI3_SYSTEM_ARRAYS_H
#include <stdint.h>

/* clang-format off */
/* Sizes: X(name, array whose length is the size times the third argument, third argument, words). */
#define ALI3_SYSTEM_SIZES(X) \
  X(nq, q0, 1, "coordinates") \
  X(nc, row_const, 1, "rows (constraint equations)") \
  X(nu, input_start, 1, "inputs") \
  X(ng, guide_type, 1, "driving functions") \
  X(ne, el_type, 1, "force elements") \
  X(ny, y0, 1, "element states") \
  X(ns, sen_type, 1, "sensors") \
  X(np, par_value, 1, "parameters") \
  X(nf, front_parent, 1, "fronts") \
  X(nr, road_type, 1, "roads") \
  X(nsig, sig_const, 1, "signals") \
  X(nb, flex_front, 1, "flexible bodies") \
  X(n_mass, mass_col, 1, "entries of the mass matrix") \
  X(n_row, row_col, 1, "entries of the pattern of Phi_q") \
  X(n_quad, quad_a, 1, "quadratic terms") \
  X(n_angle, angle_row, 1, "rows of angles") \
  X(n_angle_term, angle_a, 1, "terms of these") \
  X(n_gterm, gterm_row, 1, "terms with driving functions") \
  X(n_velocity, velocity_row, 1, "rows on velocities") \
  X(n_velocity_term, velocity_a, 1, "terms of these") \
  X(n_switch, switch_start, 1, "switches") \
  X(n_front, front_idx, 1, "coordinates of all fronts") \
  X(n_entry, sig_col, 1, "entries of all signals") \
  X(n_write, par_target, 1, "numbers that parameters write") \
  X(n_payload, payload_mass, 1, "payloads") \
  X(n_armature, armature_ratio, 1, "armatures whose ratio parameters write") \
  X(n_inertia, inertia_parameter, 10, "bodies whose inertia parameters write") \
  X(n_axis, axis_inertia, 1, "wheels whose axis parameters write") \
  X(n_lookup, tabled_size, 3, "tables") \
  X(n_ported_ptr, ported_ptr, 1, "coordinates without ports, and 1") \
  X(n_ported, ported_row, 1, "entries of the map from these") \
  X(n_ported_lam_ptr, ported_lam_ptr, 1, "rows without ports, and 1") \
  X(n_ported_lam, ported_lam_row, 1, "entries of the map from their multipliers") \
  X(n_ported_force, ported_force_col, 1, "entries of the map to the forces at ports") \
  X(n_pose, pose_0, 1, "coordinates of a scene that is not tied to the ground") \
  X(n_static, static_par, 1, "parameters that a search for the equilibrium sets") \
  X(n_mode, flex_mode, 1, "modes of all flexible bodies") \
  X(n_joint, tree_parent, 1, "joints of the tree") \
  X(n_out, tree_out_body, 1, "points and vectors of the tree") \
  X(n_cut, tree_cut_body, 2, "cut joints of the tree") \
  X(n_sum, tree_angle_col, 1, "angles of the tree") \
  X(n_summand, tree_angle_joint, 1, "joints of all these") \
  X(n_mode_ptr, mode_triad_ptr, 1, "closed loops, and 1") \
  X(n_triad, mode_triad, 11, "triads of all loops")

/* X(items, name, presence, length, values, words)
 *
 * presence: MUST, or MAY: a file may lack it, and its length is 0 then.
 * length: sizes of the list above; ANY; OR_NONE(n): n or 0; IF_ANY(k, n): n if there are k, otherwise 0; ANY_IF(k): any
 * if there are k, otherwise 0; RELATED_LENGTH: depends on values of others, see check_*.c.
 * values: BELOW(n): 0 to n - 1; WITHIN(low, high): low to high; OFFSETS(array): from 0 to the length of that array,
 * none below the one before; ASCENDING: the same to any; RELATED: depends on values of others, see check_*.c; FINITE;
 * OR_INFINITE; TEXT. */
#define ALI3_SYSTEM_ARRAYS(X) \
  /* Positions, mass and gravity */ \
  X(BYTES, meta, MUST, ANY, TEXT, \
    "JSON, UTF-8: names, units, constants, report; Python reads it, the kernel does not") \
  X(BYTES, drawing, MAY, ANY, TEXT, \
    "JSON, UTF-8: what is drawn (below); the kernel does not read it, and Python hands Systems to the kernel and " \
    "to FMUs without it") \
  X(REALS, q0, MUST, nq, FINITE, \
    "consistent initial position: m of points, 1 of directions, rad of angles, earth axes") \
  X(REALS, qd0, MUST, nq, FINITE, "consistent initial velocity: units of `q0` per s") \
  X(REALS, y0, MUST, ny, FINITE, "initial element states, units by the element type") \
  X(INTEGERS, mass_ptr, MUST, nq + 1, OFFSETS(mass_col), "constant mass matrix, CSR, both triangles: its rows") \
  X(INTEGERS, mass_col, MUST, n_mass, BELOW(nq), "its columns, ascending in a row") \
  X(REALS, mass_val, MUST, n_mass, FINITE, "its entries: kg, kg m, kg m²; the kinetic energy is qd' M qd/2, J") \
  X(INTEGERS, mass_pos, MUST, n_mass, RELATED, \
    "index into front storage of entry (row, col) when row >= col, otherwise -1") \
  X(REALS, gravity_force, MUST, nq, FINITE, \
    "constant generalised force of gravity, N or N m; potential = gravity_const - gravity_force . q") \
  X(REALS, gravity_const, MUST, 1, FINITE, "constant part of that potential, J") \
  /* Rows */ \
  X(INTEGERS, row_ptr, MUST, nc + 1, OFFSETS(row_col), "pattern of Phi_q, CSR") \
  X(INTEGERS, row_col, MUST, n_row, BELOW(nq), "its columns, ascending in a row") \
  X(REALS, row_lin, MUST, n_row, FINITE, "linear coefficients of Phi_stored") \
  X(REALS, row_const, MUST, nc, FINITE, "constant term of Phi_stored") \
  X(REALS, row_scale, MUST, nc, FINITE, \
    "Phi_stored = row_scale * Phi_user, lam_user = row_scale * lam_stored; M qdd + Phi_q' lam = Q, so a row puts " \
    "the force -Phi_q' lam on its coordinates") \
  X(REALS, row_measure, MUST, nc, FINITE, \
    "|Phi_stored| * row_measure = violation in m (or rad) used for tolerance and report: row_measure = 1/|Phi_q " \
    "stored| at reference") \
  X(INTEGERS, row_front, MUST, nc, BELOW(nf), "front of the row") \
  X(INTEGERS, row_loc, MUST, n_row, RELATED, \
    "per pattern entry, the variable's local index in that front (ascending)") \
  X(INTEGERS, quad_ptr, MUST, nc + 1, OFFSETS(quad_a), \
    "terms h * q[col(a)] * q[col(b)] of a row, one entry per unordered pair") \
  X(INTEGERS, quad_a, MUST, n_quad, RELATED, "a, a position within the row's pattern (0-based within the row)") \
  X(INTEGERS, quad_b, MUST, n_quad, RELATED, "b, another, a >= b") \
  X(REALS, quad_h, MUST, n_quad, FINITE, "h, of Phi_stored") \
  X(INTEGERS, angle_row, MUST, n_angle, BELOW(nc), \
    "rows of kind angle: Phi = scale*(cos(theta) S - sin(theta) C) + the quadratic part of the row") \
  X(INTEGERS, angle_theta, MUST, n_angle, RELATED, "position of theta within the row's pattern") \
  X(INTEGERS, angle_ptr, MUST, n_angle + 1, OFFSETS(angle_a), "terms C += hc*q_a*q_b, S += hs*q_a*q_b of such a row") \
  X(INTEGERS, angle_a, MUST, n_angle_term, RELATED, "a, a position within the row's pattern, or -1") \
  X(INTEGERS, angle_b, MUST, n_angle_term, RELATED, \
    "b, another, a >= b; b = -1: linear term q_a; a = b = -1: constant") \
  X(REALS, angle_hc, MUST, n_angle_term, FINITE, "hc; the scale is folded in") \
  X(REALS, angle_hs, MUST, n_angle_term, FINITE, "hs; the scale is folded in") \
  X(INTEGERS, gterm_row, MUST, n_gterm, BELOW(nc), "extra terms h * s_g^power * q_a * q_b of a row") \
  X(INTEGERS, gterm_guide, MUST, n_gterm, BELOW(ng), "g") \
  X(INTEGERS, gterm_power, MUST, n_gterm, WITHIN(1, 2), "power") \
  X(INTEGERS, gterm_a, MUST, n_gterm, RELATED, "a, a position within the row's pattern, -1 as in `angle_a`") \
  X(INTEGERS, gterm_b, MUST, n_gterm, RELATED, "b, another, -1 as in `angle_b`") \
  X(REALS, gterm_h, MUST, n_gterm, FINITE, "h, of Phi_stored") \
  X(INTEGERS, velocity_row, MUST, n_velocity, BELOW(nc), \
    "rows that are conditions on velocities, ascending: sum over b of A_b qd_b = 0. They have no constant, " \
    "quadratic, angle or driving function terms; their `row_lin` are constant parts of A") \
  X(INTEGERS, velocity_ptr, MUST, n_velocity + 1, OFFSETS(velocity_a), "terms A_b += h * q_a of such a row") \
  X(INTEGERS, velocity_a, MUST, n_velocity_term, RELATED, "a, a position within the row's pattern") \
  X(INTEGERS, velocity_b, MUST, n_velocity_term, RELATED, "b, another") \
  X(REALS, velocity_h, MUST, n_velocity_term, FINITE, "h, of Phi_stored") \
  X(INTEGERS, row_switch, MUST, nc, WITHIN(-1, n_switch - 1), \
    "switch of the row, -1: always on. A switched row has no angle") \
  X(INTEGERS, switch_start, MUST, n_switch, BELOW(2), "state at the start, 1: on; every switch has a row") \
  X(REALS, fineness, MAY, OR_NONE(1), FINITE, \
    "factor of tolerances in m, of a very small or large drawing; by default 1") \
  /* Fronts */ \
  X(INTEGERS, front_col, MUST, nf + 1, OFFSETS(q0), \
    "front s eliminates the coordinates front_col[s] .. front_col[s+1]-1") \
  X(INTEGERS, front_ptr, MUST, nf + 1, OFFSETS(front_idx), "coordinates of a front") \
  X(INTEGERS, front_idx, MUST, n_front, RELATED, "these, ascending, pivots first") \
  X(INTEGERS, front_parent, MUST, nf, WITHIN(-1, nf - 1), "parent front, which is larger, or -1") \
  X(INTEGERS, front_map, MUST, n_front, RELATED, \
    "of the coordinates that are not pivots the local index in the parent front; of pivots -1") \
  X(INTEGERS, front_off, MUST, nf + 1, ASCENDING, \
    "offset of the front's dense m x m block, column major, lower triangle used: entry (i, j), i >= j, at off + " \
    "j*m + i") \
  /* Signals and force elements */ \
  X(INTEGERS, sig_ptr, MUST, nsig + 1, OFFSETS(sig_col), "affine signals u = sum val*q[col] + const") \
  X(INTEGERS, sig_col, MUST, n_entry, RELATED, "coordinate, or a dependent of a table if not below nq") \
  X(REALS, sig_val, MUST, n_entry, FINITE, "val: unit of the signal per unit of the coordinate") \
  X(REALS, sig_const, MUST, nsig, FINITE, "const, unit of the signal") \
  X(INTEGERS, el_type, MUST, ne, RELATED, \
    "element type, numbered in `mbs/kernel/src/elements/element_types.h`; what its signals and data mean stands " \
    "in the C file of its name, or in `_fields.h` beside it") \
  X(INTEGERS, el_sig_ptr, MUST, ne + 1, OFFSETS(el_sig), "signals of the element") \
  X(INTEGERS, el_sig, MUST, ANY, BELOW(nsig), "these, in the order its type defines") \
  X(INTEGERS, el_parameter_ptr, MUST, ne + 1, OFFSETS(el_parameter), "its parameters") \
  X(REALS, el_parameter, MUST, ANY, FINITE, "these; units by the element type") \
  X(INTEGERS, el_int_ptr, MUST, ne + 1, OFFSETS(el_int), "its data: integers") \
  X(INTEGERS, el_int, MUST, ANY, RELATED, "these") \
  X(INTEGERS, el_state_ptr, MUST, ne + 1, OFFSETS(y0), "its slots in y") \
  X(INTEGERS, el_out_ptr, MUST, ne + 1, ASCENDING, "its slots in the element-output array") \
  X(INTEGERS, el_front, MUST, ne, WITHIN(-1, nf - 1), \
    "front that holds all its coordinates; -1: has none, or adds nothing to the tangent") \
  X(INTEGERS, el_loc_ptr, MUST, ne + 1, OFFSETS(el_loc), "where its local indices are") \
  X(INTEGERS, el_loc, MUST, ANY, RELATED, \
    "local index of each signal entry in that front (concatenated over the element's signals in order)") \
  /* Inputs, driving functions and roads */ \
  X(REALS, input_start, MUST, nu, FINITE, "value at the start, in the unit that `meta` names") \
  X(REALS, input_min, MUST, nu, OR_INFINITE, "lowest value, same unit") \
  X(REALS, input_max, MUST, nu, OR_INFINITE, "highest value, same unit") \
  X(INTEGERS, guide_type, MUST, ng, BELOW(ALI3_DRIVING_TYPE_COUNT), \
    "0: polynomial pieces of time; 1: an input through a filter; 2: two inputs through a filter; 3: a curve over " \
    "an earlier driving function") \
  X(INTEGERS, guide_input, MUST, ng, RELATED, \
    "input of types 1 and 2; earlier driving function of type 3, which is not of type 3") \
  X(INTEGERS, guide_second, MAY, OR_NONE(ng), RELATED, "second input of type 2; may be missing if there is none") \
  X(INTEGERS, guide_parameter_ptr, MUST, ng + 1, OFFSETS(guide_parameter), "parameters of a driving function") \
  X(REALS, guide_parameter, MUST, ANY, FINITE, \
    "type 0: [n, b_0..b_n, then n*6 coefficients c0..c5 of (t-b_k)^j], clamped outside with zero rates; type 1: " \
    "s'' = w^2 (u*gain - s) - 2 w s', [w, gain, s0]; type 2: clamp(u*gain + u_2*gain_2, low, high) instead of " \
    "u*gain, [w, gain, s0, gain_2, low, high]; type 3: n values of the other driving function, n values and n " \
    "slopes, a cubic between two points and straight beyond the ends") \
  X(INTEGERS, road_type, MUST, nr, RELATED, "see `mbs/kernel/src/elements/road.h`") \
  X(INTEGERS, road_parameter_ptr, MUST, nr + 1, OFFSETS(road_parameter), "parameters of a road") \
  X(REALS, road_parameter, MUST, ANY, FINITE, \
    "these, m and earth axes; a plane of four numbers and a kerb of five have the friction factor 1") \
  /* Parameters */ \
  X(REALS, par_value, MUST, np, FINITE, "value of the parameter, in the unit that `meta` names") \
  X(REALS, par_min, MUST, np, OR_INFINITE, "lowest value, same unit") \
  X(REALS, par_max, MUST, np, OR_INFINITE, "highest value, same unit") \
  X(INTEGERS, par_ptr, MUST, np + 1, OFFSETS(par_target), \
    "what the parameter writes: value*scale + offset to element `index` of the target") \
  X(INTEGERS, par_target, MUST, n_write, BELOW(ALI3_TARGET_COUNT), \
    "0 el_parameter, 1 guide_parameter, 2 road_parameter, 3 payload_mass, 4 the switch `index`, 0 or 1 (fixed, as " \
    "those of payloads), 5 armature_ratio (fixed), 6 inertia_parameter (fixed), 7 sen_parameter, 8 axis_parameter (fixed)") \
  X(INTEGERS, par_index, MUST, n_write, RELATED, "index in the target") \
  X(REALS, par_scale, MUST, n_write, FINITE, "scale") \
  X(REALS, par_offset, MAY, OR_NONE(n_write), FINITE, "offset, by default 0") \
  X(INTEGERS, par_inverse, MAY, OR_NONE(n_write), BELOW(2), \
    "1: scale/value is written instead of value*scale; by default 0") \
  X(INTEGERS, par_fixed, MAY, OR_NONE(np), BELOW(2), \
    "1: the parameter can be set before the start only; by default 0") \
  /* Masses that parameters write */ \
  X(REALS, payload_mass, MAY, n_payload, FINITE, \
    "point masses, kg: M and gravity of an instance are those above plus m C'C and m C'g. Only a fixed parameter " \
    "writes a mass") \
  X(INTEGERS, payload_signal, MAY, 3 * n_payload, BELOW(nsig), \
    "signals of x, y, z of each, m, earth axes; the pattern of `mass_col` has their places") \
  X(REALS, payload_gravity, MAY, IF_ANY(n_payload, 3), FINITE, "acceleration of gravity, m/s², earth axes") \
  X(INTEGERS, armature_col, MAY, n_armature, BELOW(nq), \
    "coordinate; what turns `ratio` times as fast as it, with an inertia of its own, where a parameter writes the" \
    " ratio") \
  X(REALS, armature_inertia, MAY, n_armature, FINITE, \
    "inertia, kg m²; `mass_val` has inertia*ratio^2, an instance what its own ratio makes of it") \
  X(REALS, armature_ratio, MAY, n_armature, FINITE, "ratio of both speeds") \
  X(REALS, inertia_parameter, MAY, 10 * n_inertia, FINITE, \
    "bodies whose inertia fixed parameters write: mass, centre of mass, moments xx, yy, zz and entries xy, xz, yz" \
    " of the inertia tensor about it, as drawn, which `mass_val` has; an instance has what its own numbers change") \
  X(INTEGERS, inertia_signal, MAY, 12 * n_inertia, BELOW(nsig), \
    "signals of the centre of mass as drawn and of the axes; the pattern of `mass_col` has their places") \
  X(REALS, inertia_gravity, MAY, IF_ANY(n_inertia, 3), FINITE, "acceleration of gravity, m/s², earth axes") \
  X(REALS, axis_parameter, MAY, 2 * n_axis, FINITE, \
    "wheels whose axes fixed parameters write: azimuth and elevation as drawn, rad") \
  X(REALS, axis_vector, MAY, 9 * n_axis, FINITE, \
    "unit vectors f, g and the axis e = f x g in the drawing, earth axes") \
  X(REALS, axis_inertia, MAY, n_axis, FINITE, "diametral inertia, kg m²") \
  X(REALS, axis_rolling, MAY, 2 * n_axis, FINITE, "rolling radius, m, and its growth by 1/cos(elevation)") \
  X(INTEGERS, axis_frame, MAY, 9 * n_axis, BELOW(nsig), "signals of the carrier's axes") \
  X(INTEGERS, axis_signal, MAY, 9 * n_axis, BELOW(nsig), \
    "signals of f, g and e, which have entries for all coordinates of those") \
  X(INTEGERS, axis_spin, MAY, n_axis, BELOW(nq), "coordinate of the spin") \
  X(INTEGERS, axis_table, MAY, n_axis, WITHIN(-1, n_lookup - 1), "the table that is the carrier, or -1") \
  /* Tables */ \
  X(INTEGERS, tabled_size, MAY, 3 * n_lookup, RELATED, \
    "of each table: functions (12 of a body, 1 of a number) and control points along both variables (the second " \
    "1: there is one variable)") \
  X(INTEGERS, tabled_param, MAY, 2 * n_lookup, WITHIN(-1, nq - 1), "coordinates that are the variables, -1: none") \
  X(INTEGERS, tabled_frame, MAY, 12 * n_lookup, WITHIN(-1, nq - 1), \
    "of a body the coordinates of its base, r, a, b, c, -1: the earth") \
  X(REALS, tabled_axis, MAY, 4 * n_lookup, FINITE, "first point and spacing along both variables, in their units") \
  X(REALS, tabled_coef, MAY, RELATED_LENGTH, FINITE, \
    "control points of uniform cubic B-splines, functions fastest, then the second variable: p and R's columns " \
    "along the axes of the base; as many as `tabled_size` says") \
  X(REALS, tabled_mass, MAY, 10 * n_lookup, FINITE, \
    "mass, kg, first moments, kg m, second moments xx, yy, zz, yz, zx, xy, kg m², of a body about r + X_0 along " \
    "its axes") \
  X(REALS, tabled_gravity, MAY, 3 * n_lookup, FINITE, \
    "acceleration of gravity, m/s², earth axes. Dependents, 12 of a body and 1 of a number, follow each other; " \
    "`sig_col` may name them from nq on") \
  /* Ports */ \
  X(INTEGERS, ported_ptr, MAY, ANY, OFFSETS(ported_row), \
    "of a System with ports: its coordinates by those of the same model without them, q = const + T q', T by " \
    "columns (`ali3_ports_follow`)") \
  X(INTEGERS, ported_row, MAY, ANY_IF(n_ported_ptr), BELOW(nq), "coordinate") \
  X(REALS, ported_val, MAY, n_ported, FINITE, "entry of T") \
  X(REALS, ported_const, MAY, IF_ANY(n_ported_ptr, nq), FINITE, "const") \
  X(INTEGERS, ported_lam_ptr, MAY, ANY_IF(n_ported_ptr), OFFSETS(ported_lam_row), \
    "its multipliers, but for those of the ports, by those without them, the matrix by columns") \
  X(INTEGERS, ported_lam_row, MAY, ANY_IF(n_ported_lam_ptr), BELOW(nc), "row") \
  X(REALS, ported_lam_val, MAY, n_ported_lam, FINITE, "entry") \
  X(INTEGERS, ported_force_ptr, MAY, IF_ANY(n_ported_ptr, nc + 1), OFFSETS(ported_force_col), \
    "multipliers of the rows of ports by the generalised forces that they balance, the matrix by rows, of which " \
    "those of other rows are empty") \
  X(INTEGERS, ported_force_col, MAY, ANY_IF(n_ported_ptr), BELOW(nq), "coordinate") \
  X(REALS, ported_force_val, MAY, n_ported_force, FINITE, "entry") \
  /* Start */ \
  X(REALS, pose_0, MUST, OR_NONE(nq), FINITE, \
    "initial pose of a scene that is not tied to the ground: q = pose_0 + cos(yaw) pose_cos + sin(yaw) pose_sin +" \
    " x pose_x + y pose_y + z pose_z, qd = speed*(cos(yaw) pose_x + sin(yaw) pose_y + pose_speed)") \
  X(REALS, pose_cos, MUST, n_pose, FINITE, "factor of cos(yaw)") \
  X(REALS, pose_sin, MUST, n_pose, FINITE, "factor of sin(yaw)") \
  X(REALS, pose_x, MUST, n_pose, FINITE, "factor of x") \
  X(REALS, pose_y, MUST, n_pose, FINITE, "factor of y") \
  X(REALS, pose_z, MUST, n_pose, FINITE, "factor of z") \
  X(REALS, pose_speed, MUST, n_pose, FINITE, "spins of the wheels per speed, rad/m") \
  X(INTEGERS, pose_partner, MAY, OR_NONE(n_pose), WITHIN(-nsig, nsig), \
    "of an x component minus, of a y component plus (the signal of the other one + 1), or 0: how a pose turns a" \
    " scene that starts elsewhere than at `q0`") \
  X(INTEGERS, static_start, MAY, OR_NONE(1), WITHIN(1, 1), \
    "[1]: `q0` is a static equilibrium, to be found again where parameters of elements, driving functions or " \
    "payloads differ") \
  X(INTEGERS, static_par, MAY, n_static, BELOW(np), "parameters that hold other values while it is sought") \
  X(REALS, static_value, MAY, n_static, FINITE, "these values") \
  X(REALS, static_q, MAY, RELATED_LENGTH, FINITE, \
    "where it is sought from, of length nq, nq+ny or 0: q and, where friction holds what rests, y; by default " \
    "`q0`, `y0`") \
  /* Sensors */ \
  X(INTEGERS, sen_type, MUST, ns, BELOW(ALI3_SENSOR_TYPE_COUNT), "type, see below") \
  X(INTEGERS, sen_int_ptr, MUST, ns + 1, OFFSETS(sen_int), "integers of a sensor") \
  X(INTEGERS, sen_int, MUST, ANY, RELATED, "these") \
  X(INTEGERS, sen_parameter_ptr, MUST, ns + 1, OFFSETS(sen_parameter), "parameters of a sensor") \
  X(REALS, sen_parameter, MUST, ANY, FINITE, "these; meaning by the type") \
  /* Flexible bodies */ \
  X(INTEGERS, flex_mode_ptr, MUST, nb + 1, OFFSETS(flex_mode), \
    "modes of a body: n = flex_mode_ptr[b+1] - flex_mode_ptr[b] >= 1") \
  X(INTEGERS, flex_frame, MUST, 12 * nb, BELOW(nq), "coordinates of r_o, a, b, c (x, y, z each)") \
  X(INTEGERS, flex_mode, MUST, n_mode, BELOW(nq), "coordinates of the amplitudes, ascending within a body") \
  X(INTEGERS, flex_front, MUST, nb, BELOW(nf), "front that holds them all") \
  X(INTEGERS, flex_loc, MUST, 12 * nb + n_mode, RELATED, "local indices there, per body frame, then modes") \
  X(REALS, flex_gravity, MUST, 3 * nb, FINITE, "acceleration of gravity, m/s², earth axes") \
  X(REALS, flex_P, MUST, 3 * n_mode, FINITE, \
    "per body 3 rows of n: sum m phi_j over the nodes, kg times the unit of phi") \
  X(REALS, flex_c, MUST, 9 * n_mode, FINITE, "per body rows xx, xy, .. zz of n: sum m x_i phi_kj") \
  X(REALS, flex_T, MUST, RELATED_LENGTH, FINITE, \
    "per body nine n x n matrices by columns. With G_ik = sum m phi_ij phi_kl: G_xx, G_yy, G_zz, (G_yz + G_zy)/2," \
    " (G_zx + G_xz)/2, (G_xy + G_yx)/2, then (G_yz - G_zy)/2, (G_zx - G_xz)/2, (G_xy - G_yx)/2") \
  X(REALS, flex_K, MUST, RELATED_LENGTH, FINITE, "per body an n x n matrix: stiffness of the amplitudes, symmetric") \
  X(REALS, flex_C, MUST, RELATED_LENGTH, FINITE, "as flex_K: damping of the amplitudes, symmetric") \
  /* Trees */ \
  X(INTEGERS, tree_parent, MUST, n_joint, RELATED, "parent, before the body") \
  X(INTEGERS, tree_slides, MUST, n_joint, BELOW(2), "0 revolute, 1 prismatic") \
  X(REALS, tree_base, MUST, 12 * n_joint, FINITE, "joint's frame on the parent: origin, m, then columns x, y, z") \
  X(REALS, tree_mass, MUST, n_joint, FINITE, "mass, kg") \
  X(REALS, tree_centre, MUST, 3 * n_joint, FINITE, "centre of mass, m, axes of the body") \
  X(REALS, tree_inertia, MUST, 9 * n_joint, FINITE, \
    "j, k1, e1 (3), k2, e2 (3): j 1 + k1 e1 e1' + k2 e2 e2' about the centre of mass, kg m², axes of the body") \
  X(REALS, tree_gravity, MUST, IF_ANY(n_joint, 3), FINITE, "acceleration of gravity, m/s², earth axes") \
  X(INTEGERS, tree_frame, MUST, 12 * n_joint, BELOW(nsig), "signals of the frame in earth axes: origin, x, y, z") \
  X(INTEGERS, tree_out_body, MUST, ANY_IF(n_joint), WITHIN(1, n_joint), \
    "points and vectors whose components are the coordinates: body") \
  X(REALS, tree_out_local, MUST, 4 * n_out, FINITE, \
    "1 (point) or 0 (vector) and its components, m or 1, axes of the body") \
  X(INTEGERS, tree_out_col, MUST, 3 * n_out, WITHIN(-1, nq - 1), "coordinates of x, y, z or -1") \
  X(INTEGERS, tree_cut_body, MUST, IF_ANY(n_joint, 2 * n_cut), WITHIN(0, n_joint), "bodies of a cut joint") \
  X(INTEGERS, tree_cut_rows, MUST, 2 * n_cut, RELATED, "rows of its point (0 to 3) and of its axis (0 to 2)") \
  X(REALS, tree_cut_place, MUST, 15 * n_cut, FINITE, \
    "point, m, and two normals of the axis on the first body, point and axis on the second") \
  X(INTEGERS, tree_angle_col, MUST, ANY_IF(n_joint), BELOW(nq), "relative angles that are coordinates") \
  X(INTEGERS, tree_angle_ptr, MUST, IF_ANY(n_joint, n_sum + 1), OFFSETS(tree_angle_joint), \
    "joints whose coordinates, with their signs, add up to each angle") \
  X(INTEGERS, tree_angle_joint, MUST, ANY_IF(n_joint), WITHIN(1, n_joint), "these, by their bodies") \
  X(REALS, tree_angle_sign, MUST, n_summand, FINITE, "sign") \
  X(REALS, tree_angle_inertia, MUST, n_sum, FINITE, "inertia that turns with the angle, kg m²") \
  X(INTEGERS, tree_payload_body, MAY, IF_ANY(n_joint, n_payload), WITHIN(1, n_joint), "body of each payload") \
  X(REALS, tree_payload_place, MAY, IF_ANY(n_joint, 3 * n_payload), FINITE, \
    "place of each payload, m, axes of the body") \
  /* Assembly modes */ \
  X(INTEGERS, mode_triad_ptr, MAY, ANY, OFFSETS(mode_triad), "triads of a loop, at most 15") \
  X(INTEGERS, mode_triad, MAY, ANY, RELATED, \
    "per triad 9 signals (axis n, arms a and b), kind (bit 0: b is a line the body lies across, the angle counts " \
    "from its perpendicular; bit 1: n is z and the arms lie in the plane), number of its ring in the loop") \
  X(INTEGERS, mode_cell_ptr, MAY, n_mode_ptr, OFFSETS(mode_cell), \
    "modes of a loop; a loop without modes is watched for jumps only") \
  X(INTEGERS, mode_cell, MAY, ANY, BELOW(1 << 2 * ALI3_MAX_TRIADS), \
    "modes as pairs (signs, mask): bits 2k and 2k+1 say that sine and cosine of the angle of triad k are positive") \
  X(INTEGERS, mode_name_ptr, MAY, IF_ANY(n_mode_ptr, n_triad + 1), OFFSETS(mode_name), \
    "name of the joint of each triad") \
  X(INTEGERS, mode_name, MAY, ANY, WITHIN(1, 255), "bytes, UTF-8")

/* clang-format on */

/* Types of items, with their numbers in a file. */
enum { ALI3_INTEGERS = 1, ALI3_REALS, ALI3_BYTES };
#define ALI3_ITEM_INTEGERS int32_t
#define ALI3_ITEM_REALS double
#define ALI3_ITEM_BYTES unsigned char
#endif
