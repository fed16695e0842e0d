#include <fmt/format.h>

#include <iostream>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/result_output.h"
#include "app/table.h"
#include "backends.h"

namespace squall::app {

namespace {

std::string devices_text(const std::vector<BackendInfo>& backends) {
  Table table({"backend", "device", "name", "platform", "kind", "units", "driver", "double", "same bits"}, true);
  std::string problems;
  for (const auto& backend : backends) {
    if (!backend.problem.empty()) problems += fmt::format("{}: {}\n", backend.name, backend.problem);
    if (backend.devices.empty()) table.add_free(backend.name, "cannot run here");
    for (const auto& device : backend.devices) {
      const bool runs = device.problem.empty();
      table.add({backend.name, std::to_string(device.index), device.name, device.platform, device.kind,
                 std::to_string(device.compute_units), device.driver, device.has_double ? "yes" : "no",
                 !runs            ? "cannot run"
                 : device.bitwise ? "yes"
                                  : "no"});
      if (runs && !device.lacks.empty())
        problems += fmt::format("{} {}: not the same bits for want of {}\n", backend.name, device.index, device.lacks);
      if (!runs) problems += fmt::format("{} {}: {}\n", backend.name, device.index, device.problem);
    }
  }
  return table.text() + (problems.empty() ? "" : "\n" + problems);
}

harness::Json devices_json(const std::vector<BackendInfo>& backends) {
  harness::Json json;
  json["schema"] = harness::k_result_schema;
  json["context"] = harness::to_json(harness::collect_context());
  json["backends"] = harness::Json::array();
  for (const auto& backend : backends) {
    harness::Json entry{{"name", backend.name}, {"built", backend.built}, {"problem", backend.problem}};
    entry["devices"] = harness::Json::array();
    for (const auto& device : backend.devices) entry["devices"].push_back(harness::to_json(device));
    json["backends"].push_back(entry);
  }
  return json;
}

}  // namespace

int command_devices(const Options& options) {
  const auto backends = list_backends();
  if (!options.json_alone()) std::cout << devices_text(backends) << std::flush;
  write_json(options, devices_json(backends));
  return k_exit_fine;
}

}  // namespace squall::app
