#include "tb/lockstep/scoreboard.hpp"

#include <algorithm>
#include <cstring>

namespace quadrille::tb {

namespace {

constexpr std::size_t index_of(Boundary b) { return static_cast<std::size_t>(b); }
constexpr std::size_t boundary_count = index_of(Boundary::fragment) + 1;

bool same_words(const std::uint64_t* expected, const std::uint32_t* actual, std::size_t words) {
  return std::memcmp(expected, actual, words * sizeof(std::uint32_t)) == 0;
}

}  // namespace

Scoreboard::Scoreboard(const Config& config, std::span<const SnappedQuad> quads, bool probes, std::uint64_t seed)
    : config_(config),
      quads_(quads),
      probes_(probes),
      seed_(seed),
      quad_of_slot_(static_cast<std::size_t>(config.quad_slots())),
      ring_(static_cast<std::size_t>(2 * ring_entries(config))) {
  std::size_t room = 0;
  for (std::size_t i = 0; i < boundary_count; ++i) {
    layouts_.push_back(boundary_layout(static_cast<Boundary>(i), config));
    counts_.push_back({boundary_name(static_cast<Boundary>(i))});
    room = std::max(room, static_cast<std::size_t>(layouts_.back().bits() + 63) / 64);
  }
  packed_.resize(room);
}

std::string Scoreboard::where(const Place& place) const {
  std::string text = "cycle " + std::to_string(cycle_);
  if (place.quad != nullptr) text += ", quad " + std::to_string(place.quad->id);
  if (place.x >= 0) {
    text += std::string(", ") + place.unit + " (" + std::to_string(place.x) + ", " + std::to_string(place.y) + ")";
  }
  return text;
}

template <class Locate>
void Scoreboard::signal(const char* name, std::uint32_t expected, std::uint32_t actual, Locate&& locate) {
  if (expected == actual) return;
  verdict_.timing = false;
  if (first_) return;
  first_ = where(locate()) + ", " + name + ": expected " + hex(expected, 1) + " (model), actual " + hex(actual, 1) +
           " (RTL); seed " + std::to_string(seed_);
}

void Scoreboard::payload_differs(Boundary b, const std::uint32_t* actual, const Place& place) {
  ++counts_[index_of(b)].mismatches;
  ++mismatches_;
  verdict_.payload = false;
  if (b == Boundary::fragment) verdict_.fragment = false;
  if (first_) return;
  const RecordLayout& layout = layouts_[index_of(b)];
  Record expected(layout.bits());
  std::copy_n(packed_.data(), static_cast<std::size_t>(layout.bits() + 63) / 64, expected.words());
  const Record given = Record::from_words(actual, layout.bits());
  const RecordField* field = first_different_field(layout, expected, given);
  first_ = where(place) + ", stage " + boundary_name(b) + ", ";
  if (field == nullptr) {
    *first_ += "bits above the vector are not zero";
  } else {
    *first_ += "field " + field->label() + ": expected " + hex(expected.get(*field), field->width) +
               " (model), actual " + hex(given.get(*field), field->width) + " (RTL)";
  }
  *first_ += "; seed " + std::to_string(seed_);
}

template <class Record, class Pack, class Locate>
void Scoreboard::boundary(Boundary b, const Record* expected, const ProbeSample& actual, Pack&& pack, Locate&& locate) {
  const bool valid = expected != nullptr;
  if (!valid && !actual.valid) return;
  if (valid != actual.valid) {
    verdict_.timing = false;
    if (!first_) {
      first_ = where(valid ? locate(*expected) : Place{}) + ", stage " + boundary_name(b) + ", valid: expected " +
               (valid ? "1 (model), actual 0 (RTL)" : "0 (model), actual 1 (RTL)") + "; seed " + std::to_string(seed_);
    }
    return;
  }
  const RecordLayout& layout = layouts_[index_of(b)];
  BitPacker packer(packed_.data(), layout.bits());
  pack(*expected, packer);
  packer.finish();
  BoundaryCount& count = counts_[index_of(b)];
  ++count.beats;
  count.bits += static_cast<std::uint64_t>(layout.bits());
  if (!same_words(packed_.data(), actual.words, words_for(layout.bits())))
    payload_differs(b, actual.words, locate(*expected));
}

void Scoreboard::follow(const ClockedProbes& probes) {
  if (probes.setup != nullptr) quad_of_slot_[probes.setup->slot % quad_of_slot_.size()] = quads_set_up_++;
  if (probes.tile != nullptr) {
    ring_[ring_write_] = {quad_of_slot_[probes.tile->slot % quad_of_slot_.size()], probes.tile->tile_x,
                          probes.tile->tile_y};
    ring_write_ = (ring_write_ + 1) % ring_.size();
  }
}

Scoreboard::Verdict Scoreboard::compare(std::uint64_t cycle, const ClockedOutputs& expected,
                                        const DeviceSample& actual) {
  cycle_ = cycle;
  verdict_ = {};

  // Boundaries in the order of the data's way, so that the first difference of a clock is the one nearest to the input.
  if (probes_) {
    const ClockedProbes& p = expected.probes;
    const auto probe = [&](Boundary b) -> const ProbeSample& { return actual.probe[index_of(b)]; };
    const auto pack = [&](const auto& record, BitPacker& packer) { visit(record, config_, packer); };
    boundary(Boundary::setup, p.setup, probe(Boundary::setup), pack,
             [&](const SetupResult&) { return Place{quad_at(quads_set_up_)}; });
    boundary(Boundary::tile, p.tile, probe(Boundary::tile), pack, [&](const TileEntry& t) {
      return Place{quad_at(quad_of_slot_[t.slot % quad_of_slot_.size()]), t.end ? -1 : t.tile_x, t.tile_y, "tile"};
    });
    boundary(Boundary::stamp, p.stamp, probe(Boundary::stamp), pack, [&](const StampEntry& s) {
      const RingPlace& ring = ring_[s.tile_ptr % ring_.size()];
      return Place{quad_at(ring.quad), s.end ? -1 : ring.tile_x * config_.tile(), ring.tile_y * config_.tile() + s.row,
                   "row at"};
    });
    const auto pixel = [&](Boundary b, const PixelTrace* trace) {
      boundary(
          b, trace, probe(b), [&, b](const PixelTrace& t, BitPacker& packer) { visit(t, b, config_, packer); },
          [&](const PixelTrace& t) {
            return Place{quad_at(quad_of_slot_[t.slot % quad_of_slot_.size()]), t.x, t.y};
          });
    };
    pixel(Boundary::diff, p.diff);
    pixel(Boundary::norm, p.norm);
    pixel(Boundary::sqrt, p.sqrt);
    pixel(Boundary::ratio, p.ratio);
    pixel(Boundary::weight, p.weight);
    pixel(Boundary::sum, p.sum);
    follow(p);
  }

  // Ports. The fragment's bits are compared in every clock: they are zero when there is none.
  const auto fragment_place = [&] {
    Place place;
    if (!expected.fragment_valid) return place;
    const auto quad =
        std::find_if(quads_.begin(), quads_.end(), [&](const auto& q) { return q.id == expected.fragment.quad; });
    if (quad != quads_.end()) place.quad = &*quad;
    place.x = expected.fragment.x;
    place.y = expected.fragment.y;
    return place;
  };
  signal("fragment_valid", expected.fragment_valid, actual.fragment_valid, fragment_place);
  signal("fragment_mask", expected.fragment_valid ? 1 : 0, actual.fragment_mask, fragment_place);
  const RecordLayout& layout = layouts_[index_of(Boundary::fragment)];
  BoundaryCount& count = counts_[index_of(Boundary::fragment)];
  if (expected.fragment_valid) {
    BitPacker packer(packed_.data(), layout.bits());
    visit(expected.fragment, config_, packer);
    packer.finish();
    ++count.beats;
  } else {
    std::memset(packed_.data(), 0, packed_.size() * sizeof packed_[0]);
  }
  count.bits += static_cast<std::uint64_t>(layout.bits());
  if (!same_words(packed_.data(), actual.fragment, words_for(layout.bits()))) {
    payload_differs(Boundary::fragment, actual.fragment, fragment_place());
  }
  const auto nowhere = [] { return Place{}; };
  signal("vertex_ready", expected.vertex_ready, actual.vertex_ready, nowhere);
  signal("busy", expected.busy, actual.busy, nowhere);

  if (!verdict_.timing) ++cycle_mismatches_;
  return verdict_;
}

void Scoreboard::device_stopped(std::uint64_t cycle, const std::string& why) {
  cycle_ = cycle;
  ++mismatches_;
  if (!first_) first_ = where({}) + ", the RTL stopped: " + why + "; seed " + std::to_string(seed_);
}

}  // namespace quadrille::tb
