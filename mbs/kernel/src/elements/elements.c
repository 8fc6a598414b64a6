/* The table of element types. */
#include <stddef.h>

#include "element.h"

extern const ali3_element_type ali3_spring_damper, ali3_scalar_spring_damper, ali3_input_force, ali3_body_force,
    ali3_body_torque, ali3_gyroscopic_spin, ali3_drag, ali3_tyre, ali3_brake, ali3_automatic_drive, ali3_contact_points,
    ali3_spin_torque;

const ali3_element_type *ali3_element_type_get(int32_t type) {
  switch (type) {
  case ALI3_SPRING_DAMPER:
    return &ali3_spring_damper;
  case ALI3_SCALAR_SPRING_DAMPER:
    return &ali3_scalar_spring_damper;
  case ALI3_INPUT_FORCE:
    return &ali3_input_force;
  case ALI3_BODY_FORCE:
    return &ali3_body_force;
  case ALI3_BODY_TORQUE:
    return &ali3_body_torque;
  case ALI3_GYROSCOPIC_SPIN:
    return &ali3_gyroscopic_spin;
  case ALI3_DRAG:
    return &ali3_drag;
  case ALI3_TYRE:
    return &ali3_tyre;
  case ALI3_BRAKE:
    return &ali3_brake;
  case ALI3_AUTOMATIC_DRIVE:
    return &ali3_automatic_drive;
  case ALI3_CONTACT_POINTS:
    return &ali3_contact_points;
  case ALI3_SPIN_TORQUE:
    return &ali3_spin_torque;
  default:
    return NULL;
  }
}
