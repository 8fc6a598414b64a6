/* The types of force elements: the only list of them, which defines their declarations, the table in elements.c and
 * `ElementType` in Python. A number is part of the System file and never changes its meaning. */
#ifndef ALI3_ELEMENT_TYPES_H
#define ALI3_ELEMENT_TYPES_H

/* number, name: ali3_name in name.c says what the element is */
/* clang-format off */
#define ALI3_ELEMENT_TYPES(X) \
  X(1, spring_damper) \
  X(2, scalar_spring_damper) \
  X(3, input_force) \
  X(4, body_force) \
  X(5, body_torque) \
  X(6, gyroscopic_spin) \
  X(7, drag) \
  X(8, tyre) \
  X(9, brake) \
  X(10, automatic_drive) \
  X(11, contact_points) \
  X(12, spin_torque) \
  X(13, electric_drive) \
  X(14, spring_damper_table) \
  X(15, lift) \
  X(16, coordinate_friction) \
  X(17, torsion_bar) \
  X(18, spin_angle) \
  X(19, magic_tyre) \
  X(20, wind_drag) \
  X(21, hub_wrench)
/* clang-format on */
#endif
