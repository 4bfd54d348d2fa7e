#include "tb/commands/cosim_result.hpp"

namespace quadrille::tb {

void InputResult::merge(const InputResult& part) {
  for (std::size_t i = 0; i < counted.size(); ++i) counted[i] += part.counted[i];
  counters += part.counters;
  alone_seconds += part.alone_seconds;
  seconds += part.seconds;
  loop_seconds += part.loop_seconds;
  complete = complete && part.complete;
  if (!first_divergence && part.first_divergence) first_divergence = part.name + ": " + *part.first_divergence;
  add_hash(part.fragment_hash);
  check.merge(part.check);
  skips.merge(part.skips);
  for (const std::string& text : part.beyond_limits) beyond_limits.push_back(part.name + ": " + text);
}

}  // namespace quadrille::tb
