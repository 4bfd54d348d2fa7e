// What the tests of this folder share.
#pragma once

#include "golden/io/error.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

namespace quadrille::golden {

/// A directory of its own for each test, removed afterwards.
class InDirectory : public ::testing::Test {
 protected:
  InDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "quadrille_io_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary directory");
    directory_ = pattern;
  }
  ~InDirectory() override {
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  std::string write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  static std::string read(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t entries() const {
    const std::filesystem::directory_iterator list(directory_);
    return static_cast<std::size_t>(std::distance(begin(list), end(list)));
  }

 private:
  std::filesystem::path directory_;
};

/// The message of the InputError that the action must throw.
template <typename Action>
std::string input_error_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError was thrown";
  return {};
}

/// Expects an InputError whose message starts with `place` and holds every fragment.
template <typename Action>
void expect_input_error(const Action& action, const std::string& place,
                        std::initializer_list<std::string_view> fragments) {
  const std::string message = input_error_of(action);
  EXPECT_EQ(message.substr(0, place.size() + 2), place + ": ");
  for (const std::string_view fragment : fragments) {
    EXPECT_NE(message.find(fragment), std::string::npos) << "'" << fragment << "' is not in: " << message;
  }
}

}  // namespace quadrille::golden
