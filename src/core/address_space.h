#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace squall {

/// Address space [bytes] that `ulimit -v` leaves this process; empty where there is no such limit. Runtimes that start
/// threads or compile kernels end the process where it runs out: what they need is asked for before.
std::optional<std::uint64_t> address_space_left();

/// Why `what` cannot be had: it needs `bytes` of address space, and less is left. Empty if it can.
std::string address_space_problem(const std::string& what, std::uint64_t bytes);

}  // namespace squall
