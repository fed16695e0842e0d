#pragma once

namespace squall::openmp {
namespace {
using Scalar = float;
}
}  // namespace squall::openmp

#include "backend_omp/scalar_pack.h"
