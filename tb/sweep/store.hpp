// The directory of a sweep while it grows: finished batches go to a journal at once, so that an interrupted sweep goes
// on where it stopped.
//
// journal.jsonl: the first line is the sweep's identity, every further line one batch; each line is {"crc": CRC-32 of
// the dump of the rest, …}. A last line without its end was being written when the sweep was interrupted, and is
// dropped; any other damage is refused.
#pragma once

#include "tb/sweep/evaluator.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace quadrille::sweep {

class Store {
 public:
  enum class Existing {
    resume,  ///< take over the results of a sweep of the same identity
    discard  ///< start over
  };

  /// Opens or creates `directory`, for one writer at a time. `identity`: everything that the results depend on. Throws
  /// golden::InputError with the file and the reason: the directory holds another sweep, the journal is damaged (line
  /// named), nothing can be written.
  Store(std::filesystem::path directory, nlohmann::ordered_json identity, Existing existing);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Results by row, those of earlier runs included.
  const std::map<std::size_t, PointResult>& results() const { return results_; }
  /// Seconds and number of points of each batch.
  struct Timing {
    std::string what;
    std::size_t points = 0;
    double seconds = 0;
  };
  const std::vector<Timing>& timings() const { return timings_; }
  void add_timing(Timing timing) { timings_.push_back(std::move(timing)); }
  /// Sum over all batches. Truths that a resumed run computes again for a batch of its own count again.
  const StageCounters& counters() const { return counters_; }

  /// Adds a batch whose points are rows[batch.points[i]]; on the disk when it returns. When the disk is full the
  /// journal is cut back to its last whole line and InputError thrown: what was finished stays.
  void append(const Batch& batch, std::span<const std::size_t> rows);

  /// Takes over the points of another directory of the same identity that this one lacks, and what they took. Throws
  /// golden::InputError as the constructor does, and where a point is there with another result.
  void merge(const std::filesystem::path& shard);

  /// Path of a file of the sweep.
  std::string file(std::string_view name) const { return (directory_ / name).string(); }

 private:
  std::string journal() const { return file("journal.jsonl"); }
  void read_journal();
  void discard();
  void take(const nlohmann::json& line);
  void write_line(const nlohmann::ordered_json& content);

  std::filesystem::path directory_;
  nlohmann::ordered_json identity_;
  std::map<std::size_t, PointResult> results_;
  std::vector<Timing> timings_;
  StageCounters counters_;
  std::uint64_t length_ = 0;  ///< of the journal's whole lines
  int fd_ = -1;
};

}  // namespace quadrille::sweep
