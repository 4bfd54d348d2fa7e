#include "tb/support/choices.hpp"

#include "model/support/edit_distance.hpp"
#include "tb/support/errors.hpp"

#include <algorithm>

namespace quadrille::tb {
std::size_t choose(std::string_view what, std::string_view name, std::span<const std::string> choices) {
  const auto found = std::find(choices.begin(), choices.end(), name);
  if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  std::string message = "unknown " + std::string(what) + " \"" + std::string(name) + "\"";
  message += did_you_mean(name, choices) + " (choices:";
  for (const std::string& choice : choices) message += " " + choice;
  throw UsageError(message + ")");
}

std::size_t choose(std::string_view what, std::string_view name, std::initializer_list<std::string_view> choices) {
  const std::vector<std::string> list(choices.begin(), choices.end());
  return choose(what, name, list);
}

}  // namespace quadrille::tb
