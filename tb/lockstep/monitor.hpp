// Watches the fragment port: counts and hashes what was handed over and passes it on.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <cstdint>
#include <functional>

namespace quadrille::tb {

using FragmentSink = std::function<void(const Fragment&)>;

class FragmentMonitor {
 public:
  /// `width`: bits of the packed fragment. The sink may be empty.
  FragmentMonitor(const Config& config, int width, const FragmentSink& sink);

  /// A fragment was handed over in this clock. `known`: the same fragment as a record, if somebody has it already.
  void handed_over(const std::uint32_t* words, const Fragment* known);

  std::uint64_t fragments() const { return fragments_; }
  /// Depends on every bit and on the order.
  std::uint64_t hash() const { return hash_; }

 private:
  const Config& config_;
  const FragmentSink& sink_;
  int width_;
  std::uint64_t fragments_ = 0, hash_ = 0xcbf29ce484222325u;
};

}  // namespace quadrille::tb
