#pragma once

#include <string>

#include "core/errors.h"

namespace squall::app {

/// Things to write that do not depend on each other: one that cannot be written does not keep the others from it.
class Attempts {
 public:
  template <class Function>
  void operator()(Function&& write) {
    try {
      write();
    } catch (const InputError& error) {
      problems_ += (problems_.empty() ? "" : "\n") + std::string(error.what());
    }
  }

  bool failed() const { return !problems_.empty(); }
  /// Throws InputError with everything that went wrong, if anything did.
  void finish() const {
    if (failed()) throw InputError(problems_);
  }

 private:
  std::string problems_;
};

}  // namespace squall::app
