#include "core/settings.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

#include "core/errors.h"

namespace squall {
namespace {

template <class Choice>
struct Name {
  Choice choice;
  const char* text;
};

constexpr std::array k_pressures{Name<Pressure>{Pressure::mueller, "mueller"}, Name<Pressure>{Pressure::wcsph, "wcsph"},
                                 Name<Pressure>{Pressure::dfsph, "dfsph"}};
constexpr std::array k_precisions{Name<Precision>{Precision::single_precision, "single"},
                                  Name<Precision>{Precision::double_precision, "double"}};
constexpr std::array k_simds{Name<Simd>{Simd::best, "best"}, Name<Simd>{Simd::scalar, "scalar"},
                             Name<Simd>{Simd::avx2, "avx2"}, Name<Simd>{Simd::avx512, "avx512"}};
constexpr std::array k_readbacks{
    Name<Readback>{Readback::none, "none"},     Name<Readback>{Readback::blocking, "blocking"},
    Name<Readback>{Readback::pinned, "pinned"}, Name<Readback>{Readback::mapped, "mapped"},
    Name<Readback>{Readback::async, "async"},   Name<Readback>{Readback::quantized, "quantized"}};

template <class Choice, std::size_t count>
const char* text_of(Choice choice, const std::array<Name<Choice>, count>& names) {
  for (const auto& name : names)
    if (name.choice == choice) return name.text;
  return "?";
}

/// `planned` are names of what a later version will have.
template <class Choice, std::size_t count>
Choice choice_of(const std::string& text, const std::array<Name<Choice>, count>& names, const std::string& what,
                 std::initializer_list<std::string_view> planned) {
  std::string valid;
  for (const auto& name : names) {
    if (text == name.text) return name.choice;
    valid += (valid.empty() ? "" : ", ") + std::string(name.text);
  }
  const bool later = std::find(planned.begin(), planned.end(), text) != planned.end();
  throw InputError(what + " '" + text + "' " + (later ? "is not in this version" : "is not known") +
                   "; valid names: " + valid);
}

}  // namespace

void check(const WorkSizes& work) {
  const auto require = [](bool legal, const char* name, int value, const char* range) {
    if (!legal)
      throw InputError("work size " + std::string(name) + " is " + std::to_string(value) + "; legal are 0 and " +
                       range);
  };
  const bool power_of_two = work.group > 0 && (work.group & (work.group - 1)) == 0;
  require(work.group == 0 || (power_of_two && work.group >= 16 && work.group <= 1024), "group", work.group,
          "powers of two from 16 to 1024");
  require(work.parts >= 0 && work.parts <= 64, "parts", work.parts, "1 to 64");
  require(work.chunks >= 0 && work.chunks <= 64, "chunks", work.chunks, "1 to 64");
}

const char* to_string(Pressure pressure) { return text_of(pressure, k_pressures); }
const char* to_string(Precision precision) { return text_of(precision, k_precisions); }
const char* to_string(Simd simd) { return text_of(simd, k_simds); }
const char* to_string(Readback readback) { return text_of(readback, k_readbacks); }

Pressure pressure_from_text(const std::string& text) { return choice_of(text, k_pressures, "pressure", {}); }
Precision precision_from_text(const std::string& text) { return choice_of(text, k_precisions, "precision", {}); }
Simd simd_from_text(const std::string& text) { return choice_of(text, k_simds, "simd", {}); }
Readback readback_from_text(const std::string& text) { return choice_of(text, k_readbacks, "readback", {}); }

}  // namespace squall
