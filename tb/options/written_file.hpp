// Options that name a file to be written in a known format.
#pragma once

#include "tb/options/command_line.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// Makes `option` of `command` one that writes a file in the format of one of the endings (exr, png, …), which become
/// its type in the help. A name that ends like another known format is refused with what would be right. Names without
/// an ending, with one that no format here has, and "-" are left alone: they are of the first format.
CLI::Option* writes_one_of(const CLI::App& command, CLI::Option* option, const std::vector<std::string>& endings);
inline CLI::Option* writes_file(const CLI::App& command, CLI::Option* option, const std::string& ending) {
  return writes_one_of(command, option, {ending});
}

/// Whether a name has this ending, in upper or lower case.
bool has_ending(const std::string& path, std::string_view ending);

/// The same for a folder that is filled: a name like a file's is refused unless the folder is there already.
CLI::Option* writes_folder(CLI::Option* option);

}  // namespace quadrille::tb
