#pragma once

#include <string>
#include <vector>

#include "core/scene.h"

namespace squall::app {

/// Whether particles will pair up, which the support ratio decides: a sentence, or none.
std::vector<std::string> ratio_notes(const Scene& scene);

/// What an honest reader of the result must know about the scene: whether particles will pair up, how heavy the rain
/// and how large its drops really are. One sentence each.
std::vector<std::string> scene_notes(const Scene& scene);

/// The notes on stderr, unless quiet.
void print_notes(const std::vector<std::string>& notes, bool quiet);

}  // namespace squall::app
