// Sets inputs at every communication point and prints all outputs after the step that follows, without a lost digit:
//
//   ports FOLDER_OF_AN_UNPACKED_FMU STEP START_SPEED
//
// The first line of what is read has the names of the inputs, each other one their values, or nothing: none is set.
#include <cstdio>
#include <iostream>
#include <string>

#include "fmu.hpp"

static std::vector<std::string> words_of(const std::string &line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

int main(int, char **argument) {
  try {
    fmu::Fmu car(argument[1], "car");
    std::vector<std::string> names;
    for (const auto &[name, variable] : car.variables())
      if (variable.causality == "output" && variable.type == "Real") names.push_back(name);
    const auto outputs = car.references(names);
    std::string line;
    std::getline(std::cin, line);
    const auto inputs = car.references(words_of(line));
    car.initialise({{"initial.speed", std::strtod(argument[3], nullptr)}});
    while (std::getline(std::cin, line)) {
      std::vector<double> values;
      for (const auto &word : words_of(line)) values.push_back(std::strtod(word.c_str(), nullptr));
      if (!values.empty()) car.set(inputs, values);
      car.step(std::strtod(argument[2], nullptr));
      for (const double value : car.get(outputs)) std::printf("%a ", value);
      std::printf("\n");
    }
    for (const auto &message : car.messages) std::fprintf(stderr, "%s\n", message.c_str());
  } catch (const std::exception &error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
  return 0;
}
