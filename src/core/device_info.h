#pragma once

#include <string>

namespace squall {

/// A processor or device that a backend can run on.
struct DeviceInfo {
  std::string backend;  ///< "reference", "omp" or "opencl"
  int index = 0;        ///< what --device takes, for backends with several
  std::string name;
  std::string platform;  ///< OpenCL platform; empty otherwise
  std::string driver;
  std::string version;
  std::string kind;  ///< "cpu", "gpu", "accelerator"
  int compute_units = 0;
  std::string problem;     ///< why it cannot run; empty if it can
  std::string lacks;       ///< guarantees without which it is not bitwise: "denormals, fused multiply-add"; else empty
  bool has_double = true;  ///< computes in double precision, too, and then always promises the same bits
  bool bitwise = true;     ///< in single precision: promises the same bits as the others (FMA, denormals, correctly
                           ///< rounded divide and sqrt)
};

}  // namespace squall
