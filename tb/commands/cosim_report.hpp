// What `quadrille cosim` says: table, summary, complaints, JSON.
#pragma once

#include "tb/commands/cosim_options.hpp"
#include "tb/commands/cosim_result.hpp"
#include "tb/judge/model_check.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>
#include <vector>

namespace quadrille::tb {

class CosimReport {
 public:
  /// Both must outlive it.
  CosimReport(const CosimOptions& options, const Config& config) : options_(options), config_(config) {}

  nlohmann::ordered_json result(const InputResult& r) const;
  nlohmann::ordered_json all(const InputResult& total, const std::vector<InputResult>& results, const ModelCheck* model,
                             bool ok, const std::vector<std::string>& arguments) const;
  /// The command that explains the pixel of the first difference; empty where there is none.
  std::string explain(const InputResult& r) const;
  void print_summary(std::FILE* out, const InputResult& r, const ModelCheck* model, bool ok) const;

 private:
  /// The bound is a statement about exact A, D and R².
  bool bound_applies() const { return config_.qdrop() == 0; }
  /// A command on the pixel of an input.
  std::string command_at(const InputResult& result, const std::string& command, std::uint32_t quad, int x, int y) const;
  void print_errors(std::FILE* out, const InputResult& r) const;

  const CosimOptions& options_;
  const Config& config_;
};

/// A row of the table of several inputs, before the first its head.
void print_row(std::FILE* out, const InputResult& r, bool head);
/// What is wrong with a result, on standard error.
void complain(const InputResult& r);
/// --list-metrics: every number of the report's metrics as a Markdown table.
std::string list_metrics();

}  // namespace quadrille::tb
