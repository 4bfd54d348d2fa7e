// The journal: what was finished survives interruption, damage is refused and named.
#include "tb/sweep/store.hpp"

#include "golden/io/error.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

namespace quadrille::sweep {
namespace {

namespace fs = std::filesystem;

class StoreTest : public testing::Test {
 protected:
  StoreTest() {
    std::string pattern = (fs::temp_directory_path() / "quadrille_store_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary directory");
    directory_ = pattern;
  }
  ~StoreTest() override { fs::remove_all(directory_); }

  std::string journal() const { return (directory_ / "journal.jsonl").string(); }
  std::string read() const {
    std::ifstream in(journal(), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& text) const { std::ofstream(journal(), std::ios::binary) << text; }
  std::string refusal() const {
    try {
      Store(directory_, identity, Store::Existing::resume);
    } catch (const golden::InputError& error) {
      return error.what();
    }
    return {};
  }

  /// Two points, the second refused; numbers that decimal text must not change.
  static Batch batch() {
    Batch b;
    b.points = {0, 1};
    b.results.resize(2);
    PointResult& r = b.results[0];
    r.fragments = 12345678901234567;
    r.arithmetic[0] = {7, 0x1.fffffffffffffp-20, 1.0 / 3, 0x1p-1074, 0.1};
    r.arithmetic[2] = {3, std::numeric_limits<double>::infinity(), 1, 2, 3};
    r.snapping[3] = {1, 1e-300, 0, 0, 0};
    r.coverage_gained = 1, r.coverage_lost = 2, r.discard_differs = 3, r.colour_codes = 4, r.saturated = 5,
    r.cycles = 6, r.quads = 12, r.plane_quads = 13, r.plane_fragments = 14;
    r.worst = {true, 9, 10, 11, 0.7};
    r.attribute_spread = 0.3, r.depth_spread = std::numeric_limits<double>::infinity();
    b.results[1].refused = "a \"quoted\" reason,\nwith a line break";
    b.executed.settings[2] = 1;
    b.executed.fragments[2] = 100;
    b.seconds = 0.25;
    return b;
  }

  const nlohmann::ordered_json identity{{"input", "x"}, {"seed", 1}};
  fs::path directory_;
};

void expect_equal(const ErrorSummary& a, const ErrorSummary& b) {
  EXPECT_EQ(a.count, b.count);
  EXPECT_EQ(a.max, b.max);
  EXPECT_EQ(a.p999, b.p999);
  EXPECT_EQ(a.rms, b.rms);
  EXPECT_EQ(a.mean, b.mean);
}

TEST_F(StoreTest, GoesOnWithWhatWasFinished) {
  const std::array<std::size_t, 2> rows{40, 2};
  {
    Store store(directory_, identity, Store::Existing::resume);
    EXPECT_TRUE(store.results().empty());
    store.append(batch(), rows);
  }
  Store store(directory_, identity, Store::Existing::resume);
  ASSERT_EQ(store.results().size(), 2u);
  const PointResult expected = batch().results[0], &found = store.results().at(40);
  for (std::size_t q = 0; q < 4; ++q) {
    expect_equal(found.arithmetic[q], expected.arithmetic[q]);
    expect_equal(found.snapping[q], expected.snapping[q]);
  }
  EXPECT_EQ(found.fragments, 12345678901234567u);
  EXPECT_EQ(found.coverage_gained, 1u);
  EXPECT_EQ(found.coverage_lost, 2u);
  EXPECT_EQ(found.discard_differs, 3u);
  EXPECT_EQ(found.colour_codes, 4u);
  EXPECT_EQ(found.saturated, 5u);
  EXPECT_EQ(found.cycles, 6u);
  EXPECT_EQ(found.quads, 12u);
  EXPECT_EQ(found.plane_quads, 13u);
  EXPECT_EQ(found.plane_fragments, 14u);
  EXPECT_TRUE(found.worst.any);
  EXPECT_EQ(found.worst.index, 9u);
  EXPECT_EQ(found.worst.x, 10);
  EXPECT_EQ(found.worst.y, 11);
  EXPECT_EQ(found.worst.error, 0.7);
  EXPECT_EQ(found.attribute_spread, 0.3);
  EXPECT_EQ(found.depth_spread, std::numeric_limits<double>::infinity());
  EXPECT_EQ(store.results().at(2).refused, batch().results[1].refused);
  EXPECT_EQ(store.counters().settings[2], 1u);
  EXPECT_EQ(store.counters().fragments[2], 100u);
  ASSERT_EQ(store.timings().size(), 1u);
  EXPECT_EQ(store.timings()[0].points, 2u);
}

TEST_F(StoreTest, MergesWhatItLacksAndRefusesWhatDiffers) {
  const fs::path first = directory_ / "first", second = directory_ / "second", other = directory_ / "other";
  const std::array<std::size_t, 2> a{0, 1}, b{1, 7}, swapped{1, 0};
  Batch again = batch();
  again.results = {again.results[1], again.results[0]};  // row 1 the same as in the first
  Store(first, identity, Store::Existing::resume).append(batch(), a);
  Store(second, identity, Store::Existing::resume).append(again, b);
  Store(other, identity, Store::Existing::resume).append(batch(), swapped);
  {
    Store store(directory_ / "whole", identity, Store::Existing::resume);
    store.merge(first);
    store.merge(second);
    store.merge(first);  // nothing is there twice
    EXPECT_EQ(store.results().size(), 3u);
    EXPECT_EQ(store.results().at(7).fragments, 12345678901234567u);
    EXPECT_EQ(store.counters().settings[2], 2u);
    ASSERT_EQ(store.timings().size(), 2u);
    EXPECT_EQ(store.timings()[1].seconds, 0.25);
    EXPECT_THROW(store.merge(other), golden::InputError);
    EXPECT_THROW(store.merge(directory_ / "nowhere"), golden::InputError);
  }
  EXPECT_EQ(Store(directory_ / "whole", identity, Store::Existing::resume).results().size(), 3u);
  nlohmann::ordered_json stranger = identity;
  stranger["seed"] = 2;
  Store store(directory_ / "stranger", stranger, Store::Existing::resume);
  EXPECT_THROW(store.merge(first), golden::InputError);
}

TEST_F(StoreTest, TornLastLineIsDropped) {
  const std::array<std::size_t, 2> rows{0, 1}, more{2, 3};
  {
    Store store(directory_, identity, Store::Existing::resume);
    store.append(batch(), rows);
  }
  const std::string whole = read();
  {
    Store store(directory_, identity, Store::Existing::resume);
    store.append(batch(), more);
  }
  const std::string longer = read();
  for (const std::size_t length : {whole.size(), whole.size() + 1, longer.size() - 1}) {
    write(longer.substr(0, length));
    Store store(directory_, identity, Store::Existing::resume);
    EXPECT_EQ(store.results().size(), 2u) << length;
    store.append(batch(), more);
    EXPECT_EQ(read(), longer) << length;
  }
}

TEST_F(StoreTest, EveryFlippedBitIsFound) {
  {
    const std::array<std::size_t, 2> rows{0, 1};
    Store store(directory_, identity, Store::Existing::resume);
    store.append(batch(), rows);
  }
  const std::string whole = read();
  ASSERT_TRUE(refusal().empty());
  for (std::size_t i = 0; i + 1 < whole.size(); ++i) {  // the last line's end apart: without it the line is torn
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << i % 7));
    write(damaged);
    EXPECT_NE(refusal().find("journal.jsonl:"), std::string::npos) << "byte " << i;
    EXPECT_EQ(read(), damaged) << "a refused journal must stay as it is";
  }
}

TEST_F(StoreTest, AnotherSweepIsRefusedByName) {
  { Store store(directory_, identity, Store::Existing::resume); }
  {
    nlohmann::ordered_json other = identity;
    other["seed"] = 2;
    EXPECT_THROW(Store(directory_, other, Store::Existing::resume), golden::InputError);
    try {
      Store(directory_, other, Store::Existing::resume);
    } catch (const golden::InputError& error) {
      EXPECT_NE(std::string(error.what()).find("seed"), std::string::npos) << error.what();
    }
    Store fresh(directory_, other, Store::Existing::discard);
    EXPECT_TRUE(fresh.results().empty());
  }
  EXPECT_NE(refusal().find("seed"), std::string::npos);
}

TEST_F(StoreTest, OneWriterAtATime) {
  Store first(directory_, identity, Store::Existing::resume);
  EXPECT_NE(refusal().find("another sweep is writing"), std::string::npos);
  EXPECT_THROW(Store(directory_, identity, Store::Existing::discard), golden::InputError);
  // and what the first one writes is still there
  const std::array<std::size_t, 2> rows{0, 1};
  first.append(batch(), rows);
  const std::string text = read();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
}

TEST_F(StoreTest, FreshForgets) {
  const std::array<std::size_t, 2> rows{0, 1};
  {
    Store store(directory_, identity, Store::Existing::resume);
    store.append(batch(), rows);
    std::ofstream(store.file("manifest.json")) << "{}";
  }
  EXPECT_EQ(Store(directory_, identity, Store::Existing::resume).results().size(), 2u);
  EXPECT_TRUE(fs::exists(directory_ / "manifest.json"));
  EXPECT_EQ(Store(directory_, identity, Store::Existing::discard).results().size(), 0u);
  EXPECT_FALSE(fs::exists(directory_ / "manifest.json"));
}

TEST_F(StoreTest, FullDiskKeepsWhatIsFinished) {
  // A limit of the file's size stands for a full disk.
  const std::array<std::size_t, 2> rows{0, 1};
  const pid_t child = ::fork();
  if (child == 0) {
    Store store(directory_, identity, Store::Existing::resume);
    store.append(batch(), rows);
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{fs::file_size(journal()) + 100, RLIM_INFINITY};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      store.append(batch(), rows);
    } catch (const golden::InputError& error) {
      const std::string text = error.what();
      ::_exit(text.find("points are kept") != std::string::npos ? 7 : 8);
    }
    ::_exit(9);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 7);
  Store store(directory_, identity, Store::Existing::resume);
  EXPECT_EQ(store.results().size(), 2u);
}

}  // namespace
}  // namespace quadrille::sweep
