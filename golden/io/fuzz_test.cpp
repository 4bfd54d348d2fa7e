// Random damage to good texts: each parser either accepts the result or throws InputError. Whatever else happens
// (another exception, a crash, a sanitizer report) fails the test.
#include "golden/io/camera.hpp"
#include "golden/io/config_file.hpp"
#include "golden/io/obj.hpp"
#include "golden/io/quads_file.hpp"
#include "golden/io/test_support.hpp"

#include <functional>
#include <random>
#include <string>

namespace quadrille::golden {
namespace {

constexpr int mutations_per_parser = 4000;

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string operator()(std::string text) {
    const std::size_t count = 1 + below(4);
    for (std::size_t i = 0; i < count; ++i) mutate(text);
    return text;
  }

 private:
  std::size_t below(std::size_t limit) { return random_() % limit; }

  void mutate(std::string& text) {
    static const std::string tokens[] = {"nan",
                                         "-inf",
                                         "1e999",
                                         "0",
                                         "-1",
                                         "99999999999999999999",
                                         "/",
                                         "//",
                                         "\\\n",
                                         "\r",
                                         "#",
                                         "\"",
                                         "'''",
                                         "[[",
                                         "]",
                                         "{",
                                         "}",
                                         ",",
                                         "=",
                                         ".",
                                         "\xff",
                                         "\xef\xbb\xbf",
                                         std::string(1, '\0'),
                                         "f 1 2",
                                         "v",
                                         " ",
                                         "true",
                                         "1e-400",
                                         "0x1p3",
                                         "\\u12",
                                         "[[[[[[[[[[[[[[[[[[[[",
                                         "a.b.c.d.e"};
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = below(12);
    switch (below(6)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random_());
        break;
      case 1:
        text.insert(at, 1, static_cast<char>(random_()));
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(at, text.substr(below(text.size() + 1), 4 * length));
        break;
      case 4:
        text.insert(at, tokens[below(std::size(tokens))]);
        break;
      default:
        if (below(8) == 0) text.resize(at);
        break;
    }
  }

  std::mt19937 random_;
};

void fuzz(const std::string& good, unsigned seed, const std::function<void(const std::string&)>& parse) {
  ASSERT_NO_THROW(parse(good));
  Mutator mutate(seed);
  int accepted = 0;
  int refused = 0;
  for (int i = 0; i < mutations_per_parser; ++i) {
    const std::string text = mutate(good);
    try {
      parse(text);
      ++accepted;
    } catch (const InputError& error) {
      ++refused;
      EXPECT_TRUE(std::string_view(error.what()).starts_with("file")) << error.what();
    } catch (const std::exception& error) {
      FAIL() << "mutation " << i << " throws another exception: " << error.what() << "\n" << text;
    }
  }
  // Both outcomes are common, or the damage is not what it should be.
  EXPECT_GT(accepted, mutations_per_parser / 100);
  EXPECT_GT(refused, mutations_per_parser / 10);
}

TEST(Fuzz, Obj) {
  fuzz(
      "v 0 0 0\nv 1 0 0.5\nv 1 1 0\nv 0 1 -2e-1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nusemtl a\nf 1 2 3 4\nf 1/1 2/2 "
      "3/3\nf -4//1 -3//1 -1//1 2//1\n"
      "f 1/1/1 \\\n2/2/1 3/-1/-1\n",
      1, [](const std::string& text) { parse_obj(text, "file"); });
}

TEST(Fuzz, Quads) {
  fuzz(
      "# quads\n0 0 0 1  8 0 0.5 1  8 8 0 1  0 8 0 1  0 1 2 3\n1e2 -3 0.25 2 8.5 0 0 1 8 8 0 -1 0 8 0 0  0 1 2 3 # "
      "end\n",
      2, [](const std::string& text) { parse_quads(text, "file"); });
}

TEST(Fuzz, Camera) {
  fuzz(
      "{\"eye\": [0, 0, 5], \"target\": [0, 0.5, 0],\n \"up\": [0, 1, 0], \"fovy\": 45, \"near\": 0.1, \"far\": 1e2}\n",
      3, [](const std::string& text) { parse_camera(text, "file"); });
  fuzz("{\"matrix\": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1.5e0, 1]}", 4,
       [](const std::string& text) { parse_camera(text, "file"); });
}

TEST(Fuzz, Config) {
  fuzz("# machine\nsignificand_bits = 12\nnotch_exact = false\nattribute_slots = 0x2\nguard_bits = 2\n", 5,
       [](const std::string& text) {
         Config config;
         parse_config(text, "file", config);
       });
}

TEST(Fuzz, DeepNesting) {
  const std::string deep(1000000, '[');
  Config config;
  expect_input_error([&] { parse_camera("{\"eye\": " + deep, "file"); }, "file:1", {});
  expect_input_error([&] { parse_camera("{\"eye\": " + deep + std::string(deep.size(), ']') + "}", "file"); }, "file:1",
                     {});
  expect_input_error([&] { parse_config("a = " + deep, "file", config); }, "file:1", {});
  expect_input_error([&] { parse_config("a = 1\n[" + std::string(100000, 'x') + "]", "file", config); }, "file:1", {});
  std::string dotted = "a";
  for (int i = 0; i < 2000; ++i) dotted += ".a";
  expect_input_error([&] { parse_config(dotted + " = 1", "file", config); }, "file:1", {});
}

}  // namespace
}  // namespace quadrille::golden
