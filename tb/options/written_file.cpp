#include "tb/options/written_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace quadrille::tb {
namespace {

/// Endings that say what a file holds, and its name for people.
constexpr std::array<std::pair<std::string_view, std::string_view>, 33> formats{{
    {"bin", "binary data"},
    {"bmp", "BMP"},
    {"csv", "CSV"},
    {"exr", "OpenEXR"},
    {"fst", "an FST waveform"},
    {"gif", "GIF"},
    {"gz", "gzip"},
    {"hdr", "Radiance HDR"},
    {"hex", "hexadecimal data"},
    {"htm", "HTML"},
    {"html", "HTML"},
    {"jpeg", "JPEG"},
    {"jpg", "JPEG"},
    {"json", "JSON"},
    {"md", "Markdown"},
    {"npy", "a NumPy array"},
    {"npz", "NumPy arrays"},
    {"obj", "Wavefront OBJ"},
    {"parquet", "Parquet"},
    {"pdf", "PDF"},
    {"png", "PNG"},
    {"ppm", "PPM"},
    {"quads", "quads"},
    {"sv", "SystemVerilog"},
    {"svg", "SVG"},
    {"tga", "TGA"},
    {"tif", "TIFF"},
    {"tiff", "TIFF"},
    {"toml", "TOML"},
    {"v", "Verilog"},
    {"vcd", "a VCD waveform"},
    {"webp", "WebP"},
    {"zip", "a ZIP archive"},
}};

constexpr const char* validator_name = "written file";

/// In lower case, without the dot.
std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::string_view format_of(std::string_view ending) {
  const auto* const found = std::ranges::find(formats, ending, &std::pair<std::string_view, std::string_view>::first);
  return found == formats.end() ? std::string_view() : found->second;
}

/// "F.exr", "F.exr|F.npz".
std::string type_of(const std::vector<std::string>& endings) {
  std::string type;
  for (const std::string& ending : endings) type += (type.empty() ? "F." : "|F.") + ending;
  return type;
}

/// The option of the command that writes files with this ending; empty: none.
std::string writer_of(const CLI::App& command, const std::string& ending) {
  for (const CLI::Option* option : command.get_options()) {
    if (("|" + option->get_type_name() + "|").find("|F." + ending + "|") == std::string::npos) continue;
    try {
      static_cast<void>(const_cast<CLI::Option*>(option)->get_validator(validator_name));
      return option->get_name();
    } catch (const CLI::OptionNotFound&) {  // it reads them
    }
  }
  return {};
}

}  // namespace

bool has_ending(const std::string& path, std::string_view ending) { return ending_of(path) == ending; }

CLI::Option* writes_one_of(const CLI::App& command, CLI::Option* option, const std::vector<std::string>& endings) {
  const CLI::Validator validator(
      [&command, endings](std::string& path) -> std::string {
        const std::string given = ending_of(path);
        const std::string_view format = format_of(given);
        if (format.empty() || std::ranges::find(endings, given) != endings.end()) return {};
        std::string text = path + ": this option writes ";
        for (const std::string& ending : endings)
          text += (&ending == &endings.front() ? "" : " or ") + std::string(format_of(ending));
        text += ", not " + std::string(format) + "; expected a name such as " +
                std::filesystem::path(path).replace_extension(endings.front()).string();
        if (const std::string other = writer_of(command, given); !other.empty())
          text += ", or " + other + " for " + std::string(format);
        return text;
      },
      "", validator_name);
  return option->type_name(type_of(endings))->check(validator);
}

CLI::Option* writes_folder(CLI::Option* option) {
  const CLI::Validator validator(
      [](std::string& path) -> std::string {
        const std::string_view format = format_of(ending_of(path));
        std::error_code ignored;
        if (format.empty() || std::filesystem::is_directory(path, ignored)) return {};
        return path + ": this option writes a folder, not " + std::string(format) + "; expected a name such as " +
               std::filesystem::path(path).replace_extension().string();
      },
      "", validator_name);
  return option->type_name("DIR")->check(validator);
}

}  // namespace quadrille::tb
