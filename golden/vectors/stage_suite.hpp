// A suite whose response line is a pure function of its stimulus line.
#pragma once

#include "golden/vectors/patterns.hpp"
#include "golden/vectors/suite.hpp"
#include "model/front/stamp_coverage.hpp"
#include "model/pixel/pixel_pipeline.hpp"

#include <array>
#include <functional>
#include <memory>

namespace quadrille::vectors {

/// Everything that one quad, one of its tiles and one pixel are at the stage boundaries. A stage reads some of it
/// and writes some of it; a record holds those parts.
struct StageData {
  // snapping
  std::array<WindowVertex, 4> vertex{};
  std::array<std::array<double, max_attribute_slots>, 4> attribute{};
  bool refused = false;
  SnappedQuad snapped;
  // front end
  DrawState state;                    ///< its znear and zfar do not count
  std::uint32_t znear = 0, zfar = 0;  ///< as codes
  SnappedQuad quad;
  SetupResult setup;
  QuadConstants constants;
  TileEntry tile;
  int tile_column = 0, tile_row = 0;  ///< of the tile, from the quad's first one
  std::array<StampMasks, 16> row_masks{};
  int row = 0, dx = 0;
  // pixel
  QuadData data;
  PixelTrace pixel;
  std::array<std::int8_t, 4> a_sign{};
  std::array<bool, 4> corner{};
  std::array<bool, 6> d_negative{};
  PipelineFloat number, inverse;  ///< reciprocal
};

/// What realistic stimuli of a stage are taken from.
enum class Source { given, quads, tiles, pixels };

/// A stage for one configuration.
class StageUnderTest {
 public:
  using Sink = std::function<void(const StageData&)>;

  virtual ~StageUnderTest() = default;

  const Config& config() const { return context_.config; }
  const RecordLayout& stimulus_layout() const { return stimulus_; }
  const RecordLayout& response_layout() const { return response_; }

  virtual Record pack_stimulus(const StageData& data) const = 0;
  virtual void unpack_stimulus(const Record& record, StageData& data) const = 0;
  virtual Record pack_response(const StageData& data) const = 0;
  virtual void unpack_response(const Record& record, StageData& data) const = 0;

  /// Fills the response's part of the data from the stimulus' part: the model's function.
  virtual void run(StageData& data) const = 0;
  /// The same from record to record.
  Record respond(const Record& stimulus) const;

  // ---- What stimuli may be (SuiteInfo::contract in code) ----

  virtual Source source() const { return Source::pixels; }
  /// Legal values of one field of the stimulus, the others apart.
  virtual FieldRange range(const RecordField& field) const;
  /// Makes the fields fit together, changing as little as it can. What comes out is legal.
  virtual void constrain(StageData&) const {}
  /// Puts structure into random data: chance alone hardly ever makes it. With this chance:
  virtual double shaped() const { return 0.5; }
  virtual void shape(golden::Prng&, StageData&) const {}
  /// Corner cases beyond single fields.
  virtual void corners(const Sink&) const {}

 protected:
  explicit StageUnderTest(const Config& config) : context_(config, DrawState{}) {}

  PipelineContext context_;
  RecordLayout stimulus_, response_;
};

/// What a stage may be given, field by field: a stimulus of somebody else's set or program is looked at first.
class StimulusCheck {
 public:
  explicit StimulusCheck(const StageUnderTest& stage);
  /// "attributes = 15; the stage can be given 0..4"; empty of a stimulus that the stage can be given.
  std::string fault(const Record& stimulus) const;

 private:
  struct Field {
    RecordField field;
    FieldRange range;
  };
  std::vector<Field> fields_;
};

/// A stage suite: see Suite.
class StageSuite : public Suite {
 public:
  using Make = std::unique_ptr<const StageUnderTest> (*)(const Config&);
  StageSuite(SuiteInfo info, Make make) : info_(std::move(info)), make_(make) {}

  const SuiteInfo& info() const override { return info_; }
  std::unique_ptr<const StageUnderTest> stage(const Config& config) const { return make_(config); }

  void write(SuiteWriter& writer, const GenerateOptions& options) const override;
  VerifyResult verify(const SuiteReader& reader, unsigned threads) const override;
  void require(const SuiteReader& reader) const override;

  /// check_vectors() of this suite's records; a stimulus that the stage cannot be given is a mismatch.
  using Check = std::function<VectorOutcome(const StageUnderTest&, const Record& stimulus, const Record& response)>;
  VerifyResult check(const SuiteReader& reader, unsigned threads, const Check& check) const;

  /// The stimuli of a generation in order, with the number of each kind, without writing anything.
  struct Stimuli {
    std::vector<Record> corner, random, realistic;
  };
  Stimuli stimuli(const GenerateOptions& options) const;

 private:
  SuiteInfo info_;
  Make make_;
};

}  // namespace quadrille::vectors
