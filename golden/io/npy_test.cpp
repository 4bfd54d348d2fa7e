#include "golden/io/npy.hpp"

#include "golden/io/error.hpp"
#include "golden/io/test_support.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace quadrille::golden {
namespace {

class Npy : public InDirectory {};

TEST_F(Npy, HeaderAndValuesAsNumpyDefinesThem) {
  const std::vector<float> values{1, -1, 0.5f, 2, 3, 4};
  save_npy(path("map.npy"), values, 3, 2);
  const std::string bytes = read(path("map.npy"));
  // Magic, version 1.0, header length; the header ends with a newline and the data starts at a multiple of 64.
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t length = static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ((10 + length) % 64, 0u);
  const std::string header = bytes.substr(10, length);
  EXPECT_EQ(header.back(), '\n');
  EXPECT_EQ(header.find("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }"), 0u);
  ASSERT_EQ(bytes.size(), 10 + length + 24);
  float last = 0;
  std::memcpy(&last, bytes.data() + 10 + length + 20, 4);
  EXPECT_EQ(last, 4.0f);
}

TEST_F(Npy, RefusesWhatDoesNotFit) {
  EXPECT_THROW(save_npy("/nowhere/x.npy", std::vector<float>(6), 3, 2), InputError);
  EXPECT_THROW(save_npy(path("x.npy"), std::vector<float>(5), 3, 2), std::invalid_argument);
  EXPECT_EQ(entries(), 0u);
}

}  // namespace
}  // namespace quadrille::golden
