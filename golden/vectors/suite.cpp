#include "golden/vectors/suite.hpp"

#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"
#include "golden/vectors/input_suite.hpp"
#include "golden/vectors/machine_suite.hpp"
#include "golden/vectors/stage_suites.hpp"
#include "golden/vectors/table_suite.hpp"
#include "model/support/edit_distance.hpp"
#include "model/support/parallel.hpp"

#include <algorithm>
#include <set>

namespace quadrille::vectors {

const std::vector<std::unique_ptr<Suite>>& suites() {
  static const std::vector<std::unique_ptr<Suite>> all = [] {
    std::vector<std::unique_ptr<Suite>> list;
    add_stage_suites(list);
    add_table_suites(list);
    add_machine_suites(list);
    return list;
  }();
  return all;
}

const Suite& find_suite(std::string_view name) {
  static const InputSuite input;
  if (name == input_suite_name) return input;
  for (const auto& suite : suites())
    if (suite->info().name == name) return *suite;
  throw golden::InputError("unknown suite " + golden::in_quotes(name) +
                           did_you_mean(name, suites(), [](const auto& suite) { return suite->info().name; }));
}

void require_known(const SetReader& set) {
  if (!set.says_complete()) return;
  std::vector<std::string> all;
  for (const auto& suite : suites()) all.push_back(suite->info().name);
  if (set.suites() != all)
    throw golden::input_error(set.manifest_file(), 0, "\"command\" generates other suites than the set has");
}

void require_known(const SuiteReader& reader) {
  const Suite& suite = find_suite(reader.info().name);
  const SuiteInfo &expected = suite.info(), &given = reader.info();
  const auto require = [&](bool same, const char* key) {
    if (!same)
      throw golden::input_error(reader.manifest_file(), 0,
                                std::string("\"") + key + "\" differs from this program's for suite " + expected.name);
  };
  require(given.kind == expected.kind, "kind");
  require(given.title == expected.title, "title");
  require(given.module == expected.module, "module");
  require(given.latency == expected.latency, "latency");
  require(given.contract == expected.contract, "contract");
  if ((expected.name == input_suite_name) == reader.set().input.empty())
    throw golden::input_error(reader.manifest_file(), 0, "\"command\" is not that of suite " + expected.name);
  suite.require(reader);
}

void require_layout(const SuiteReader& reader, const std::string& role, const RecordLayout& expected) {
  if (reader.layout(role) != expected)
    throw golden::input_error(reader.manifest_file(), 0, "record " + role + " has other fields than this program's");
}

void require_counts(const SuiteReader& reader, const nlohmann::ordered_json& expected) {
  if (reader.manifest().at("counts") != expected)
    throw golden::input_error(reader.manifest_file(), 0, "\"counts\" should be " + expected.dump());
}

void require_files(const SuiteReader& reader, std::vector<std::string> roles, const std::vector<std::string>& others) {
  std::ranges::sort(roles);
  std::set<std::string> expected(others.begin(), others.end()), given;
  for (const std::string& role : roles) expected.insert(role + ".hex");
  for (const auto& [name, entry] : reader.manifest().at("files").items()) given.insert(name);
  if (reader.roles() != roles || given != expected)
    throw golden::input_error(reader.manifest_file(), 0,
                              "has other records or files than this program's suite " + reader.info().name);
}

void VerifyResult::add(const VectorOutcome& outcome, const SuiteReader& reader, std::uint64_t line) {
  ++vectors;
  undefined += outcome.kind == VectorOutcome::Kind::undefined;
  if (outcome.kind == VectorOutcome::Kind::mismatch && mismatches++ == 0)
    first_difference = reader.place("response", line) + ": " + outcome.difference;
}

void VerifyResult::merge(const VerifyResult& later) {
  if (mismatches == 0) first_difference = later.first_difference;
  vectors += later.vectors;
  mismatches += later.mismatches;
  undefined += later.undefined;
}

VerifyResult check_vectors(const SuiteReader& reader, unsigned threads,
                           const std::function<VectorOutcome(const Record&, const Record&)>& check) {
  const std::uint64_t lines = reader.lines("stimulus");
  if (reader.lines("response") != lines)
    throw golden::input_error(reader.manifest_file(), 0, "stimulus and response have different numbers of lines");
  constexpr std::uint64_t chunk = 1024;
  VerifyResult total;
  ordered_parallel((lines + chunk - 1) / chunk, threads,
                   [&](std::size_t unit) {
                     const std::uint64_t first = unit * chunk, count = std::min(chunk, lines - first);
                     const std::vector<Record> stimulus = reader.read("stimulus", first, count);
                     const std::vector<Record> response = reader.read("response", first, count);
                     VerifyResult part;
                     for (std::uint64_t i = 0; i < count; ++i) {
                       part.add(check(stimulus[i], response[i]), reader, first + i);
                     }
                     return part;
                   },
                   [&](std::size_t, const VerifyResult& part) { total.merge(part); });
  return total;
}

}  // namespace quadrille::vectors
