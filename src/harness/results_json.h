#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/agreement.h"
#include "harness/context.h"
#include "harness/row.h"

namespace squall::harness {

using Json = nlohmann::ordered_json;

inline constexpr int k_result_schema = 1;

/// What a result says about its scene.
struct SceneInfo {
  std::string name;
  std::string hash;            ///< 16 hex digits
  std::int64_t particles = 0;  ///< at the start plus all that rain may add
};

/// The shape that every measuring command writes (docs/results.md): {schema, context, scene, runs, agreement}. No
/// number is infinite or NaN: such a value is null. An error row has no measured numbers, but `error`; a run
/// that ended before its planned frames says `interrupted`, and without counted frames it has no numbers either.
Json to_json(const Context& context, const SceneInfo& scene, const std::vector<Row>& rows,
             const std::optional<Agreement>& agreement);

Json to_json(const Context& context);
Json to_json(const DeviceInfo& device);
/// One entry of `runs`.
Json to_json(const Row& row);
/// `agreement`; null without one.
Json to_json(const std::optional<Agreement>& agreement);

/// JSON as a file: two spaces of indentation; text that is not UTF-8, like the name of a scene's file, is replaced.
std::string json_text(const Json& json);

/// The shape that Google Benchmark's tools/compare.py reads: one benchmark per row, real_time the median frame.
Json to_google_benchmark(const Context& context, const SceneInfo& scene, const std::vector<Row>& rows);

/// Name of the read-back mode a row used: backends in host memory deliver in place.
std::string readback_name(const Row& row);

}  // namespace squall::harness
