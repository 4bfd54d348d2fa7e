#include "tb/sweep/store.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/error.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <system_error>

namespace quadrille::sweep {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Ordered = nlohmann::ordered_json;

std::string reason(int error) { return std::system_category().message(error); }

/// A line of the journal, without its end.
std::string framed(const std::string& content) {
  const uLong crc = crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
  char head[40];
  std::snprintf(head, sizeof head, "{\"crc\":\"%08lx\",\"content\":", static_cast<unsigned long>(crc));
  return head + content + "}";
}
constexpr std::size_t frame_length = std::string_view("{\"crc\":\"00000000\",\"content\":}").size();

// JSON has no infinities and NaN; they are kept as text.
Ordered number_json(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

double number_from(const Json& json) {
  if (json.is_number()) return json.get<double>();
  const auto text = json.get<std::string>();
  if (text == "nan") return std::numeric_limits<double>::quiet_NaN();
  return text == "inf" ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
}

Ordered errors_json(const std::array<ErrorSummary, 4>& errors) {
  Ordered json = Ordered::array();
  for (const ErrorSummary& e : errors)
    json.push_back({e.count, number_json(e.max), number_json(e.p999), number_json(e.rms), number_json(e.mean)});
  return json;
}

void errors_from(const Json& json, std::array<ErrorSummary, 4>& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Json& e = json.at(i);
    errors[i] = {e.at(0).get<std::uint64_t>(), number_from(e.at(1)), number_from(e.at(2)), number_from(e.at(3)),
                 number_from(e.at(4))};
  }
}

Ordered result_json(std::size_t row, const PointResult& r) {
  Ordered json;
  json["row"] = row;
  if (!r.refused.empty()) {
    json["refused"] = r.refused;
    return json;
  }
  json["snapping"] = errors_json(r.snapping);
  json["arithmetic"] = errors_json(r.arithmetic);
  json["counts"] = {r.fragments, r.coverage_gained, r.coverage_lost, r.discard_differs, r.colour_codes,
                    r.saturated, r.cycles,          r.quads,         r.plane_quads,     r.plane_fragments};
  json["spreads"] = {number_json(r.attribute_spread), number_json(r.depth_spread)};
  if (r.worst.any) json["worst"] = {r.worst.index, r.worst.x, r.worst.y, number_json(r.worst.error)};
  return json;
}

std::pair<std::size_t, PointResult> result_from(const Json& json) {
  PointResult r;
  const auto row = json.at("row").get<std::size_t>();
  if (json.contains("refused")) {
    r.refused = json.at("refused").get<std::string>();
    return {row, r};
  }
  errors_from(json.at("snapping"), r.snapping);
  errors_from(json.at("arithmetic"), r.arithmetic);
  const Json& counts = json.at("counts");
  std::size_t i = 0;
  for (std::uint64_t* count : {&r.fragments, &r.coverage_gained, &r.coverage_lost, &r.discard_differs, &r.colour_codes,
                               &r.saturated, &r.cycles, &r.quads, &r.plane_quads, &r.plane_fragments})
    *count = counts.at(i++).get<std::uint64_t>();
  r.attribute_spread = number_from(json.at("spreads").at(0));
  r.depth_spread = number_from(json.at("spreads").at(1));
  if (json.contains("worst")) {
    const Json& w = json.at("worst");
    r.worst = {true, w.at(0).get<std::uint32_t>(), w.at(1).get<int>(), w.at(2).get<int>(), number_from(w.at(3))};
  }
  return {row, r};
}

/// The first keys in which two identities differ, for a message.
std::string differences(const Json& there, const Json& here) {
  std::string text;
  for (const auto& [key, value] : here.items()) {
    if (there.contains(key) && there.at(key) == value) continue;
    text += (text.empty() ? "" : ", ") + key;
  }
  return text.empty() ? "its format" : text;
}

}  // namespace

Store::Store(fs::path directory, Ordered identity, Existing existing)
    : directory_(std::move(directory)), identity_(std::move(identity)) {
  std::error_code error;
  fs::create_directories(directory_, error);
  if (error || !fs::is_directory(directory_))
    throw golden::InputError("cannot make the directory " + directory_.string() +
                             (error ? ": " + error.message() : ": a file of this name exists"));
  fd_ = ::open(journal().c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (fd_ < 0) throw golden::InputError("cannot write " + journal() + ": " + reason(errno));
  if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
    ::close(fd_);
    fd_ = -1;
    throw golden::InputError(journal() + ": another sweep is writing to this directory");
  }
  try {
    if (existing == Existing::discard) discard();
    read_journal();
  } catch (...) {
    ::close(fd_);
    fd_ = -1;
    throw;
  }
}

Store::~Store() {
  if (fd_ >= 0) ::close(fd_);
}

