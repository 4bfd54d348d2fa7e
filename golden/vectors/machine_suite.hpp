// Suites of the whole machine: vertex beats and states in, fragments with their clocks out, the clocks in which beats
// are taken, and pictures.
#pragma once

#include "golden/vectors/suite.hpp"
#include "model/port/records.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace quadrille::vectors {

/// One draw: a state that stays, and quads.
struct MachineDraw {
  DrawState state;
  std::vector<SnappedQuad> quads;
};

/// A line of response.hex, the clocks apart.
struct DrawnFragment {
  std::uint32_t draw = 0;
  Fragment fragment;
};

/// The draws of a machine suite on the disk. Throws golden::InputError when records are not laid out as this program
/// lays them out or hold what the machine cannot be given.
std::vector<MachineDraw> read_draws(const SuiteReader& reader);
/// Lines [first, first + count) of its response; may be called on several threads.
std::vector<DrawnFragment> read_fragments(const SuiteReader& reader, std::uint64_t first, std::uint64_t count);

class MachineSuite : public Suite {
 public:
  /// The draws of a generation: quads until they make GenerateOptions::limit fragments in all, or the level's number.
  using Draws = std::function<std::vector<MachineDraw>(const GenerateOptions&)>;

  MachineSuite(SuiteInfo info, Draws draws) : info_(std::move(info)), draws_(std::move(draws)) {}

  const SuiteInfo& info() const override { return info_; }
  void write(SuiteWriter& writer, const GenerateOptions& options) const override;
  VerifyResult verify(const SuiteReader& reader, unsigned threads) const override;
  void require(const SuiteReader& reader) const override;
  std::string picture_difference(const SuiteReader& reader) const override;

 protected:
  /// Records that the suite has.
  virtual std::vector<std::string> roles() const;
  /// The quads of a draw as the port has them; throws SnapError.
  static MachineDraw snap_draw(const std::vector<WindowQuad>& quads, const DrawState& state, const Config& config);
  /// The draw, cut off by the limit; throws golden::InputError when it has no fragment, or without a limit more than
  /// largest_limit.
  static MachineDraw limited(MachineDraw draw, const GenerateOptions& options);

 private:
  SuiteInfo info_;
  Draws draws_;
};

/// `machine` (every draw state) and one suite for each stress family.
void add_machine_suites(std::vector<std::unique_ptr<Suite>>& suites);

}  // namespace quadrille::vectors
