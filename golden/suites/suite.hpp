// The suites: what each can write and check, and the list of them.
#pragma once

#include "golden/suites/manifest.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::vectors {

struct GenerateOptions {
  int level = 1;  ///< 1: minutes, 2: a hundred times the vectors
  std::uint64_t seed = 1;
  Config config;
  std::uint64_t limit =
      0;                 ///< random and realistic vectors of a suite at most, also corner ones; 0: the level's number
  unsigned threads = 1;  ///< the bytes do not depend on it
};

/// What a check found.
struct VerifyResult {
  std::uint64_t vectors = 0;     ///< compared
  std::uint64_t mismatches = 0;  ///< of these, different
  std::uint64_t undefined = 0;   ///< of these, without a value in the engine (float only); they count as neither
  std::string first_difference;  ///< "file:line: field: expected …, actual …"

  bool ok() const { return vectors > undefined && mismatches == 0; }
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
};

/// Every suite, in the order of golden/vectors/README.md.
const std::vector<std::unique_ptr<Suite>>& suites();

/// The suite of that name; throws golden::InputError naming the nearest.
const Suite& find_suite(std::string_view name);

// ---- For those who implement suites and engines ----

/// Throws golden::InputError unless the suite's record is laid out as `expected`.
void require_layout(const SuiteReader& reader, const std::string& role, const RecordLayout& expected);

/// One vector, compared.
struct VectorOutcome {
  enum class Kind { match, mismatch, undefined } kind = Kind::match;
  std::string difference;  ///< of a mismatch
};

/// Calls check(stimulus, response) for every vector of a stage suite on `threads` threads and adds up; the first
/// difference is that of the lowest line.
VerifyResult check_vectors(const SuiteReader& reader, unsigned threads,
                           const std::function<VectorOutcome(const Record& stimulus, const Record& response)>& check);

}  // namespace quadrille::vectors
