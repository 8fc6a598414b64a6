// An FMU of FMI 2.0 for co-simulation as an object of C++17 or later, in one header. `drive.cpp` beside it is an example.
//
//   fmu::Fmu car("unpacked/Prototype");
//   car.initialise({{"initial.speed", 15.0}});
//   const auto out = car.references({"speed", "chassis.wz"});
//   car.set("steering", 0.1);
//   car.step(0.01);
//   const std::vector<double> now = car.get(out);
//
// It needs the headers of the FMI 2.0 standard and, on Linux, -ldl. What is refused is a std::runtime_error with a
// sentence; an FMU that refuses a step is fmu::StepRefused, and its state is the one before the step.
#ifndef ALI3_FMU_HPP
#define ALI3_FMU_HPP

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#if defined(_WIN32)
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include "fmi2FunctionTypes.h"

namespace fmu {

struct StepRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A variable as modelDescription.xml has it; its type is Real, Integer, Boolean, String or Enumeration.
struct Variable {
  fmi2ValueReference reference = 0;
  std::string type, causality = "local", variability = "continuous";
};

namespace detail {

#if defined(_WIN32)
constexpr const char *PLATFORM = "win64", *SUFFIX = ".dll";
#elif defined(__APPLE__)
constexpr const char *PLATFORM = "darwin64", *SUFFIX = ".dylib";
#elif defined(__aarch64__)
constexpr const char *PLATFORM = "aarch64-linux", *SUFFIX = ".so";
#else
constexpr const char *PLATFORM = "linux64", *SUFFIX = ".so";
#endif

// A shared library, closed with the object.
class Library {
public:
  explicit Library(const std::filesystem::path &file) {
    if (!std::filesystem::exists(file))
      throw std::runtime_error("The FMU has no library for " + std::string(PLATFORM) + ": " + file.string() +
                               " is not there.");
#if defined(_WIN32)
    handle = reinterpret_cast<void *>(LoadLibraryW(file.wstring().c_str()));
#else
    handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
#endif
    if (handle == nullptr) throw std::runtime_error(file.string() + " cannot be loaded: " + reason() + ".");
  }
  Library(const Library &) = delete;
  Library &operator=(const Library &) = delete;
  ~Library() {
#if defined(_WIN32)
    FreeLibrary(reinterpret_cast<HMODULE>(handle));
#else
    dlclose(handle);
#endif
  }
  template <class F> F *function(const char *name) const {
#if defined(_WIN32)
    void *found = reinterpret_cast<void *>(GetProcAddress(reinterpret_cast<HMODULE>(handle), name));
#else
    void *found = dlsym(handle, name);
#endif
    if (found == nullptr) throw std::runtime_error(std::string("The library of the FMU has no ") + name + ".");
    return reinterpret_cast<F *>(found);
  }

private:
  static std::string reason() {
#if defined(_WIN32)
    return "error " + std::to_string(GetLastError()) + " of Windows";
#else
    return dlerror();
#endif
  }
  void *handle;
};

// A tag of an XML text: its name and its attributes, entities replaced.
struct Tag {
  std::string name;
  std::map<std::string, std::string> attributes;
};

inline std::string unescaped(const std::string &text) {
  static const std::map<std::string, char> known = {
      {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
  std::string out;
  for (std::size_t i = 0; i < text.size(); i++) {
    const std::size_t end = text[i] == '&' ? text.find(';', i) : std::string::npos;
    const auto found = end == std::string::npos ? known.end() : known.find(text.substr(i + 1, end - i - 1));
    if (found == known.end()) {
      out += text[i];
    } else {
      out += found->second;
      i = end;
    }
  }
  return out;
}

// All tags that begin an element, in their order.
inline std::vector<Tag> tags_of(const std::string &xml) {
  std::vector<Tag> tags;
  const char *const blank = " \t\r\n";
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at)) {
    if (xml.compare(at, 4, "<!--") == 0) {
      at = xml.find("-->", at);
      continue;
    }
    at++;
    if (at >= xml.size() || xml[at] == '/' || xml[at] == '!' || xml[at] == '?') continue;
    const std::size_t end = xml.find_first_of(" \t\r\n/>", at);
    if (end == std::string::npos) break;
    Tag tag{xml.substr(at, end - at), {}};
    for (at = xml.find_first_not_of(blank, end); at < xml.size() && xml[at] != '>' && xml[at] != '/';) {
      const std::size_t equals = xml.find('=', at);
      const std::size_t open = equals == std::string::npos ? equals : xml.find_first_of("\"'", equals);
      const std::size_t close = open == std::string::npos ? open : xml.find(xml[open], open + 1);
      if (close == std::string::npos) throw std::runtime_error("modelDescription.xml ends within a tag.");
      const std::string key = xml.substr(at, xml.find_first_of(" \t\r\n=", at) - at);
      tag.attributes[key] = unescaped(xml.substr(open + 1, close - open - 1));
      at = xml.find_first_not_of(blank, close + 1);
    }
    tags.push_back(std::move(tag));
  }
  return tags;
}

inline std::string uri_of(const std::filesystem::path &folder) {
  const auto utf8 = std::filesystem::absolute(folder).generic_u8string(); // of char8_t from C++20 on
  const std::string path(utf8.begin(), utf8.end());
  std::string uri = path.empty() || path[0] != '/' ? "file:///" : "file://";
  for (const char c : path) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       std::string("/:-_.~").find(c) != std::string::npos;
    char code[4];
    std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned char>(c));
    uri += plain ? std::string(1, c) : code;
  }
  return uri;
}

