#include "golden/io/fragment_csv.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/npy.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace quadrille::golden {
namespace {

/// Appends fields to a line; a row never outgrows the buffer (at most 5 integers of 10 and 13 reals of 24 characters).
class Line {
 public:
  void integer(std::uint32_t value) { end_ = std::to_chars(end_, limit(), value).ptr; }
  void real(double value) {
    if (value == 0 && !std::signbit(value)) {
      *end_++ = '0';  // frequent, and the general path is slow
    } else if (std::isnan(value)) {
      // An undefined value is an empty cell; the pixel is flagged.
    } else {
      end_ = std::to_chars(end_, limit(), value, std::chars_format::general, 17).ptr;
    }
  }
  void put(char c) { *end_++ = c; }
  std::string_view text() const { return {buffer_.data(), static_cast<std::size_t>(end_ - buffer_.data())}; }
  void clear() { end_ = buffer_.data(); }

 private:
  char* limit() { return buffer_.data() + buffer_.size(); }

  std::array<char, 1024> buffer_;
  char* end_ = buffer_.data();
};

/// Indices of the rows in the order of quad, y, x. Indices instead of rows, which are large.
std::vector<std::size_t> sorted_order(std::span<const FragmentRow> rows) {
  const auto key = [](const FragmentRow& row) {
    return std::uint64_t{row.quad} << 32 | std::uint32_t{row.y} << 16 | row.x;
  };
  std::vector<std::pair<std::uint64_t, std::size_t>> keyed(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) keyed[i] = {key(rows[i]), i};
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::size_t> order(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) order[i] = keyed[i].second;
  return order;
}

std::size_t checked_attributes(const FragmentColumns& columns) {
  if (columns.attributes.size() > max_attribute_slots)
    throw std::logic_error("FragmentColumns: attributes out of range");
  return columns.attributes.size();
}

}  // namespace

void save_fragment_csv(const std::string& path, std::span<const FragmentRow> rows, const FragmentColumns& columns) {
  const std::size_t attributes = checked_attributes(columns);
  AtomicFile file(path, AtomicFile::Dash::standard_output);
  std::string head = "quad,x,y,front,flags,l0,l1,l2,l3,z";
  for (const std::string& name : columns.attributes) head += "," + name;
  file.write(head + "\n");

  Line line;
  for (const std::size_t i : sorted_order(rows)) {
    const FragmentRow& row = rows[i];
    line.clear();
    line.integer(row.quad);
    for (const std::uint32_t value :
         {std::uint32_t{row.x}, std::uint32_t{row.y}, std::uint32_t{row.front}, row.flags}) {
      line.put(',');
      line.integer(value);
    }
    for (const double value : row.lambda) {
      line.put(',');
      line.real(value);
    }
    line.put(',');
    if (columns.depth) line.real(row.z);
    for (std::size_t j = 0; j < attributes; ++j) {
      line.put(',');
      line.real(row.attribute[j]);
    }
    line.put('\n');
    file.write(line.text());
  }
  file.commit();
}

void save_fragment_npz(const std::string& path, std::span<const FragmentRow> rows, const FragmentColumns& columns) {
  const std::size_t attributes = checked_attributes(columns);
  std::vector<std::uint32_t> quad, flags;
  std::vector<std::uint16_t> x, y;
  std::vector<std::uint8_t> front;
  std::vector<std::vector<double>> lambda(4), attribute(attributes);
  std::vector<double> z;
  for (const std::size_t i : sorted_order(rows)) {
    const FragmentRow& row = rows[i];
    quad.push_back(row.quad);
    x.push_back(row.x);
    y.push_back(row.y);
    front.push_back(row.front);
    flags.push_back(row.flags);
    for (std::size_t k = 0; k < 4; ++k) lambda[k].push_back(row.lambda[k]);
    if (columns.depth) z.push_back(row.z);
    for (std::size_t j = 0; j < attributes; ++j) attribute[j].push_back(row.attribute[j]);
  }
  std::vector<NpzArray> arrays{npz_column("quad", "<u4", quad), npz_column("x", "<u2", x), npz_column("y", "<u2", y),
                               npz_column("front", "|b1", front), npz_column("flags", "<u4", flags)};
  for (std::size_t k = 0; k < 4; ++k) arrays.push_back(npz_column("l" + std::to_string(k), "<f8", lambda[k]));
  if (columns.depth) arrays.push_back(npz_column("z", "<f8", z));
  for (std::size_t j = 0; j < attributes; ++j) arrays.push_back(npz_column(columns.attributes[j], "<f8", attribute[j]));
  save_npz(path, arrays);
}

}  // namespace quadrille::golden
