#include "golden/io/json_report.hpp"

#include "golden/io/test_support.hpp"

#include <cstdlib>
#include <limits>

namespace quadrille::golden {
namespace {

class JsonReportTest : public InDirectory {};

TEST_F(JsonReportTest, CarriesTheCommonFieldsInOrder) {
  Config config;
  config.significand_bits = 12;
  const std::vector<std::string> arguments{"quadrille", "cosim", "--mesh", "my mesh.obj"};
  nlohmann::ordered_json report = begin_report(config, 42, arguments);
  report["quads"] = 7;
  save_json(path("r"), report);
  const auto back = nlohmann::ordered_json::parse(read(path("r")));
  std::vector<std::string> keys;
  for (const auto& [key, value] : back.items()) keys.push_back(key);
  EXPECT_EQ(keys, (std::vector<std::string>{"schema_version", "version", "config", "seed", "command", "quads"}));
  EXPECT_EQ(back["schema_version"], 1);
  EXPECT_EQ(back["version"], program_version());
  EXPECT_EQ(back["seed"], 42);
  EXPECT_EQ(back["command"], "quadrille cosim --mesh 'my mesh.obj'");
  EXPECT_EQ(back["config"].size(), Config::keys().size());
  for (const ConfigKey& key : Config::keys()) EXPECT_EQ(back["config"][std::string(key.name)], config.get(key.name));
  const std::string bytes = read(path("r"));
  save_json(path("r"), report);
  EXPECT_EQ(read(path("r")), bytes);
  EXPECT_EQ(bytes.back(), '\n');
}

TEST_F(JsonReportTest, AnyArgumentCanBeWritten) {
  EXPECT_EQ(command_line(std::vector<std::string>{"a", "", "b'c", "$x"}), "a '' 'b'\\''c' '$x'");
  nlohmann::ordered_json report = begin_report(Config{}, 1, std::vector<std::string>{"a\xff"});
  report["worst"] = std::numeric_limits<double>::quiet_NaN();
  save_json(path("r"), report);
  EXPECT_TRUE(nlohmann::ordered_json::parse(read(path("r")))["worst"].is_null());
}

TEST_F(JsonReportTest, ACommandWithAnyBytesIsTextThatTheShellGivesBack) {
  const std::vector<std::string> arguments{"caf\xe9.quads", "it's \\ \xff\x66", "caf\xc3\xa9.quads"};
  const std::string line = command_line(arguments);
  EXPECT_EQ(line, "$'caf\\xe9.quads' $'it\\'s \\\\ \\xfff' 'caf\xc3\xa9.quads'");
  EXPECT_NO_THROW(nlohmann::json(line).dump());
  write("line.sh", "printf '%s\\n' " + line + " >" + path("out") + "\n");
  ASSERT_EQ(std::system(("bash " + path("line.sh")).c_str()), 0);
  EXPECT_EQ(read(path("out")), arguments[0] + "\n" + arguments[1] + "\n" + arguments[2] + "\n");
}

TEST_F(JsonReportTest, DashIsStandardOutputAndFailuresKeepTheOldFile) {
  ::testing::internal::CaptureStdout();
  save_json("-", {{"a", 1}});
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "{\n  \"a\": 1\n}\n");
  std::filesystem::create_directory(path("d"));
  expect_input_error([&] { save_json(path("d"), {}); }, path("d"), {"Is a directory"});
  expect_input_error([&] { save_json(path("no/f"), {}); }, path("no/f"), {"No such file"});
}

}  // namespace
}  // namespace quadrille::golden
