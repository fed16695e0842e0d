#pragma once

namespace squall::app {

/// Gives descriptors 0 to 2 that the caller closed a place that takes nothing, so that no file of ours gets their
/// number and, with it, what was meant for stdout. Call first.
void reserve_standard_streams();

/// Throws InputError if stdout did not take everything that was written to it.
void finish_stdout();

}  // namespace squall::app
