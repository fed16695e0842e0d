#pragma once

namespace squall::openmp {
namespace {
using Scalar = double;
}
}  // namespace squall::openmp

#include "backend_omp/scalar_pack.h"
