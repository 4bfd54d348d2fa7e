#include "golden/io/fragment_csv.hpp"

#include "golden/io/atomic_file.hpp"

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

}  // namespace

void save_fragment_csv(const std::string& path, std::span<const FragmentRow> rows, const FragmentColumns& columns) {
  if (columns.attributes < 0 || columns.attributes > max_attribute_slots)
    throw std::logic_error("FragmentColumns: attributes out of range");
  const auto attributes = static_cast<std::size_t>(columns.attributes);
  AtomicFile file(path, AtomicFile::Dash::standard_output);
  std::string head = "quad,x,y,front,flags,l0,l1,l2,l3,z";
  for (std::size_t j = 0; j < attributes; ++j) head += ",a" + std::to_string(j);
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

}  // namespace quadrille::golden
