#include "golden/io/exr.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/error.hpp"
#include "golden/io/png.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include <filesystem>
#include <new>
#include <stdexcept>

namespace quadrille::golden {
namespace {

// 0: all work in the calling thread. The library's own threads would not change the bytes, but its pool is global
// state.
constexpr int no_threads = 0;

/// Lets OpenEXR write into an AtomicFile. The library wraps exceptions in its own and swallows those of its
/// destructors, so the first failure is kept for the caller.
class AtomicStream : public Imf::OStream {
 public:
  explicit AtomicStream(const std::string& path) : OStream(path.c_str()), file_(path, AtomicFile::Dash::refused) {}

  void write(const char bytes[], int count) override {
    guarded([&] { file_.write({bytes, static_cast<std::size_t>(count)}); });
  }
  std::uint64_t tellp() override { return file_.tell(); }
  void seekp(std::uint64_t position) override {
    guarded([&] { file_.seek(position); });
  }

  void commit() { file_.commit(); }
  void rethrow_failure() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  template <typename Action>
  void guarded(const Action& action) {
    rethrow_failure();
    try {
      action();
    } catch (...) {
      failure_ = std::current_exception();
      throw;
    }
  }

  AtomicFile file_;
  std::exception_ptr failure_;
};

/// A channel of 4-byte values, rows from the top. OpenEXR takes pointers that are not const, and only reads through
/// them.
template <typename Value>
Imf::Slice slice(const std::vector<Value>& values, int width, Imf::PixelType type) {
  static_assert(sizeof(Value) == 4);
  return {type, reinterpret_cast<char*>(const_cast<Value*>(values.data())), 4, 4 * static_cast<std::size_t>(width)};
}

}  // namespace

void save_exr(const std::string& path, const FrameImage& frame) {
  Imf::Header header(frame.width, frame.height);
  header.compression() = Imf::PIZ_COMPRESSION;  // lossless, and its bytes are OpenEXR's own: no zlib
  Imf::FrameBuffer buffer;
  for (const auto& [name, values] : float_channels(frame)) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    buffer.insert(name, slice(*values, frame.width, Imf::FLOAT));
  }
  header.channels().insert("quad", Imf::Channel(Imf::UINT));
  buffer.insert("quad", slice(frame.quad, frame.width, Imf::UINT));

  AtomicStream stream(path);
  try {
    Imf::OutputFile file(stream, header, no_threads);
    file.setFrameBuffer(buffer);
    file.writePixels(frame.height);
  } catch (const std::exception& error) {
    stream.rethrow_failure();
    throw InputError(path + ": cannot be written as OpenEXR: " + error.what());
  }
  stream.rethrow_failure();  // the line table is written by the destructor
  stream.commit();
}

ExrImage load_exr(const std::string& path, std::span<const std::string> channels) {
  const std::string expected = "; a complete single-part OpenEXR file of at most " + std::to_string(max_image_side) +
                               " pixels a side is expected";
  try {
    Imf::InputFile file(path.c_str(), no_threads);
    const Imf::Header& header = file.header();
    const auto& window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > max_image_side || height > max_image_side) {
      throw InputError(path + ": picture size " + std::to_string(width) + "x" + std::to_string(height) +
                       " is impossible" + expected);
    }
    ExrImage image{static_cast<int>(width), static_cast<int>(height), {}, {}};

    std::vector<std::string> names(channels.begin(), channels.end());
    if (names.empty()) {
      for (auto it = header.channels().begin(); it != header.channels().end(); ++it) names.emplace_back(it.name());
    }
    // A damaged header must not make us claim gigabytes: an uncompressed file holds at least two bytes for each value,
    // and of others the first rows are tried.
    const auto pixels = static_cast<std::size_t>(width * height);
    if (header.compression() == Imf::NO_COMPRESSION && std::filesystem::file_size(path) / 2 < pixels) {
      throw InputError(path + ": the file ends too early" + expected);
    }

    const std::size_t row = 4 * static_cast<std::size_t>(width);
    // OpenEXR addresses pixels from the origin, which need not be inside the data window.
    const auto origin = [&](void* first) {
      const auto offset =
          std::intptr_t{window.min.x} * 4 + std::intptr_t{window.min.y} * static_cast<std::intptr_t>(row);
      return reinterpret_cast<char*>(reinterpret_cast<std::uintptr_t>(first) - static_cast<std::uintptr_t>(offset));
    };
    for (const std::string& name : names) {
      const Imf::Channel* channel = header.channels().findChannel(name);
      if (channel == nullptr) {
        std::string known;
        for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
          known += std::string(" ") + it.name();
        throw InputError(path + ": has no channel \"" + name + "\"; it has" + known);
      }
      if (channel->xSampling != 1 || channel->ySampling != 1) {
        throw InputError(path + ": channel \"" + name + "\" is subsampled; one value per pixel is expected");
      }
    }
    const auto read_rows = [&](std::int64_t rows) {
      const auto count = static_cast<std::size_t>(width * rows);
      Imf::FrameBuffer buffer;
      for (const std::string& name : names) {
        if (header.channels().findChannel(name)->type == Imf::UINT) {
          auto& values = image.uints[name];
          values.resize(count);
          buffer.insert(name, Imf::Slice(Imf::UINT, origin(values.data()), 4, row));
        } else {
          auto& values = image.floats[name];
          values.resize(count);
          buffer.insert(name, Imf::Slice(Imf::FLOAT, origin(values.data()), 4, row));
        }
      }
      file.setFrameBuffer(buffer);
      file.readPixels(window.min.y, window.min.y + static_cast<int>(rows) - 1);
    };
    constexpr std::int64_t trial_rows = 32;
    if (height > trial_rows) read_rows(trial_rows);
    read_rows(height);
    return image;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(path + ": is not a readable OpenEXR picture: " + error.what() + expected);
  }
}

}  // namespace quadrille::golden
