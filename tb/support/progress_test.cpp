// Progress lines: their text, and what a terminal gets to see of them.
#include "tb/support/progress.hpp"

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

namespace quadrille::tb {
namespace {

TEST(ProgressText, FitsAndKeepsWhatMattersFirst) {
  const std::string wide = progress_text("sweep", 25, 100, 10, "3 of 12", 100, true);
  EXPECT_EQ(wide, "sweep  [########........................] 25 %  10 s, about 30 s left  3 of 12");
  EXPECT_EQ(progress_text("sweep", 25, 100, 10, "3 of 12", 60, true),
            "sweep  [###...........] 25 %  10 s, about 30 s left  3 of 12");
  EXPECT_EQ(progress_text("sweep", 25, 100, 10, "3 of 12", 45, true), "sweep  25 %  10 s, about 30 s left  3 of 12");
  EXPECT_EQ(progress_text("sweep", 25, 100, 10, "3 of 12", 12, true), "sweep  25 % ");
  EXPECT_EQ(progress_text("sweep", 25, 100, 10, "", 0, true), "");
  EXPECT_EQ(progress_text("gr\xc3\xbc\x1b[2J", 7, 0, 1, "", 80, true), "gr???[2J  7  1 s");
  EXPECT_EQ(progress_text("a", 9, 3, 100, "", 30, true), "a  100 %  100 s, about 0 s lef");  // more than was said
}

// Two seconds or two parts in a hundred say nothing about the rest.
TEST(ProgressText, EstimatesOnlyWithABasis) {
  EXPECT_EQ(progress_text("a", 1, 100, 50, "", 40, false), "a  1 %  50 s");
  EXPECT_EQ(progress_text("a", 50, 100, 1, "", 40, false), "a  50 %  1 s");
  EXPECT_EQ(progress_text("a", 50, 100, 4, "", 40, false), "a  50 %  4 s, about 4 s left");
}

/// A terminal of this size: the text of its lines after these bytes, and how often it scrolled or went to a new line.
struct Screen {
  int columns = 0, line = 0, column = 0;
  std::string text;  ///< of the line with the cursor
  void take(const std::string& bytes) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      if (bytes[i] == '\r') {
        column = 0;
      } else if (bytes[i] == '\n') {
        ++line, text.clear();
      } else if (bytes.compare(i, 3, "\033[K") == 0) {
        text.resize(static_cast<std::size_t>(column)), i += 2;
      } else {
        if (column == columns) ++line, column = 0, text.clear();
        text.resize(std::max(text.size(), static_cast<std::size_t>(column) + 1), ' ');
        text[static_cast<std::size_t>(column++)] = bytes[i];
      }
    }
  }
};

/// Runs `body` with a terminal as its standard error, `resize` columns after its first bytes.
Screen on_terminal(unsigned short columns, unsigned short resize, void (*body)()) {
  winsize size{16, columns, 0, 0};
  int terminal = -1;
  const pid_t pid = ::forkpty(&terminal, nullptr, nullptr, &size);
  if (pid == 0) {
    body();
    ::_exit(0);
  }
  Screen screen;
  screen.columns = std::min<int>(columns, resize);
  char buffer[4096];
  bool first = true;
  for (ssize_t n; (n = ::read(terminal, buffer, sizeof buffer)) > 0;) {
    if (!first) screen.take({buffer, static_cast<std::size_t>(n)});  // the first may be of the old width
    if (first) {
      size.ws_col = resize;
      ::ioctl(terminal, TIOCSWINSZ, &size);
    }
    first = false;
  }
  ::close(terminal);
  ::waitpid(pid, nullptr, 0);
  return screen;
}

void long_lines() {
  Progress progress("a label of some length, such as the name of a mesh file", 100, true);
  for (std::uint64_t i = 0; i < 8; ++i) {
    ::usleep(110'000);
    progress.set(i, "with a detail that does not fit on eighty columns at all, and says so at length");
  }
}

TEST(Progress, StaysOnOneLineOfATerminal) {
  for (const std::uint16_t resize : std::initializer_list<std::uint16_t>{80, 50, 20}) {
    const Screen screen = on_terminal(80, resize, long_lines);
    EXPECT_EQ(screen.line, 0) << resize;
    EXPECT_EQ(screen.text, "");  // wiped
  }
}

TEST(Progress, SaysNothingInALogAtFirst) {
  ::testing::internal::CaptureStderr();
  {
    Progress progress("quick", 4, true);
    for (std::uint64_t i = 0; i < 4; ++i) progress.set(i);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace quadrille::tb
