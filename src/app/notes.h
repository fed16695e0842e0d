#pragma once

#include <string>
#include <vector>

#include "core/scene.h"

namespace squall::app {

/// What an honest reader of the result must know about the scene: how heavy the rain and how large its drops really
/// are. One sentence each.
std::vector<std::string> scene_notes(const Scene& scene);

/// The notes on stderr, unless quiet.
void print_notes(const std::vector<std::string>& notes, bool quiet);

}  // namespace squall::app
