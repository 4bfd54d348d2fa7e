#include "tb/support/choices.hpp"

#include "model/support/edit_distance.hpp"
#include "tb/support/errors.hpp"

#include <algorithm>

namespace quadrille::cli {
std::string nearest(std::string_view name, std::span<const std::string> choices) {
  const std::string* best = nullptr;
  std::size_t best_distance = std::max<std::size_t>(2, name.size() / 2) + 1;
  for (const std::string& choice : choices) {
    std::size_t distance = edit_distance(name, choice);
    if (!name.empty() && choice.find(name) != std::string::npos) distance = std::min<std::size_t>(distance, 1);
    if (distance < best_distance) best_distance = distance, best = &choice;
  }
  return best ? *best : std::string{};
}

std::size_t choose(std::string_view what, std::string_view name, std::span<const std::string> choices) {
  const auto found = std::find(choices.begin(), choices.end(), name);
  if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  std::string message = "unknown " + std::string(what) + " \"" + std::string(name) + "\"";
  if (const std::string near = nearest(name, choices); !near.empty()) message += "; did you mean \"" + near + "\"?";
  message += " (choices:";
  for (const std::string& choice : choices) message += " " + choice;
  throw UsageError(message + ")");
}

std::size_t choose(std::string_view what, std::string_view name, std::initializer_list<std::string_view> choices) {
  const std::vector<std::string> list(choices.begin(), choices.end());
  return choose(what, name, list);
}

}  // namespace quadrille::cli
