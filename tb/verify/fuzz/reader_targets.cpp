#include "golden/io/camera.hpp"
#include "golden/io/config_file.hpp"
#include "golden/io/error.hpp"
#include "golden/io/exr.hpp"
#include "golden/io/obj.hpp"
#include "golden/io/png.hpp"
#include "golden/io/quads_file.hpp"
#include "golden/io/temporary.hpp"
#include "golden/vectors/manifest.hpp"
#include "golden/vectors/sha256.hpp"
#include "model/port/config_text.hpp"
#include "tb/sweep/store.hpp"
#include "tb/verify/fuzz/fuzz_target.hpp"

#include <zlib.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace quadrille::fuzz {
namespace {

std::string text_of(std::span<const std::uint8_t> input) { return {input.begin(), input.end()}; }

void require(bool holds, const char* what) {
  if (!holds) throw Fault(what);
}

/// Accepted unless read() refuses by an InputError, whose message must name the place.
template <class Read>
Outcome outcome_of(std::string_view place, Read&& read) {
  try {
    read();
  } catch (const golden::InputError& error) {
    if (!std::string_view(error.what()).starts_with(place)) throw Fault(std::string("names no place: ") + error.what());
    return Outcome::refused;
  }
  return Outcome::accepted;
}

void write(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream out(path, std::ios::binary);
  if (!(out << bytes).flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

/// A file with the input, for readers that take a path.
class InputFile {
 public:
  InputFile(std::string_view bytes, const char* name)
      : folder_(std::filesystem::temp_directory_path(), golden::Temporary::Kind::folder), path_(folder_.path() / name) {
    write(path_, bytes);
  }
  std::string path() const { return path_.string(); }
  std::string folder() const { return folder_.path().string(); }

 private:
  golden::Temporary folder_;
  std::filesystem::path path_;
};

// Readers of texts and files: an InputError (or ConfigError) that names the place, or a value that survives being
// written and read, where there is a writer.

Outcome read_obj(std::span<const std::uint8_t> input) {
  return outcome_of("file", [&] { golden::parse_obj(text_of(input), "file"); });
}

Outcome read_quads(std::span<const std::uint8_t> input) {
  return outcome_of("file", [&] { require(!golden::parse_quads(text_of(input), "file").empty(), "no quad"); });
}

Outcome read_camera(std::span<const std::uint8_t> input) {
  return outcome_of("file", [&] {
    const golden::Camera camera = golden::parse_camera(text_of(input), "file");
    const std::string text = golden::camera_text(camera);
    require(golden::camera_text(golden::parse_camera(text, "file")) == text, "written and read, another camera");
  });
}

Outcome read_config(std::span<const std::uint8_t> input) {
  return outcome_of("file", [&] {
    Config config;
    golden::parse_config(text_of(input), "file", config);
    CostWeights weights;
    golden::parse_cost_weights(text_of(input), "file", weights);
    Config again;
    golden::parse_config(golden::config_text(config, weights), "file", again);
    require(again == config, "written and read, another configuration");
  });
}

Outcome read_config_text(std::span<const std::uint8_t> input) {
  Config config;
  try {
    apply_config_text(text_of(input), config);
  } catch (const ConfigError&) {
    require(config == Config{}, "refused, and changed all the same");
    return Outcome::refused;
  }
  return Outcome::accepted;
}

Outcome read_png(std::span<const std::uint8_t> input) {
  const InputFile file(text_of(input), "image.png");
  return outcome_of(file.path(), [&] {
    const golden::Image8 image = golden::load_png(file.path());
    require(image.rgba.size() == 4u * static_cast<unsigned>(image.width) * static_cast<unsigned>(image.height),
            "another size than it says");
  });
}

Outcome read_exr(std::span<const std::uint8_t> input) {
  const InputFile file(text_of(input), "image.exr");
  return outcome_of(file.path(), [&] { golden::load_exr(file.path()); });
}

Outcome read_manifest(std::span<const std::uint8_t> input) {
  // Spelled as a manifest is, where it is JSON, so that the reader gets beyond that.
  std::string text = text_of(input);
  const auto json = nlohmann::ordered_json::parse(text, nullptr, false);
  if (!json.is_discarded()) text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  const InputFile file(text, "manifest.json");
  const std::string name = json.is_object() && json.contains("suite") && json["suite"].is_string()
                               ? json["suite"].get<std::string>()
                               : "none";
  // The records that it names are not there: what comes to them has read the manifest to its end.
  bool to_its_end = false;
  const Outcome outcome = outcome_of(file.folder(), [&] {
    try {
      vectors::SuiteReader(file.folder(), name, vectors::sha256(text));
    } catch (const golden::InputError& error) {
      to_its_end = std::string_view(error.what()).find(".hex") != std::string_view::npos;
      throw;
    }
  });
  return to_its_end ? Outcome::accepted : outcome;
}

/// response.hex of a sealed set of vectors of sqrt: refused with the line, or all of it is read.
Outcome read_records(std::span<const std::uint8_t> input) {
  // A set of one kept suite, whose responses are the input: sealed, so that hashes do not keep it from the reader.
  static const vectors::SetReader kept(QUADRILLE_SOURCE_DIR "/golden/vectors/kept");
  static const vectors::SuiteReader suite = kept.suite("sqrt");
  const golden::Temporary folder(std::filesystem::temp_directory_path(), golden::Temporary::Kind::folder);
  const std::filesystem::path set = folder.path() / "set";
  vectors::SetWriter writer(set, kept.info(), false);
  writer.copy(suite);
  writer.commit(false);
  write(set / "sqrt" / "response.hex", text_of(input));
  return outcome_of(set.string(), [&] {
    vectors::seal_set(set);
    const vectors::SuiteReader reader = vectors::SetReader(set).suite("sqrt");
    const std::uint64_t lines = reader.lines("response");
    require(reader.read("response", 0, lines).size() == lines, "not every record was read");
  });
}

/// Lines of a sweep's journal behind its first, without their check sums.
Outcome read_journal(std::span<const std::uint8_t> input) {
  // Each line of the input as a line of the journal, with its check sum.
  const golden::Temporary folder(std::filesystem::temp_directory_path(), golden::Temporary::Kind::folder);
  const nlohmann::ordered_json identity{{"sweep", "any"}};
  std::istringstream lines(identity.dump() + "\n" + text_of(input));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    char sum[16];
    std::snprintf(sum, sizeof sum, "%08lx",
                  crc32(0, reinterpret_cast<const Bytef*>(line.data()), static_cast<uInt>(line.size())));
    text += std::string("{\"crc\":\"") + sum + "\",\"content\":" + line + "}\n";
  }
  write(folder.path() / "journal.jsonl", text);
  return outcome_of(folder.path().string(), [&] {
    const sweep::Store store(folder.path(), identity, sweep::Store::Existing::resume);
    require(store.results().empty() || !store.timings().empty(), "results of no batch");
  });
}

constexpr Target list[]{
    {"camera", "camera files", read_camera, "tb/verify/fuzz/corpus/camera", 4000},
    {"config", "configuration files with costs", read_config, "tb/verify/fuzz/corpus/config", 4000},
    {"config_text", "configurations of the C interface", read_config_text, "tb/verify/fuzz/corpus/config_text", 4000},
    {"exr", "OpenEXR pictures", read_exr, "tb/verify/fuzz/corpus/exr", 400},
    {"journal", "journals of sweeps", read_journal, "tb/verify/fuzz/corpus/journal", 400},
    {"manifest", "manifests of golden vectors", read_manifest, "golden/vectors/kept", 400, "manifest.json"},
    {"obj", "meshes", read_obj, "tb/verify/fuzz/corpus/obj", 4000},
    {"png", "PNG pictures", read_png, "tb/verify/fuzz/corpus/png", 400},
    {"quads", "files of quads", read_quads, "tb/verify/fuzz/corpus/quads", 4000},
    {"records", "records of golden vectors", read_records, "golden/vectors/kept/sqrt", 400, "response.hex"},
};

}  // namespace

std::span<const Target> targets() { return list; }

}  // namespace quadrille::fuzz
