// A game loop in miniature: water that a program made up itself, advanced frame by frame, positions read where they
// lie.

#include <cstdio>
#include <exception>

#include "backends.h"

namespace {

/// A column of water in the left half of a tank of 0.4 x 0.3 x 0.2 m.
squall::Scene make_scene() {
  squall::Scene scene;
  scene.time.duration_s = 0.5;
  scene.fluid.spacing_m = 0.02;
  scene.container.max_m = {0.4, 0.3, 0.2};
  scene.container.open_top = true;
  scene.blocks.push_back({{0.0, 0.0, 0.0}, {0.2, 0.2, 0.2}});
  return scene;
}

/// x of the water's front [m]: what a game might ask.
float front_of(const squall::PositionsView& view) {
  float front = 0.0f;
  for (std::size_t i = 0; i < view.count; ++i) {
    const float x = view.position(i).x();
    if (x > front && !view.lost(i)) front = x;
  }
  return front;
}

}  // namespace

int main(int argc, char** argv) try {
  const auto solver = squall::make_solver(argc > 1 ? argv[1] : "omp", make_scene(), squall::Settings{});
  for (int frame = 0; frame < 30; ++frame) {
    const squall::FrameReport& report = solver->advance();
    if (frame % 10 == 9)
      std::printf("frame %d: %.2f ms, %d sub-steps, front at %.3f m\n", frame + 1, report.frame_ms, report.substeps,
                  static_cast<double>(front_of(solver->positions())));
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "embed: %s\n", error.what());
  return 1;
}
