// The suites: what each can write and check, and the list of them.
#pragma once

#include "golden/vectors/manifest.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::vectors {

struct GenerateOptions {
  int level = 1;  ///< 1: seconds, 2: about sixty times as much
  std::uint64_t seed = 1;
  Config config;
  /// About this many vectors of a suite; a draw of the machine ends with the quad that reaches its share. 0: the
  /// level's number.
  std::uint64_t limit = 0;
  unsigned threads = 1;  ///< the bytes do not depend on it
};

/// The largest GenerateOptions::limit: more than level 2 has, and what fits in memory.
inline constexpr std::uint64_t largest_limit = 1'000'000;

/// One vector, compared.
struct VectorOutcome {
  enum class Kind { match, mismatch, undefined } kind = Kind::match;
  std::string difference;  ///< of a mismatch
};

/// What a check found.
struct VerifyResult {
  std::uint64_t vectors = 0;     ///< compared
  std::uint64_t mismatches = 0;  ///< of these, different
  std::uint64_t undefined = 0;   ///< of these, with a field that the engine cannot judge (float only)
  std::string first_difference;  ///< "file:line: field: expected …, actual …"

  /// Something was compared; a suite of which nothing was proves nothing.
  bool judged() const { return vectors > 0; }
  bool ok() const { return judged() && mismatches == 0; }

  /// Counts the vector of line `line` of the responses.
  void add(const VectorOutcome& outcome, const SuiteReader& reader, std::uint64_t line);
  /// Adds what was found in later lines.
  void merge(const VerifyResult& later);
};

/// A suite for any configuration.
class Suite {
 public:
  virtual ~Suite() = default;
  virtual const SuiteInfo& info() const = 0;
  /// Announces the records and writes them, with counts; the caller writes the manifest.
  virtual void write(SuiteWriter& writer, const GenerateOptions& options) const = 0;
  /// Recomputes every response by the fixed-point model and compares every bit. Throws golden::InputError when the
  /// records are not those of this suite.
  virtual VerifyResult verify(const SuiteReader& reader, unsigned threads) const = 0;
  /// Throws golden::InputError unless records, counts and files are those that this suite has.
  virtual void require(const SuiteReader& reader) const = 0;
  /// The first picture that is not that of the suite's own response, as "file: difference"; empty when all are. Throws
  /// golden::InputError for a picture that cannot be read.
  virtual std::string picture_difference(const SuiteReader&) const { return {}; }
};

/// Every suite, in the order of golden/vectors/README.md.
const std::vector<std::unique_ptr<Suite>>& suites();

/// The suite of sets made of an input of one's own (input_suite.hpp); not among suites().
inline constexpr std::string_view input_suite_name = "input";

/// The suite of that name, `input` too; throws golden::InputError naming the nearest.
const Suite& find_suite(std::string_view name);

/// Throws golden::InputError unless the set's command makes its suites.
void require_known(const SetReader& set);
/// Throws golden::InputError unless the suite's manifest says what this program says of its suite.
void require_known(const SuiteReader& reader);

// ---- For those who implement suites and engines ----

/// Throws golden::InputError unless the suite's record is laid out as `expected`.
void require_layout(const SuiteReader& reader, const std::string& role, const RecordLayout& expected);

/// Throws golden::InputError unless "counts" are these, in order.
void require_counts(const SuiteReader& reader, const nlohmann::ordered_json& expected);

/// Throws golden::InputError unless the suite has these records and, beside their files, `others`.
void require_files(const SuiteReader& reader, std::vector<std::string> roles, const std::vector<std::string>& others);

/// Calls check(stimulus, response) for every vector of a stage suite on `threads` threads and adds up; the first
/// difference is that of the lowest line.
VerifyResult check_vectors(const SuiteReader& reader, unsigned threads,
                           const std::function<VectorOutcome(const Record& stimulus, const Record& response)>& check);

}  // namespace quadrille::vectors
