#include "core/same_place.h"

#include <algorithm>
#include <array>

namespace squall {

std::optional<std::pair<std::size_t, std::size_t>> same_place(const std::vector<Eigen::Vector3d>& positions,
                                                              std::size_t from) {
  using Place = std::pair<std::array<float, 3>, std::size_t>;
  std::vector<Place> places;
  places.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3f at = positions[i].cast<float>();
    places.push_back({{at.x(), at.y(), at.z()}, i});
  }
  std::sort(places.begin(), places.end());
  std::optional<std::pair<std::size_t, std::size_t>> first;
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
    if (places[i + 1].second >= from && places[i].first == places[i + 1].first &&
        (!first || places[i + 1].second < first->second))
      first = {places[i].second, places[i + 1].second};
  return first;
}

}  // namespace squall
