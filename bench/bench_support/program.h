#pragma once

#include <functional>

#include "bench_support/cases.h"

namespace squall::bench {

/// main() of a benchmark program: --smoke, --quick or --full (the default) beside Google Benchmark's own flags, which
/// win; squall's context in the output; then what `add_rows` registers, repeated in random order. Exit code 1 if a row
/// ended in an error (`has_failed`), 2 for a wrong flag.
int run_program(int argc, char** argv, const std::function<void(Effort)>& add_rows,
                const std::function<bool()>& has_failed);

}  // namespace squall::bench
