// SPDX-License-Identifier: Apache-2.0
// Runs the board's design and is its screen: decodes the TMDS of its pins, and checks each word and the timing.
//
//   bench FRAMES FILE      writes that many frames after the first one, 640 x 480 bytes of red, green, blue each
//
// Prints "bench: N frames, M words, 0 errors". Exit status: 0, 1 errors, 2 usage.
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <vector>

#include "Vdemo_top.h"
#include "verilated.h"

namespace {

// 640x480 at 60 Hz (VESA DMT): sizes with blanking, and where the syncs begin and end.
constexpr unsigned kWidth = 640, kHeight = 480, kColumns = 800, kLines = 525;
constexpr unsigned kHsyncBegin = 656, kHsyncEnd = 752, kVsyncBegin = 490, kVsyncEnd = 492;
// Words of the blanking, for control bits 00, 01, 10, 11 (DVI 1.0, 3.2.2).
constexpr std::array<unsigned, 4> kControl{0b1101010100, 0b0010101011, 0b0101010100, 0b1010101011};
constexpr unsigned kClock = 0b0000011111;
constexpr int kLockWords = 64;  // until the PLL has locked and the words are aligned

struct Word {
  int control = -1;  // of the blanking; -1: a byte of a pixel
  std::uint8_t byte = 0;
  unsigned transitions = 0;
};

Word Decode(unsigned bits) {
  Word word;
  for (int code = 0; code < 4; ++code) {
    if (bits == kControl[static_cast<std::size_t>(code)]) {
      word.control = code;
      return word;
    }
  }
  const unsigned coded = (bits & 0x200u) != 0 ? ~bits & 0xffu : bits & 0xffu;
  const bool is_xor = (bits & 0x100u) != 0;
  word.byte = coded & 1u;
  for (unsigned i = 1; i < 8; ++i) {
    const bool changes = ((coded >> i ^ coded >> (i - 1)) & 1u) != 0;
    word.transitions += changes ? 1 : 0;
    word.byte |= static_cast<std::uint8_t>((changes == is_xor ? 1u : 0u) << i);
  }
  return word;
}

class Screen {
 public:
  Screen(unsigned frames, const char* path)
      : frames_(frames), file_(path, std::ios::binary), pixels_(kWidth * kHeight * 3) {}

  bool Done() const { return written_ == frames_ || errors_ > 10; }

  // A word of each pin: blue, green, red, clock.
  void Take(const std::array<unsigned, 4>& bits) {
    ++words_;
    std::array<Word, 3> channels;
    for (std::size_t c = 0; c < 3; ++c) {
      channels[c] = Decode(bits[c]);
      CheckBalance(c, channels[c], bits[c]);
    }
    const bool vsync = channels[0].control == 0 || channels[0].control == 1;  // low
    if (line_ == kLines) {                                                    // the first sync says where the words are
      if (!vsync) return;
      column_ = 0;
      line_ = kVsyncBegin;
    }
    const bool visible = column_ < kWidth && line_ < kHeight;
    const int syncs =
        (line_ >= kVsyncBegin && line_ < kVsyncEnd ? 0 : 2) + (column_ >= kHsyncBegin && column_ < kHsyncEnd ? 0 : 1);
    for (std::size_t c = 0; c < 3; ++c) {
      if (channels[c].control != (visible ? -1 : c == 0 ? syncs : 0))
        Error("a word that the timing does not have here");
      if (visible) pixels_[(line_ * kWidth + column_) * 3 + (2 - c)] = channels[c].byte;
    }
    if (bits[3] != kClock) Error("the clock's word");
    if (++column_ == kColumns) {
      column_ = 0;
      if (++line_ == kHeight && !Done()) {
        file_.write(reinterpret_cast<const char*>(pixels_.data()), static_cast<std::streamsize>(pixels_.size()));
        ++written_;
      }
      line_ %= kLines;
    }
  }

  int Report() {
    file_.close();
    if (!file_) Error("the file cannot be written");
    std::printf("bench: %u frames, %llu words, %u errors\n", written_, words_, errors_);
    return errors_ == 0 ? 0 : 1;
  }

 private:
  // At most 3 transitions in a byte; ones less zeros since the line began stay small.
  void CheckBalance(std::size_t channel, const Word& word, unsigned bits) {
    int& balance = balance_[channel];
    balance = word.control >= 0 ? 0 : balance + 2 * std::popcount(bits) - 10;
    if (word.transitions > 3) Error("more transitions than needed");
    if (std::abs(balance) > 10) Error("ones and zeros are out of balance");
  }

  void Error(const char* what) {
    if (errors_++ < 5) std::printf("bench: frame %u, line %u, column %u: %s\n", written_, line_, column_, what);
  }

  unsigned frames_, written_ = 0, errors_ = 0;
  std::ofstream file_;
  std::vector<std::uint8_t> pixels_;
  unsigned column_ = 0, line_ = kLines;  // kLines: not known
  std::array<int, 3> balance_{};
  unsigned long long words_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc == 3 ? std::atoi(argv[1]) : 0;
  if (frames < 1) {
    std::fprintf(stderr, "usage: bench FRAMES FILE\n");
    return 2;
  }
  const auto context = std::make_unique<VerilatedContext>();
  const auto top = std::make_unique<Vdemo_top>(context.get());
  Screen screen(static_cast<unsigned>(frames), argv[2]);
  std::array<unsigned, 4> bits{};
  unsigned count = 0;
  int settle = kLockWords;
  bool clock_before = false;
  for (std::uint64_t limit = (frames + 3ull) * kColumns * kLines * 10; limit != 0 && !screen.Done(); --limit) {
    top->clk_i = top->clk_i == 0 ? 1 : 0;
    top->eval();
    const bool clock = (top->gpdi_o & 8u) != 0;
    if (clock && !clock_before) {  // the clock rises where a word begins
      if (settle > 0) {
        --settle;
      } else if (count == 10) {
        screen.Take(bits);
      } else {
        std::printf("bench: a word of %u bits\n", count);
        return 1;
      }
      count = 0;
      bits = {};
    }
    clock_before = clock;
    if (count < 10) {
      for (unsigned pin = 0; pin < 4; ++pin) bits[pin] |= (top->gpdi_o >> pin & 1u) << count;
    }
    ++count;
  }
  if (!screen.Done()) std::printf("bench: too few frames\n");
  const int status = screen.Report();
  top->final();
  return screen.Done() ? status : 1;
}
