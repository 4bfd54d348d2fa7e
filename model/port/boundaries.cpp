#include "model/port/boundaries.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace quadrille {
namespace {

constexpr std::array boundary_names{"setup", "tile",  "stamp",  "diff", "norm",
                                    "sqrt",  "ratio", "weight", "sum",  "fragment"};

/// Calls f with what visit() says of boundary `b`.
template <class F>
void list_boundary(Boundary b, const Config& c, F&& f) {
  const auto list = [&](auto record) { visit(record, c, f); };
  PixelTrace pixel;
  switch (b) {
    case Boundary::setup:
      return list(SetupResult{});
    case Boundary::tile:
      return list(TileEntry{});
    case Boundary::stamp:
      return list(StampEntry{});
    case Boundary::fragment:
      return list(Fragment{});
    default:
      return visit(pixel, b, c, f);
  }
}

template <class F>
void list_vertex(const Config& c, F&& f) {
  VertexBeat beat;
  visit(beat, c, f);
}

template <class F>
void list_state(const Config& c, F&& f) {
  DrawState state;
  std::uint32_t znear = 0, zfar = 0;
  visit_state(state, znear, zfar, c, f);
}

/// Arrays as one entry each.
class FieldLister {
 public:
  explicit FieldLister(std::string name) : description_{std::move(name), 0, {}} {}

  template <class T>
  void operator()(const FieldType& type, int index, const T&) {
    auto& fields = description_.fields;
    const auto same = std::ranges::find_if(
        fields, [&](const BoundaryField& f) { return index >= 0 && std::string_view(f.type.name) == type.name; });
    if (same == fields.end())
      fields.push_back({type, index < 0 ? 0 : 1});
    else
      ++same->count;
    description_.bits += type.width;
  }
  BoundaryDescription take() { return std::move(description_); }

 private:
  BoundaryDescription description_;
};

template <class List>
BoundaryDescription description(std::string name, List&& list) {
  FieldLister lister(std::move(name));
  list(lister);
  return lister.take();
}

}  // namespace

const char* boundary_name(Boundary b) { return boundary_names[static_cast<std::size_t>(b)]; }

RecordLayout boundary_layout(Boundary b, const Config& config) {
  return layout_of([&](auto& f) { list_boundary(b, config, f); });
}

RecordLayout vertex_layout(const Config& config) {
  return layout_of([&](auto& f) { list_vertex(config, f); });
}

RecordLayout state_layout(const Config& config) {
  return layout_of([&](auto& f) { list_state(config, f); });
}

std::vector<BoundaryDescription> describe_ports(const Config& c) {
  return {description("vertex_t", [&](auto& f) { list_vertex(c, f); }),
          description("state_t", [&](auto& f) { list_state(c, f); }),
          description("fragment_t", [&](auto& f) { list_boundary(Boundary::fragment, c, f); })};
}

std::vector<BoundaryDescription> describe_probes(const Config& c) {
  std::vector<BoundaryDescription> probes;
  for (std::size_t i = 0; i < boundary_names.size(); ++i)
    if (const auto b = static_cast<Boundary>(i); b != Boundary::fragment)
      probes.push_back(description(boundary_name(b), [&](auto& f) { list_boundary(b, c, f); }));
  return probes;
}

}  // namespace quadrille
