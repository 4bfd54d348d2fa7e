// Suite `input`: the whole machine on an input of one's own, from the vertices as given.
#pragma once

#include "golden/vectors/machine_suite.hpp"

#include <vector>

namespace quadrille::vectors {

class InputSuite : public MachineSuite {
 public:
  /// To check a set.
  InputSuite();
  /// To write one draw, cut off by GenerateOptions::limit as others are (0: all of it). Throws SnapError for a vertex
  /// that snapping refuses.
  InputSuite(std::vector<WindowQuad> quads, const DrawState& state, const Config& config);

  void write(SuiteWriter& writer, const GenerateOptions& options) const override;
  /// The machine's responses, and the port's integers from the given vertices.
  VerifyResult verify(const SuiteReader& reader, unsigned threads) const override;

 protected:
  std::vector<std::string> roles() const override;

 private:
  std::vector<WindowQuad> given_;
  DrawState state_;
};

}  // namespace quadrille::vectors
