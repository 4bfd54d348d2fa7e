// Manifests for responses of one's own.
#include "golden/io/atomic_file.hpp"
#include "golden/io/text_input.hpp"
#include "golden/vectors/manifest_parts.hpp"
#include "golden/vectors/memory_file.hpp"

namespace quadrille::vectors {

namespace {

/// What someone else's device fills in.
bool is_response(const std::string& name) {
  return name == "response.hex" || name == "beats.hex" || name.ends_with(".exr");
}

/// New contents of files.
using Contents = std::map<fs::path, std::string>;

/// Adds the suite's manifest for the files as they are, and responses that a simulator wrote as this project would
/// have. Returns the manifest.
std::string sealed_manifest(const fs::path& directory, Contents& contents) {
  const std::string file = (directory / manifest_name).string();
  Json manifest = parse_manifest(file, read_manifest(file, "the manifest of a suite"));
  require_format(file, manifest);
  std::map<std::string, int> bits;
  for (const auto& [role, record] : object_member(file, manifest, "records").items()) {
    if (!record.is_object()) throw input_error(file, 0, "record " + golden::in_quotes(role) + " is no object");
    bits[text_member(file, record, "file")] = read_layout(file, role, record).bits();
  }
  std::map<std::string, std::uint64_t> lines;
  object_member(file, manifest, "files");
  for (auto& [name, entry] : manifest["files"].items()) {
    if (!plain_name(name)) throw input_error(file, 0, golden::in_quotes(name) + " is no name of a suite's file");
    if (!entry.is_object()) throw input_error(file, 0, "files: " + name + " is no object");
    const fs::path path = directory / name;
    std::error_code error;
    if (!fs::is_regular_file(fs::symlink_status(path, error)))
      throw input_error(path.string(), 0, "is no regular file");
    FileDigest digest = digest_file(path);
    if (bits.contains(name) && is_response(name)) {
      MemoryFile memory =
          read_memory_file(golden::read_file(path.string(), "a file of records"), path.string(), bits[name]);
      lines[name] = memory.lines;
      if (const std::string hash = sha256(memory.records); hash != digest.sha256) {
        digest.sha256 = hash, digest.bytes = memory.records.size();
        contents[path] = std::move(memory.records);
      }
    } else if (bits.contains(name)) {
      lines[name] = count_records(path.string(), bits[name]);
    }
    if (!is_response(name) && digest.sha256 != text_member(file, entry, "sha256"))
      throw input_error(path.string(), 0,
                        "differs from the generated file; only response.hex and beats.hex may change");
    entry["sha256"] = digest.sha256;
    entry["bytes"] = digest.bytes;
    if (lines.contains(name)) entry["lines"] = lines[name];
  }
  const bool machine = text_member(file, manifest, "kind") == "machine";
  const std::string response = machine ? "beats.hex" : "response.hex";
  if (lines[response] != lines["stimulus.hex"])
    throw input_error((directory / response).string(), std::min(lines[response], lines["stimulus.hex"]) + 1,
                      "the file has " + std::to_string(lines[response]) + " lines; stimulus.hex has " +
                          std::to_string(lines["stimulus.hex"]) + ", and each needs one");
  object_member(file, manifest, "counts");
  manifest["counts"]["vectors"] = lines["response.hex"];
  return contents[directory / manifest_name] = manifest_text(manifest);
}

}  // namespace

void seal_set(const fs::path& directory) {
  const std::string file = (directory / manifest_name).string();
  Json manifest = parse_manifest(file, read_manifest(file, "the manifest of a set of vectors"));
  require_format(file, manifest);
  object_member(file, manifest, "suites");
  // Nothing is written before every suite is right.
  Contents contents;
  for (auto& [name, entry] : manifest["suites"].items()) {
    if (!plain_name(name) || !entry.is_object()) throw input_error(file, 0, golden::in_quotes(name) + " is no suite");
    entry["sha256"] = sha256(sealed_manifest(directory / name, contents));
  }
  for (const auto& [path, text] : contents) golden::write_file(path.string(), text, golden::AtomicFile::Dash::refused);
  golden::write_file(file, manifest_text(manifest), golden::AtomicFile::Dash::refused);
}

}  // namespace quadrille::vectors
