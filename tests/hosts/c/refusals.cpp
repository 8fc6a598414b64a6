// What the header refuses, a line each: refusals FOLDER_OF_AN_UNPACKED_FMU EMPTY_FOLDER
#include <cstdio>
#include <functional>
#include <limits>
#include <string>

#include "fmu.hpp"

static void refused(const std::function<void()> &act) {
  try {
    act();
    std::printf("nothing was refused\n");
  } catch (const std::exception &error) { std::printf("%s\n", error.what()); }
}

int main(int, char **argument) {
  namespace files = std::filesystem;
  fmu::Fmu car(argument[1]);
  refused([&] { fmu::Fmu none("nowhere"); });
  const files::path other = files::path(argument[2]) / "other", library = other / "binaries" / fmu::detail::PLATFORM;
  files::create_directories(library);
  files::copy_file(files::path(argument[1]) / "modelDescription.xml", other / "modelDescription.xml");
  refused([&] { fmu::Fmu none(other); });
  std::ofstream(library / (std::string("Prototype") + fmu::detail::SUFFIX)) << "no library";
  refused([&] { fmu::Fmu none(other); });
  std::ofstream(other / "modelDescription.xml")
      << "<fmiModelDescription fmiVersion='2.0'><CoSimulation modelIdentifier="
         "'a'/><ScalarVariable name='b' valueReference='c'/>";
  refused([&] { fmu::Fmu none(other); });
  refused([&] { car.set("stering", 1.0); });
  refused([&] { car.set("steering", "left"); });
  refused([&] { car.set("selector", 0.5); });
  refused([&] { car.set("road.file", 1.0); });
  refused([&] { car.references({"selector"}); });
  refused([&] { car.initialise({{"initial.speed", 1e9}}); });
  car.initialise({{"initial.speed", 10.0}});
  refused([&] { car.set("throttle", std::numeric_limits<double>::quiet_NaN()); });
  refused([&] { car.step(-1.0); });
  return 0;
}
