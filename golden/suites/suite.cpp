#include "golden/suites/suite.hpp"

#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"
#include "golden/suites/machine_suite.hpp"
#include "golden/suites/stage_suites.hpp"
#include "model/edit_distance.hpp"
#include "tb/render/parallel.hpp"

#include <algorithm>

namespace quadrille::vectors {

const std::vector<std::unique_ptr<Suite>>& suites() {
  static const std::vector<std::unique_ptr<Suite>> all = [] {
    std::vector<std::unique_ptr<Suite>> list;
    add_stage_suites(list);
    add_machine_suites(list);
    return list;
  }();
  return all;
}

const Suite& find_suite(std::string_view name) {
  const Suite* nearest = suites().front().get();
  for (const auto& suite : suites()) {
    if (suite->info().name == name) return *suite;
    if (edit_distance(name, suite->info().name) < edit_distance(name, nearest->info().name)) nearest = suite.get();
  }
  throw golden::InputError("unknown suite " + golden::in_quotes(name) + "; the nearest is \"" + nearest->info().name +
                           "\"");
}

void require_layout(const SuiteReader& reader, const std::string& role, const RecordLayout& expected) {
  if (reader.layout(role) != expected)
    throw golden::input_error((reader.directory() / "manifest.json").string(), 0,
                              "record " + role + " is not laid out as this program lays it out");
}

VerifyResult check_vectors(const SuiteReader& reader, unsigned threads,
                           const std::function<VectorOutcome(const Record&, const Record&)>& check) {
  const std::uint64_t lines = reader.lines("stimulus");
  if (reader.lines("response") != lines)
    throw golden::input_error((reader.directory() / "manifest.json").string(), 0,
                              "stimulus and response have different numbers of lines");
  constexpr std::uint64_t chunk = 1024;
  VerifyResult total;
  cli::ordered_parallel((lines + chunk - 1) / chunk, threads,
                        [&](std::size_t unit) {
                          const std::uint64_t first = unit * chunk, count = std::min(chunk, lines - first);
                          const std::vector<Record> stimulus = reader.read("stimulus", first, count);
                          const std::vector<Record> response = reader.read("response", first, count);
                          VerifyResult part;
                          for (std::uint64_t i = 0; i < count; ++i) {
                            const VectorOutcome outcome = check(stimulus[i], response[i]);
                            ++part.vectors;
                            part.undefined += outcome.kind == VectorOutcome::Kind::undefined;
                            if (outcome.kind != VectorOutcome::Kind::mismatch) continue;
                            if (part.mismatches++ == 0)
                              part.first_difference = reader.place("response", first + i) + ": " + outcome.difference;
                          }
                          return part;
                        },
                        [&](std::size_t, const VerifyResult& part) {
                          if (total.mismatches == 0) total.first_difference = part.first_difference;
                          total.vectors += part.vectors;
                          total.mismatches += part.mismatches;
                          total.undefined += part.undefined;
                        });
  return total;
}

}  // namespace quadrille::vectors
