// The records of a stage from two lists of fields.
#pragma once

#include "golden/suites/fields.hpp"
#include "golden/suites/stage_suite.hpp"

namespace quadrille::vectors {

/// Lists has two static templates, stimulus(data, config, f) and response(data, config, f), that list the fields of a
/// StageData (const or not) as fields.hpp says.
template <class Lists>
class StageOf : public Stage {
 public:
  Record pack_stimulus(const StageData& data) const override {
    RecordPacker packer(stimulus_.bits());
    Lists::stimulus(data, config(), packer);
    return packer.take();
  }
  void unpack_stimulus(const Record& record, StageData& data) const override {
    Lists::stimulus(data, config(), RecordUnpacker(record));
  }
  Record pack_response(const StageData& data) const override {
    RecordPacker packer(response_.bits());
    Lists::response(data, config(), packer);
    return packer.take();
  }
  void unpack_response(const Record& record, StageData& data) const override {
    Lists::response(data, config(), RecordUnpacker(record));
  }

 protected:
  explicit StageOf(const Config& config) : Stage(config) {
    const StageData nothing;
    LayoutLister stimulus, response;
    Lists::stimulus(nothing, config, stimulus);
    Lists::response(nothing, config, response);
    stimulus_ = std::move(stimulus.layout);
    response_ = std::move(response.layout);
  }
};

template <class S>
std::unique_ptr<const Stage> make_stage(const Config& config) {
  return std::make_unique<const S>(config);
}

}  // namespace quadrille::vectors