inline fmi2ValueReference reference_of(const std::string &text, const std::string &name) {
  char *end = nullptr;
  const unsigned long long number = std::strtoull(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || number > std::numeric_limits<fmi2ValueReference>::max())
    throw std::runtime_error("modelDescription.xml is damaged: '" + name + "' has the valueReference '" + text +
                             "', which must be a whole number below 2^32.");
  return static_cast<fmi2ValueReference>(number);
}

} // namespace detail

// An instance of the FMU in an unpacked folder. It may not be copied or moved, as the FMU knows its address.
class Fmu {
public:
  using Start = std::vector<std::pair<std::string, double>>;

  explicit Fmu(const std::filesystem::path &folder, const std::string &name = "fmu") {
    const auto file = folder / "modelDescription.xml";
    std::ifstream stream(file, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    if (!stream || text.str().empty()) throw std::runtime_error(file.string() + " cannot be read.");
    read(detail::tags_of(text.str()));
    if (model.empty()) throw std::runtime_error(file.string() + " is of no FMU of FMI 2.0 for co-simulation.");
    library = std::make_unique<detail::Library>(folder / "binaries" / detail::PLATFORM / (model + detail::SUFFIX));
    find_functions();
    const std::string resources = detail::uri_of(folder / "resources");
    component =
        instantiate(name.c_str(), fmi2CoSimulation, guid.c_str(), resources.c_str(), &callbacks, fmi2False, fmi2False);
    if (component == nullptr) throw std::runtime_error("The FMU made no instance." + last_message(0));
  }
  Fmu(const Fmu &) = delete;
  Fmu &operator=(const Fmu &) = delete;
  ~Fmu() { release(component); }

  // What the FMU said.
  std::vector<std::string> messages;

  double time() const { return now; }
  const std::map<std::string, Variable> &variables() const { return known; }

  const Variable &variable(const std::string &name) const {
    const auto found = known.find(name);
    if (found == known.end()) throw std::runtime_error("The FMU has no variable '" + name + "'.");
    return found->second;
  }

  // References of real variables, for `get` and `set`.
  std::vector<fmi2ValueReference> references(const std::vector<std::string> &names) const {
    std::vector<fmi2ValueReference> found;
    for (const auto &name : names) {
      if (variable(name).type != "Real")
        throw std::runtime_error("'" + name + "' is not a Real, but " + variable(name).type + ".");
      found.push_back(variable(name).reference);
    }
    return found;
  }

  // A start at the time 0 with values of parameters and inputs; once more after steps, too.
  void initialise(const Start &start = {}) {
    if (used) good(reset_instance(component), "fmi2Reset");
    used = true;
    now = 0.0;
    good(setup(component, fmi2False, 0.0, 0.0, fmi2False, 0.0), "fmi2SetupExperiment");
    for (const auto &[name, value] : start) set(name, value);
    good(enter(component), "fmi2EnterInitializationMode");
    good(leave(component), "fmi2ExitInitializationMode");
  }

  // A number of any type: of an Integer or Enumeration a whole one, of a Boolean 0 or 1.
  void set(const std::string &name, double value) {
    const Variable &v = variable(name);
    fmi2Status status = fmi2Error;
    if (v.type == "Real") {
      status = set_real(component, &v.reference, 1, &value);
    } else if (v.type == "String") {
      throw std::runtime_error("'" + name + "' is a String; it must be set with a text.");
    } else {
      const bool boolean = v.type == "Boolean";
      if (!(std::abs(value) < 2147483648.0) || std::floor(value) != value || (boolean && value != 0.0 && value != 1.0))
        throw std::runtime_error("'" + name + "' is " + std::to_string(value) + "; it must be " +
                                 (boolean ? "0 or 1." : "a whole number."));
      const int whole = static_cast<int>(value);
      status =
          boolean ? set_boolean(component, &v.reference, 1, &whole) : set_integer(component, &v.reference, 1, &whole);
    }
    good(status, "'" + name + "'");
  }

  void set(const std::string &name, const std::string &text) {
    const Variable &v = variable(name);
    if (v.type != "String") throw std::runtime_error("'" + name + "' is not a String, but " + v.type + ".");
    const char *value = text.c_str();
    good(set_string(component, &v.reference, 1, &value), "'" + name + "'");
  }

  void set(const std::vector<fmi2ValueReference> &which, const std::vector<double> &values) {
    if (which.size() != values.size()) throw std::runtime_error("There are not as many values as references.");
    good(set_real(component, which.data(), which.size(), values.data()), "fmi2SetReal");
  }

  // A Real, an Integer, an Enumeration or a Boolean as a number.
  double get(const std::string &name) {
    const Variable &v = variable(name);
    if (v.type == "String") throw std::runtime_error("'" + name + "' is a String, no number.");
    if (v.type == "Real") return get(std::vector<fmi2ValueReference>{v.reference})[0];
    int whole = 0;
    good(v.type == "Boolean" ? get_boolean(component, &v.reference, 1, &whole)
                             : get_integer(component, &v.reference, 1, &whole),
         "'" + name + "'");
    return whole;
  }

  std::vector<double> get(const std::vector<fmi2ValueReference> &which) {
    std::vector<double> values(which.size());
    good(get_real(component, which.data(), which.size(), values.data()), "fmi2GetReal");
    return values;
  }

  // A communication step, s.
  void step(double length) {
    try {
      good(do_step(component, now, length, fmi2True), "The step from " + std::to_string(now) + " s");
    } catch (const std::runtime_error &error) { throw StepRefused(error.what()); }
    now += length;
  }

  // The state of the instance, freed with the object, which must not outlive the instance.
  class State {
  public:
    State(const State &) = delete;
    State &operator=(const State &) = delete;
    ~State() { owner.free_state(owner.component, &state); }

  private:
    friend class Fmu;
    explicit State(Fmu &fmu) : owner(fmu), time(fmu.now) {
      fmu.good(fmu.get_state(fmu.component, &state), "fmi2GetFMUstate");
    }
    Fmu &owner;
    double time;
    fmi2FMUstate state = nullptr;
  };

  std::unique_ptr<State> save() { return std::unique_ptr<State>(new State(*this)); }

  void restore(const State &saved) {
    good(set_state(component, saved.state), "fmi2SetFMUstate");
    now = saved.time;
  }

private:
  static void say(fmi2ComponentEnvironment environment, fmi2String, fmi2Status, fmi2String, fmi2String format, ...) {
    char text[4096];
    va_list list;
    va_start(list, format);
    std::vsnprintf(text, sizeof text, format, list);
    va_end(list);
    static_cast<Fmu *>(environment)->messages.emplace_back(text);
  }

  void read(const std::vector<detail::Tag> &tags) {
    std::string name;
    for (const auto &tag : tags) {
      const auto value = [&tag](const char *key, const std::string &otherwise) {
        const auto found = tag.attributes.find(key);
        return found == tag.attributes.end() ? otherwise : found->second;
      };
      if (tag.name == "fmiModelDescription" && value("fmiVersion", "") == "2.0") guid = value("guid", "");
      if (tag.name == "CoSimulation" && !guid.empty()) model = value("modelIdentifier", "");
      if (tag.name == "ScalarVariable") {
        name = value("name", "");
        known[name] = {detail::reference_of(value("valueReference", ""), name), "", value("causality", "local"),
                       value("variability", "continuous")};
      } else if (!name.empty() && known[name].type.empty() &&
                 (tag.name == "Real" || tag.name == "Integer" || tag.name == "Boolean" || tag.name == "String" ||
                  tag.name == "Enumeration")) {
        known[name].type = tag.name;
      }
    }
  }

  void find_functions() {
    const auto find = [this](auto *&pointer, const char *name) {
      pointer = library->function<std::remove_reference_t<decltype(*pointer)>>(name);
    };
    find(instantiate, "fmi2Instantiate");
    find(release, "fmi2FreeInstance");
    find(reset_instance, "fmi2Reset");
    find(setup, "fmi2SetupExperiment");
    find(enter, "fmi2EnterInitializationMode");
    find(leave, "fmi2ExitInitializationMode");
    find(do_step, "fmi2DoStep");
    find(get_real, "fmi2GetReal");
    find(set_real, "fmi2SetReal");
    find(get_integer, "fmi2GetInteger");
    find(set_integer, "fmi2SetInteger");
    find(get_boolean, "fmi2GetBoolean");
    find(set_boolean, "fmi2SetBoolean");
    find(set_string, "fmi2SetString");
    find(get_state, "fmi2GetFMUstate");
    find(set_state, "fmi2SetFMUstate");
    find(free_state, "fmi2FreeFMUstate");
  }

  std::string last_message(std::size_t before) const { return messages.size() > before ? " " + messages.back() : ""; }

  // After each call: a refusal is an exception, with what the FMU said in the call.
  void good(fmi2Status status, const std::string &what) {
    const std::string words = last_message(told);
    told = messages.size();
    if (status > fmi2Warning) throw std::runtime_error(what + " was refused." + words);
  }

  std::unique_ptr<detail::Library> library; // outlives the instance
  std::map<std::string, Variable> known;
  std::string guid, model;
  double now = 0.0;
  bool used = false;
  std::size_t told = 0;
  const fmi2CallbackFunctions callbacks{say, std::calloc, std::free, nullptr, this};
  fmi2Component component = nullptr;
  fmi2InstantiateTYPE *instantiate = nullptr;
  fmi2FreeInstanceTYPE *release = nullptr;
  fmi2ResetTYPE *reset_instance = nullptr;
  fmi2SetupExperimentTYPE *setup = nullptr;
  fmi2EnterInitializationModeTYPE *enter = nullptr;
  fmi2ExitInitializationModeTYPE *leave = nullptr;
  fmi2DoStepTYPE *do_step = nullptr;
  fmi2GetRealTYPE *get_real = nullptr;
  fmi2SetRealTYPE *set_real = nullptr;
  fmi2GetIntegerTYPE *get_integer = nullptr;
  fmi2SetIntegerTYPE *set_integer = nullptr;
  fmi2GetBooleanTYPE *get_boolean = nullptr;
  fmi2SetBooleanTYPE *set_boolean = nullptr;
  fmi2SetStringTYPE *set_string = nullptr;
  fmi2GetFMUstateTYPE *get_state = nullptr;
  fmi2SetFMUstateTYPE *set_state = nullptr;
  fmi2FreeFMUstateTYPE *free_state = nullptr;
};

} // namespace fmu

#endif
