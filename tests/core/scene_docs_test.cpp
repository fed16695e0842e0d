#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "core/scene.h"
#include "core/scene_keys.h"

namespace {

using squall::Scene;
using testing::HasSubstr;

std::string documentation() {
  std::ifstream file(std::string(SQUALL_SCENES_DIR) + "/../docs/scenes.md");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(SceneDocumentation, NamesEverySectionAndKey) {
  const std::string text = documentation();
  Scene scene;  // one of everything
  scene.container.motions.emplace_back();
  scene.boxes.emplace_back();
  scene.blocks.emplace_back();
  scene.particle_files.emplace_back();
  scene.rains.emplace_back();
  scene.gauges.emplace_back();
  int keys = 0;
  squall::scene_keys::visit_sections(scene, [&](const squall::scene_keys::SectionName& name, auto& section) {
    EXPECT_THAT(text, HasSubstr("[" + name.table + "]"));
    squall::scene_keys::visit_keys(section, [&](const std::string& key, auto&, squall::scene_keys::KeyRule) {
      EXPECT_THAT(text, HasSubstr("`" + key + "`")) << "in " << name.text();
      ++keys;
    });
  });
  EXPECT_GT(keys, 40);
}

TEST(SceneDocumentation, ShowsASceneThatCanBeRead) {
  const std::string text = documentation();
  const std::size_t begin = text.find("```toml\n");
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = text.find("```", begin + 3);
  const Scene scene = squall::parse_scene(text.substr(begin + 8, end - begin - 8), "docs/scenes.md");
  EXPECT_EQ(initial_particles(scene).size(), 10u * 20u * 20u);
}

}  // namespace
