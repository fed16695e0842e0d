#pragma once

#include <CLI/CLI.hpp>

namespace squall::app {

/// Checks of an option's text, made before it becomes a number. Their messages follow the option's name.
CLI::Validator not_empty();
/// A finite number above 0.
CLI::Validator positive();
/// A number in [low, high].
CLI::Validator within(double low, double high);
/// A whole number of 64 bits without sign; the parser itself would wrap what does not fit.
CLI::Validator unsigned_number();

}  // namespace squall::app
