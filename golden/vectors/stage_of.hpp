// The records of a stage from two lists of fields.
#pragma once

#include "golden/vectors/stage_suite.hpp"
#include "model/port/boundaries.hpp"

namespace quadrille::vectors {

/// Lists has two static templates, stimulus(data, config, f) and response(data, config, f), that list the fields of a
/// StageData (const or not) as model/port/fields.hpp says.
template <class Lists>
class StageOf : public StageUnderTest {
 public:
  Record pack_stimulus(const StageData& data) const override {
    return pack_record(stimulus_.bits(), [&](auto& f) { Lists::stimulus(data, config(), f); });
  }
  void unpack_stimulus(const Record& record, StageData& data) const override {
    Lists::stimulus(data, config(), RecordUnpacker(record));
  }
  Record pack_response(const StageData& data) const override {
    return pack_record(response_.bits(), [&](auto& f) { Lists::response(data, config(), f); });
  }
  void unpack_response(const Record& record, StageData& data) const override {
    Lists::response(data, config(), RecordUnpacker(record));
  }

 protected:
  explicit StageOf(const Config& config) : StageUnderTest(config) {
    const StageData nothing;
    stimulus_ = layout_of([&](auto& f) { Lists::stimulus(nothing, config, f); });
    response_ = layout_of([&](auto& f) { Lists::response(nothing, config, f); });
  }
};

}  // namespace quadrille::vectors
