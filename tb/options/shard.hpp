// A part of a command's work, for several machines: --shard I/N, and the arguments by which shards know each other.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace quadrille::tb {

/// Part `index` of `count`, 0 <= index < count. The parts together are all of the work, each unit in one of them.
struct Shard {
  std::size_t index = 0, count = 1;

  /// From "I/N"; throws UsageError naming --shard otherwise. Empty: the whole.
  static Shard parse(const std::string& text);

  bool is_part() const { return count > 1; }
  /// Units index, index + count, …: for units of unequal length.
  bool holds(std::size_t unit) const { return unit % count == index; }
  /// [first, last) of `units` that lie together: for units that share work with their neighbours.
  std::pair<std::size_t, std::size_t> range(std::size_t units) const {
    return {units / count * index + units % count * index / count,
            units / count * (index + 1) + units % count * (index + 1) / count};
  }
};

/// --shard and --merge of a command. `what`: the units, `part`: what --merge takes of each shard.
struct ShardOptions {
  std::string shard;
  std::vector<std::string> merge;

  void add_to(CLI::App& app, const std::string& what, const std::string& part);
};

/// The arguments without those that results do not depend on: where they go, how many threads, which shard. Reports
/// that shards are merged into name their command so.
std::vector<std::string> without_outputs(std::span<const std::string> arguments);

}  // namespace quadrille::tb
