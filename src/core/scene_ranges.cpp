#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "core/errors.h"
#include "core/scene.h"
#include "core/scene_keys.h"

namespace squall::scene_keys {
namespace {

/// Holds the value of each key of a section against its rule; an overload for each type that a key can have.
class RangeCheck {
 public:
  RangeCheck(const SectionName& section, const Locate& locate) : section_(section), locate_(locate) {}

  void operator()(const char* key, double value, KeyRule rule) const {
    if (value >= rule.low && value <= rule.high) return;  // false for NaN
    const std::string highest = std::isinf(rule.high) ? " or more" : " to " + number_text(rule.high);
    fail(key, std::string(key) + " = " + number_text(value) + " in " + section_.text() +
                  " is out of range; allowed is " + number_text(rule.low) + highest);
  }
  void operator()(const char* key, int value, KeyRule rule) const { (*this)(key, static_cast<double>(value), rule); }
  void operator()(const char* key, std::int64_t value, KeyRule rule) const {
    (*this)(key, static_cast<double>(value), rule);
  }
  template <int size>
  void operator()(const char* key, const Eigen::Matrix<double, size, 1>& vector, KeyRule rule) const {
    for (int axis = 0; axis < size; ++axis) (*this)(key, vector[axis], rule);
  }
  void operator()(const char* key, const std::string& text, KeyRule) const {
    if (text.empty()) fail(key, std::string(key) + " in " + section_.text() + " is empty");
  }
  void operator()(const char*, bool, KeyRule) const {}
  void operator()(const char*, Pressure, KeyRule) const {}
  template <class Value>
  void operator()(const char* key, const std::optional<Value>& value, KeyRule rule) const {
    if (value) (*this)(key, *value, rule);
  }

 private:
  [[noreturn]] void fail(const char* key, const std::string& what) const {
    throw InputError(locate_(section_, key) + what);
  }

  const SectionName& section_;
  const Locate& locate_;
};

}  // namespace

void check_ranges(const Scene& scene, const Locate& locate) {
  visit_sections(scene,
                 [&](const SectionName& name, const auto& section) { visit_keys(section, RangeCheck(name, locate)); });
}

}  // namespace squall::scene_keys
