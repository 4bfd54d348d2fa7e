// Files of hexadecimal words as simulators write and read them ($writememh, $readmemh).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace quadrille::vectors {

struct MemoryFile {
  std::string records;  ///< a record a line in small letters, as this project writes them
  std::uint64_t lines = 0;
};

/// Reads what IEEE 1800 allows in such a file: blanks and line ends of any kind between words, // and /* */ comments,
/// `_` between digits, capitals, and addresses (@hex) that say what comes next anyway. Words have the digits of a
/// record of so many bits. `name` stands for the file. Throws golden::InputError with the line for anything else, for
/// an address that leaves a gap or goes back, and for digits x and z.
MemoryFile read_memory_file(std::string_view text, const std::string& name, int bits);

}  // namespace quadrille::vectors
