#include "model/page/request.hpp"

#include "golden/scenes/scenes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace quadrille::page {
namespace {

[[noreturn]] void refuse(std::string_view key, std::string_view value, const std::string& right) {
  throw std::invalid_argument(std::string(key) + "=" + std::string(value) + ": expected " + right);
}

int integer(std::string_view key, std::string_view text, int low, int high) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < low || value > high)
    refuse(key, text, "an integer from " + std::to_string(low) + " to " + std::to_string(high));
  return value;
}

double number(std::string_view key, std::string_view text) {
  const std::string copy(text);
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  if (copy.empty() || *end != 0 || !std::isfinite(value) || std::fabs(value) > 1e6)
    refuse(key, text, "a number of at most a million");
  return value;
}

bool flag(std::string_view key, std::string_view text) { return integer(key, text, 0, 1) != 0; }

std::string_view until(std::string_view& rest, char separator) {
  const std::size_t at = std::min(rest.find(separator), rest.size());
  const std::string_view part = rest.substr(0, at);
  rest.remove_prefix(std::min(rest.size(), at + 1));
  return part;
}

void set(Request& to, std::string_view key, std::string_view value) {
  if (key == "scene") {
    to.scene = value;
  } else if (key == "size") {
    const std::size_t at = value.find('x');
    if (at == value.npos) refuse(key, value, "WIDTHxHEIGHT, as 512x512");
    to.width = integer(key, value.substr(0, at), 1, 1024);
    to.height = integer(key, value.substr(at + 1), 1, 1024);
  } else if (key == "yaw") {
    to.yaw = number(key, value);
  } else if (key == "pitch") {
    to.pitch = number(key, value);
  } else if (key == "dolly") {
    to.dolly = number(key, value);
  } else if (key.size() > 1 && key[0] == 'v' && key[1] >= '0' && key[1] <= '9') {
    std::string_view rest = value;
    golden::Vec3 position{};
    if (std::ranges::count(value, ',') != 2) refuse(key, value, "three numbers X,Y,Z");
    for (double& c : position) c = number(key, until(rest, ','));
    to.vertices[integer("v", key.substr(1), 0, 100000)] = position;
  } else if (key == "shade") {
    to.shade = value;
  } else if (key == "texture") {
    to.texture = value;
  } else if (key == "perspective") {
    to.perspective = flag(key, value);
  } else if (key == "cull") {
    if (value != "none" && value != "front" && value != "back") refuse(key, value, "none, front or back");
    to.cull = value == "none" ? Cull::none : value == "front" ? Cull::front : Cull::back;
  } else if (key == "depth") {
    to.depth = flag(key, value);
  } else if (key == "pixel") {
    if (std::ranges::count(value, ',') != 1) refuse(key, value, "X,Y of a pixel");
    std::string_view rest = value;
    const int x = integer(key, until(rest, ','), 0, 1023);
    to.pixel = {x, integer(key, rest, 0, 1023)};
  } else if (key == "view") {
    to.view = value;
  } else {
    to.config.set(key, value == "auto" ? -1 : integer(key, value, -1, 1000));
  }
}

}  // namespace

Request parse_request(std::string_view text) {
  Request request;
  while (!text.empty()) {
    std::string_view line = until(text, '\n');
    if (line.empty()) continue;
    const std::string_view key = until(line, '=');
    set(request, key, line);
  }
  request.config.validate();
  return request;
}

}  // namespace quadrille::page
