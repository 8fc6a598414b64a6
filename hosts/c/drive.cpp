// Drives a car by two proportional controllers for five seconds, as docs/stepping.md does in Python.
//
//   drive FOLDER_OF_AN_UNPACKED_FMU
//
// Prints speed and yaw rate at the end, and both as hexadecimal numbers, so that no digit is lost.
#include <algorithm>
#include <cstdio>
#include <exception>

#include "fmu.hpp"

int main(int count, char **argument) {
  if (count != 2) {
    std::fprintf(stderr, "usage: %s FOLDER_OF_AN_UNPACKED_FMU\n", argument[0]);
    return 1;
  }
  try {
    fmu::Fmu car(argument[1], "car");
    car.initialise({{"initial.speed", 15.0}, {"selector", 1}});
    const auto inputs = car.references({"steering", "throttle"}), outputs = car.references({"speed", "chassis.wz"});
    std::unique_ptr<fmu::Fmu::State> saved;
    for (int pass = 0; pass < 2; pass++) { // the second half is driven twice
      for (int k = pass == 0 ? 0 : 250; k < 500; k++) {
        if (k == 250 && pass == 0) saved = car.save();
        const auto now = car.get(outputs);
        car.set(inputs, {2.0 * (0.3 - now[1]), std::max(0.0, 0.5 * (15.0 - now[0]))});
        car.step(0.01);
      }
      const auto end = car.get(outputs);
      std::printf("after %g s %.3f m/s, yaw rate %.4f rad/s\n%a %a\n", car.time(), end[0], end[1], end[0], end[1]);
      if (pass == 0) car.restore(*saved);
    }
    for (const auto &message : car.messages) std::fprintf(stderr, "%s\n", message.c_str());
  } catch (const std::exception &error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
  return 0;
}