void Store::read_journal() {
  std::ifstream in(journal(), std::ios::binary);
  std::ostringstream whole;
  whole << in.rdbuf();
  const std::string text = whole.str();
  std::size_t number = 0, begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    ++number;
    const auto damaged = [&](const std::string& why) {
      const std::string keep = std::to_string(number - 1);
      throw golden::InputError(journal() + ":" + std::to_string(number) + ": damaged (" + why +
                               "); use --fresh, or keep the lines before with `head -n " + keep + "`");
    };
    // {"crc":"xxxxxxxx","content":…}: the sum is over the content's bytes, as they stand in the file.
    const std::string line = text.substr(begin, end - begin);
    const std::string raw = line.size() > frame_length ? line.substr(frame_length - 1, line.size() - frame_length) : "";
    if (raw.empty() || line != framed(raw)) damaged("not a line of a journal, or its check sum is wrong");
    const Json content = Json::parse(raw, nullptr, false);
    if (content.is_discarded()) damaged("not JSON");
    if (number == 1) {
      const Json mine = Json::parse(identity_.dump());
      if (content != mine)
        throw golden::InputError(directory_.string() + " holds another sweep (it differs in " +
                                 differences(content, mine) + "); use another --out, or --fresh to replace it");
    } else {
      try {
        take(content);
      } catch (const Json::exception& error) {
        damaged(error.what());
      }
    }
  }
  length_ = begin;
  if (::ftruncate(fd_, static_cast<off_t>(length_)) != 0)
    throw golden::InputError("cannot write " + journal() + ": " + reason(errno));
  if (number == 0) write_line(identity_);
}

void Store::take(const Json& line) {
  for (const Json& result : line.at("results"))
    results_.insert_or_assign(result_from(result).first, result_from(result).second);
  StageCounters executed;
  for (std::size_t s = 0; s < stage_count; ++s) {
    executed.settings[s] = line.at("settings").at(s).get<std::uint64_t>();
    executed.fragments[s] = line.at("fragments").at(s).get<std::uint64_t>();
  }
  counters_ += executed;
  timings_.push_back({"batch", line.at("results").size(), line.at("seconds").get<double>()});
}

void Store::append(const Batch& batch, std::span<const std::size_t> rows) {
  Ordered content;
  content["results"] = Ordered::array();
  for (std::size_t i = 0; i < batch.points.size(); ++i)
    content["results"].push_back(result_json(rows[batch.points[i]], batch.results[i]));
  content["settings"] = batch.executed.settings;
  content["fragments"] = batch.executed.fragments;
  content["seconds"] = batch.seconds;
  write_line(content);
  take(Json::parse(content.dump()));
}

void Store::merge(const fs::path& shard) {
  if (!fs::exists(shard / "journal.jsonl"))
    throw golden::InputError(shard.string() + ": no journal.jsonl; expected the --out of `quadrille sweep --shard`");
  const Store part(shard, identity_, Existing::resume);
  Ordered content;
  content["results"] = Ordered::array();
  for (const auto& [row, result] : part.results_) {
    const auto mine = results_.find(row);
    if (mine == results_.end())
      content["results"].push_back(result_json(row, result));
    else if (result_json(row, result) != result_json(row, mine->second))
      throw golden::InputError(part.journal() + ": row " + std::to_string(row) + " differs from " + journal());
  }
  if (content["results"].empty()) return;
  content["settings"] = part.counters_.settings;
  content["fragments"] = part.counters_.fragments;
  content["seconds"] = 0.0;
  for (const Timing& timing : part.timings_) content["seconds"] = content["seconds"].get<double>() + timing.seconds;
  write_line(content);
  take(Json::parse(content.dump()));
}

void Store::write_line(const Ordered& content) {
  const std::string text = framed(content.dump()) + "\n";
  std::size_t done = 0;
  int error = 0;
  while (done < text.size() && error == 0) {
    const ssize_t n = ::pwrite(fd_, text.data() + done, text.size() - done, static_cast<off_t>(length_ + done));
    if (n > 0)
      done += static_cast<std::size_t>(n);
    else if (n < 0 && errno != EINTR)
      error = errno;
  }
  if (error == 0 && ::fdatasync(fd_) != 0) error = errno;
  if (error != 0) {
    if (::ftruncate(fd_, static_cast<off_t>(length_)) != 0) error = errno;
    throw golden::InputError("cannot write " + journal() + ": " + reason(error) + "; the " +
                             std::to_string(results_.size()) + " finished points are kept; the same command resumes");
  }
  length_ += text.size();
}

void Store::discard() {
  std::error_code error;
  fs::remove(file("manifest.json"), error);  // first: without it the rest counts as unfinished
  if (error) throw golden::InputError("cannot remove " + file("manifest.json") + ": " + error.message());
  if (::ftruncate(fd_, 0) != 0) throw golden::InputError("cannot write " + journal() + ": " + reason(errno));
}

}  // namespace quadrille::sweep
