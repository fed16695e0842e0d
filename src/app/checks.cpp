#include "app/checks.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace squall::app {

namespace {

std::optional<double> number_in(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

CLI::Validator not_empty() {
  return CLI::Validator([](std::string& text) { return std::string(text.empty() ? "a value is missing" : ""); }, "");
}

CLI::Validator positive() {
  const auto check = [](std::string& text) {
    const auto value = number_in(text);
    return value && *value > 0.0 && std::isfinite(*value)
               ? std::string()
               : fmt::format("'{}' is not allowed; give a finite number above 0", text);
  };
  return CLI::Validator(check, "");
}

CLI::Validator within(double low, double high) {
  const auto check = [low, high](std::string& text) {
    const auto value = number_in(text);
    return value && *value >= low && *value <= high
               ? std::string()
               : fmt::format("'{}' is not allowed; give a number in [{}, {}]", text, low, high);
  };
  return CLI::Validator(check, "");
}

CLI::Validator unsigned_number() {
  const auto check = [](std::string& text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size()
               ? std::string()
               : fmt::format("'{}' is not allowed; give a whole number in [0, {}]", text,
                             std::numeric_limits<std::uint64_t>::max());
  };
  return CLI::Validator(check, "");
}

}  // namespace squall::app
