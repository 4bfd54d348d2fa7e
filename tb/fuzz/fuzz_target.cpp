#include "tb/fuzz/fuzz_target.hpp"

#include "tb/fuzz/run_targets.hpp"

#include <algorithm>
#include <string>

namespace quadrille::fuzz {
namespace {

constexpr Target list[]{
    {"any_quad", "any four vertices through both engines, against the truth", draw_any_quad, "tb/fuzz/corpus/any_quad",
     400},
    {"camera", "camera files", read_camera, "tb/fuzz/corpus/camera", 4000},
    {"config", "configuration files with costs", read_config, "tb/fuzz/corpus/config", 4000},
    {"config_text", "configurations of the C interface", read_config_text, "tb/fuzz/corpus/config_text", 4000},
    {"exr", "OpenEXR pictures", read_exr, "tb/fuzz/corpus/exr", 400},
    {"journal", "journals of sweeps", read_journal, "tb/fuzz/corpus/journal", 400},
    {"manifest", "manifests of golden vectors", read_manifest, "golden/vectors/kept", 400, "manifest.json"},
    {"obj", "meshes", read_obj, "tb/fuzz/corpus/obj", 4000},
    {"png", "PNG pictures", read_png, "tb/fuzz/corpus/png", 400},
    {"quads", "files of quads", read_quads, "tb/fuzz/corpus/quads", 4000},
    {"records", "records of golden vectors", read_records, "tb/fuzz/corpus/records", 400},
};

}  // namespace

std::span<const Target> targets() { return list; }

const Target& target_named(std::string_view name) {
  const auto found = std::ranges::find(list, name, &Target::name);
  if (found == std::end(list)) throw std::invalid_argument("no target to fuzz is named " + std::string(name));
  return *found;
}

}  // namespace quadrille::fuzz
