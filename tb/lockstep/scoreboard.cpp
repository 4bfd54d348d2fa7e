#include "tb/lockstep/scoreboard.hpp"

#include "model/port/latency.hpp"
#include "model/port/snap.hpp"

#include <algorithm>
#include <bit>
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
      lanes_(static_cast<std::size_t>(config.pixels_per_clock)),
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

void Scoreboard::follows(const Scoreboard& before) {
  quads_before_ = before.quads_before_ + before.quads_.size();
  quad_of_slot_ = before.quad_of_slot_;
  ring_ = before.ring_;
  ring_write_ = before.ring_write_;
}

std::string Scoreboard::where(const Place& place) {
  if (place.quad != nullptr && place.x >= 0 && place.unit == "pixel") first_pixel_ = {place.quad->id, place.x, place.y};
  std::string text = "cycle " + std::to_string(cycle_);
  if (place.quad != nullptr) text += ", quad " + std::to_string(place.quad->id);
  if (place.x >= 0) {
    text += ", " + std::string(place.unit) + " (" + std::to_string(place.x) + ", " + std::to_string(place.y) + ")";
  }
  if (place.lane >= 0) text += ", lane " + std::to_string(place.lane);
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
void Scoreboard::boundary(Boundary b, std::size_t lane, const Record* expected, const ProbeSample& actual, Pack&& pack,
                          Locate&& locate) {
  const bool valid = expected != nullptr, actual_valid = (actual.valid >> lane & 1) != 0;
  if (!valid && !actual_valid) return;
  if (valid != actual_valid) {
    verdict_.timing = false;
    if (!first_) {
      Place place;
      place.lane = lane_to_name(lane);
      first_ = where(valid ? locate(*expected) : place) + ", stage " + boundary_name(b) + ", valid: expected " +
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
  const std::uint32_t* words = actual.words[lane];
  if (!same_words(packed_.data(), words, words_for(layout.bits()))) payload_differs(b, words, locate(*expected));
}

void Scoreboard::follow(const ClockedProbes& probes) {
  if (probes.setup != nullptr) quad_of_slot_[probes.setup->slot % quad_of_slot_.size()] = probes.setup_quad;
  if (probes.tile != nullptr) {
    const std::size_t quad = quad_of_slot_[probes.tile->slot % quad_of_slot_.size()];
    ring_[ring_write_] = {quad, probes.tile->tile_x, probes.tile->tile_y};
    // A tile of a homogeneous quad takes an entry for each part of its functions.
    const SnappedQuad* of = quad_at(quad);
    const bool parts = !probes.tile->end && of != nullptr && !is_ordinary(*of, config_);
    ring_write_ = (ring_write_ + (parts ? latency::homogeneous_parts : 1)) % ring_.size();
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
    boundary(Boundary::setup, 0, p.setup, probe(Boundary::setup), pack,
             [&](const SetupResult&) { return Place{quad_at(p.setup_quad)}; });
    boundary(Boundary::tile, 0, p.tile, probe(Boundary::tile), pack, [&](const TileEntry& t) {
      return Place{quad_at(quad_of_slot_[t.slot % quad_of_slot_.size()]), t.end ? -1 : t.tile_x, t.tile_y, "tile"};
    });
    boundary(Boundary::stamp, 0, p.stamp, probe(Boundary::stamp), pack, [&](const StampEntry& s) {
      const RingPlace& ring = ring_[s.tile_ptr % ring_.size()];
      return Place{quad_at(ring.quad), s.end ? -1 : ring.tile_x * config_.tile(), ring.tile_y * config_.tile() + s.row,
                   "row at"};
    });
    const auto pixels = [&](Boundary b, const PixelTrace* LaneProbes::*trace) {
      for (std::size_t lane = 0; lane < lanes_; ++lane) {
        boundary(
            b, lane, p.lane[lane].*trace, probe(b),
            [&, b](const PixelTrace& t, BitPacker& packer) { visit(t, b, config_, packer); },
            [&](const PixelTrace& t) {
              return Place{quad_at(quad_of_slot_[t.slot % quad_of_slot_.size()]), t.x, t.y, "pixel",
                           lane_to_name(lane)};
            });
      }
    };
    pixels(Boundary::diff, &LaneProbes::diff);
    pixels(Boundary::norm, &LaneProbes::norm);
    pixels(Boundary::sqrt, &LaneProbes::sqrt);
    pixels(Boundary::ratio, &LaneProbes::ratio);
    pixels(Boundary::weight, &LaneProbes::weight);
    pixels(Boundary::sum, &LaneProbes::sum);
    follow(p);
  }

  // Ports. The fragments' bits are compared in every clock: they are zero in a lane that has none.
  const auto fragment_place = [&](std::size_t lane) {
    Place place;
    const Fragment* fragment = expected.fragment[lane];
    if (fragment == nullptr) return place;
    const auto quad = std::find_if(quads_.begin(), quads_.end(), [&](const auto& q) { return q.id == fragment->quad; });
    if (quad != quads_.end()) place.quad = &*quad;
    place.x = fragment->x;
    place.y = fragment->y;
    return place;
  };
  const auto first_place = [&] {
    return fragment_place(expected.fragment_valid ? std::countr_zero(expected.fragment_mask()) : 0);
  };
  signal("fragment_valid", expected.fragment_valid, actual.fragment_valid, first_place);
  signal("fragment_mask", expected.fragment_mask(), actual.fragment_mask, first_place);
  const RecordLayout& layout = layouts_[index_of(Boundary::fragment)];
  BoundaryCount& count = counts_[index_of(Boundary::fragment)];
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    if (expected.fragment[lane] != nullptr) {
      BitPacker packer(packed_.data(), layout.bits());
      visit(*expected.fragment[lane], config_, packer);
      packer.finish();
      ++count.beats;
    } else {
      std::memset(packed_.data(), 0, packed_.size() * sizeof packed_[0]);
    }
    count.bits += static_cast<std::uint64_t>(layout.bits());
    if (!same_words(packed_.data(), actual.fragment[lane], words_for(layout.bits()))) {
      Place place = fragment_place(lane);
      place.lane = lane_to_name(lane);
      payload_differs(Boundary::fragment, actual.fragment[lane], place);
    }
  }
  const auto nowhere = [] { return Place{}; };
  signal("vertex_ready", expected.vertex_ready, actual.vertex_ready, nowhere);
  signal("busy", expected.busy, actual.busy, nowhere);

  if (!verdict_.timing) ++cycle_mismatches_;
  return verdict_;
}

void Scoreboard::compare_counters(std::uint64_t cycle, const PerformanceCounters& expected, Device& actual) {
  cycle_ = cycle;
  constexpr std::size_t indices = std::bit_ceil(counter_count);  // those behind the last one read 0
  for (std::size_t i = 0; i < indices; ++i) {
    const auto wanted = i < counter_count ? static_cast<std::uint32_t>(expected.value[i]) : 0;
    const std::uint32_t got = actual.counter(i);
    if (got == wanted) continue;
    ++mismatches_;
    if (!first_)
      first_ = where({}) + ", performance counter " +
               (i < counter_count ? std::string(counter_info[i].name) : std::to_string(i)) + ": expected " +
               std::to_string(wanted) + ", actual " + std::to_string(got) + "; seed " + std::to_string(seed_);
  }
}

void Scoreboard::device_stopped(std::uint64_t cycle, const std::string& why) {
  cycle_ = cycle;
  ++mismatches_;
  if (!first_) first_ = where({}) + ", the RTL stopped: " + why + "; seed " + std::to_string(seed_);
}

}  // namespace quadrille::tb
