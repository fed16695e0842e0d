#pragma once

#include <stdexcept>
#include <string>

namespace squall {

/// The caller's fault: a scene, a setting, an argument or a state that cannot be used. Says what, the value, the
/// allowed range and what to do about it.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The machine's fault: a device that is missing, failed or ran out of memory.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace squall
