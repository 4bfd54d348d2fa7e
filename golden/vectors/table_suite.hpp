// Suites of the sqrt and reciprocal tables: an entry a line, every entry.
#pragma once

#include "golden/vectors/suite.hpp"
#include "model/port/tables.hpp"

#include <memory>
#include <vector>

namespace quadrille::vectors {

class TableSuite : public Suite {
 public:
  using Make = Table (*)(const Config&);
  TableSuite(SuiteInfo info, Make make) : info_(std::move(info)), make_(make) {}

  const SuiteInfo& info() const override { return info_; }
  void write(SuiteWriter& writer, const GenerateOptions& options) const override;
  VerifyResult verify(const SuiteReader& reader, unsigned threads) const override;
  void require(const SuiteReader& reader) const override;

  Table table(const Config& config) const { return make_(config); }
  /// What a response holds.
  static TableEntry entry(const Record& response, const Config& config);
  RecordLayout stimulus_layout(const Config& config) const;
  RecordLayout response_layout(const Config& config) const;

 private:
  SuiteInfo info_;
  Make make_;
};

/// `sqrt_table` and `reciprocal_table`.
void add_table_suites(std::vector<std::unique_ptr<Suite>>& suites);

}  // namespace quadrille::vectors
