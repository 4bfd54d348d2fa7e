#include "golden/vectors/table_suite.hpp"

#include "golden/io/error.hpp"
#include "model/port/boundaries.hpp"

#include <bit>

namespace quadrille::vectors {
namespace {

template <class Index, class F>
void visit_index(Index& index, const Table& table, F&& f) {
  f(plain("index", std::countr_zero(table.entries.size()),
          "entry: the segment; of sqrt behind the exponent's lowest bit"),
    -1, index);
}

template <class Entry, class F>
void visit_entry(Entry& e, const Config& c, F&& f) {
  const Bits s = significand_bits(c), fraction{c.significand_bits + Config::table_guard, "S+TABLE_GUARD"};
  f(FieldType{"c0", {c.significand_bits + 4, "S+4"}, false, fraction, "1", "C0"}, -1, e.c0);
  f(FieldType{"c1", s, false, fraction, "1", "C1, downwards"}, -1, e.c1);
  f(FieldType{"c2", s, false, fraction, "1", "C2, upwards; 0 in degree 1"}, -1, e.c2);
}

Record pack_index(std::uint64_t index, const Table& table) {
  return pack_record(std::countr_zero(table.entries.size()), [&](auto& f) { visit_index(index, table, f); });
}

}  // namespace

RecordLayout TableSuite::stimulus_layout(const Config& config) const {
  const std::uint64_t index = 0;
  return layout_of([&, table = make_(config)](auto& f) { visit_index(index, table, f); });
}

RecordLayout TableSuite::response_layout(const Config& config) const {
  const TableEntry entry;
  return layout_of([&](auto& f) { visit_entry(entry, config, f); });
}

TableEntry TableSuite::entry(const Record& response, const Config& config) {
  TableEntry entry;
  visit_entry(entry, config, RecordUnpacker(response));
  return entry;
}

void TableSuite::write(SuiteWriter& writer, const GenerateOptions& options) const {
  const Table table = make_(options.config);
  const RecordLayout response = response_layout(options.config);
  writer.add_record("stimulus", stimulus_layout(options.config));
  writer.add_record("response", response);
  for (std::size_t i = 0; i < table.entries.size(); ++i) {
    writer.write("stimulus", pack_index(i, table));
    writer.write("response",
                 pack_record(response.bits(), [&](auto& f) { visit_entry(table.entries[i], options.config, f); }));
  }
  writer.set_count("vectors", table.entries.size());
}

void TableSuite::require(const SuiteReader& reader) const {
  require_files(reader, {"stimulus", "response"}, {});
  const Table table = make_(reader.set().config);
  require_counts(reader, {{"vectors", table.entries.size()}});
  require_layout(reader, "stimulus", stimulus_layout(reader.set().config));
  const std::vector<Record> indices = reader.read("stimulus", 0, reader.lines("stimulus"));
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] != pack_index(i, table))
      throw golden::InputError(reader.place("stimulus", i) + ": entries must come in order, each once");
}

VerifyResult TableSuite::verify(const SuiteReader& reader, unsigned threads) const {
  const Config& config = reader.set().config;
  const Table table = make_(config);
  const RecordLayout layout = response_layout(config);
  require_layout(reader, "stimulus", stimulus_layout(config));
  require_layout(reader, "response", layout);
  return check_vectors(reader, threads, [&](const Record& stimulus, const Record& given) {
    const TableEntry& entry = table.entries[stimulus.get(0, stimulus.bits())];
    const Record expected = pack_record(layout.bits(), [&](auto& f) { visit_entry(entry, config, f); });
    if (given == expected) return VectorOutcome{};
    return VectorOutcome{VectorOutcome::Kind::mismatch, first_difference(layout, given, expected)};
  });
}

void add_table_suites(std::vector<std::unique_ptr<Suite>>& suites) {
  const std::string contract = "nothing: every entry is there, in order";
  suites.push_back(std::make_unique<TableSuite>(
      SuiteInfo{"sqrt_table", "table", "Coefficients of the square root", "none", 0, contract}, make_sqrt_table));
  suites.push_back(std::make_unique<TableSuite>(
      SuiteInfo{"reciprocal_table", "table", "Coefficients of the reciprocal", "none", 0, contract}, make_recip_table));
}

}  // namespace quadrille::vectors
