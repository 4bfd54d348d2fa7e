// Every target over its kept corpus, and over the same with damage, the same in every run: without a fuzzer, so that
// what one found once stays found.
#include "model/support/prng.hpp"
#include "tb/verify/fuzz/fuzz_target.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::fuzz {

void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

/// The files of a target by their paths.
std::map<std::string, Bytes> corpus(const Target& target) {
  std::map<std::string, Bytes> files;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(QUADRILLE_SOURCE_DIR) / target.corpus)) {
    if (!entry.is_regular_file() || (!target.file.empty() && entry.path().filename() != target.file)) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    files[entry.path()] = Bytes(std::istreambuf_iterator<char>(in), {});
  }
  return files;
}

/// What readers of text have a special case for.
constexpr std::string_view tokens[]{
    "nan", "-inf", "1e999", "1e-400", "99999999999999999999", "-1", "//", "\\\n", "\r", "#", "\"", "'''", "[[[[", "]",
    "{",   "}",    "=",     "\xff"};

/// A byte other, gone, twice, or that of another file; a double with another exponent; a token more.
Bytes damaged(Bytes bytes, const Bytes& other, golden::Prng& prng) {
  for (std::uint64_t n = 1 + prng.below(4); n > 0 && !bytes.empty(); --n) {
    const auto at = static_cast<std::ptrdiff_t>(prng.below(bytes.size()));
    switch (prng.below(6)) {
      case 0:
        bytes[static_cast<std::size_t>(at)] ^= static_cast<std::uint8_t>(1u << prng.below(8));
        break;
      case 1:
        bytes[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(prng.next());
        break;
      case 2:
        bytes.erase(bytes.begin() + at);
        break;
      case 3:
        bytes.insert(bytes.begin() + at, bytes[static_cast<std::size_t>(at)]);
        break;
      case 4: {
        const std::string_view token = tokens[prng.below(std::size(tokens))];
        bytes.insert(bytes.begin() + at, token.begin(), token.end());
        break;
      }
      default:
        if (other.empty()) break;
        const std::size_t from = prng.below(other.size());
        const std::size_t length =
            std::min({other.size() - from, bytes.size() - static_cast<std::size_t>(at), std::size_t{8}});
        std::copy_n(other.begin() + static_cast<std::ptrdiff_t>(from), length, bytes.begin() + at);
    }
  }
  return bytes;
}

class FuzzTarget : public testing::TestWithParam<Target> {};
INSTANTIATE_TEST_SUITE_P(Targets, FuzzTarget, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& target) { return std::string(target.param.name); });

TEST_P(FuzzTarget, Corpus) {
  int accepted = 0;
  for (const auto& [name, bytes] : corpus(GetParam())) {
    SCOPED_TRACE(name);
    EXPECT_NO_THROW(accepted += GetParam().run(bytes) == Outcome::accepted);
  }
  EXPECT_GT(accepted, 0);
}

TEST_P(FuzzTarget, DamagedCorpus) {
  const std::map<std::string, Bytes> files = corpus(GetParam());
  ASSERT_FALSE(files.empty());
  golden::Prng prng(1);
  int refused = 0;
  for (int i = 0; i < GetParam().damaged; ++i) {
    const auto file = std::next(files.begin(), static_cast<std::ptrdiff_t>(prng.below(files.size())));
    const auto other = std::next(files.begin(), static_cast<std::ptrdiff_t>(prng.below(files.size())));
    const Bytes bytes = damaged(file->second, other->second, prng);
    SCOPED_TRACE(file->first + ", input " + std::to_string(i));
    EXPECT_NO_THROW(refused += GetParam().run(bytes) == Outcome::refused);
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace quadrille::fuzz
