#include "golden/io/camera.hpp"

#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>

namespace quadrille::golden {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 7> known_fields{"matrix", "eye", "target", "up", "fovy", "near", "far"};
constexpr const char* expected_fields =
    R"(either "matrix" or "eye", "target", "up", "fovy", "near" and "far" are expected)";

class CameraParser {
 public:
  CameraParser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Camera parse() {
    read_json();
    if (!root_.is_object())
      throw input_error(name_, 1,
                        std::string("the file holds a JSON ") + root_.type_name() + "; an object is expected");
    for (const auto& [key, value] : root_.items()) {
      if (std::find(known_fields.begin(), known_fields.end(), key) == known_fields.end()) {
        throw input_error(name_, line_of(key), "field " + in_quotes(key) + " is unknown; " + expected_fields);
      }
    }
    Camera camera;
    if (root_.contains("matrix")) {
      if (root_.size() > 1) {
        const std::string other =
            root_.begin().key() == "matrix" ? std::next(root_.begin()).key() : root_.begin().key();
        throw failure(other, "conflicts with \"matrix\"", expected_fields);
      }
      camera.matrix = numbers<16>("matrix");
      return camera;
    }
    look_at(camera);
    return camera;
  }

 private:
  void read_json() {
    std::set<std::string> seen;
    const auto check_keys = [&](int depth, json::parse_event_t event, json& parsed) {
      // The library keeps the last of several equal keys; here they are most likely a slip.
      if (event == json::parse_event_t::key && depth == 1 && !seen.insert(parsed.get<std::string>()).second) {
        const std::string key = parsed.get<std::string>();
        throw input_error(name_, line_of(key), "field " + in_quotes(key) + " is given twice; give it once");
      }
      return true;
    };
    try {
      root_ = json::parse(text_.begin(), text_.end(), check_keys);
    } catch (const json::parse_error& error) {
      // The library counts bytes from 1 and points one past the end when the text stops too early.
      const std::string message = error.what();
      const std::size_t colon = message.find(": ");
      throw input_error(
          name_, line_at(text_, error.byte > 0 ? error.byte - 1 : 0),
          "JSON " + printable(message.substr(colon == std::string::npos ? 0 : colon + 2)) + "; " + expected_fields);
    } catch (const json::exception& error) {
      const std::string message = error.what();  // a number beyond double; its digits are in single quotes
      const std::size_t open = message.find('\'');
      const std::size_t close = message.rfind('\'');
      const std::string digits =
          open < close && close != std::string::npos ? message.substr(open + 1, close - open - 1) : std::string();
      const std::size_t at = digits.empty() ? std::string::npos : text_.find(digits);
      throw input_error(
          name_, at == std::string::npos ? 0 : line_at(text_, at),
          "number " + in_quotes(digits) + " is outside the range of a double; finite numbers are expected");
    }
  }

  void look_at(Camera& camera) const {
    camera.eye = numbers<3>("eye");
    camera.target = numbers<3>("target");
    camera.up = numbers<3>("up");
    camera.fovy = number(field("fovy"), "fovy");
    camera.near = number(field("near"), "near");
    camera.far = number(field("far"), "far");

    if (!(camera.fovy > 0 && camera.fovy < 180)) {
      throw failure("fovy", "is " + number_text(camera.fovy), "degrees strictly between 0 and 180 are expected");
    }
    if (!(camera.near > 0)) throw failure("near", "is " + number_text(camera.near), "a distance above 0 is expected");
    if (!(camera.far > camera.near)) {
      throw failure("far", "is " + number_text(camera.far),
                    "a distance above \"near\", " + number_text(camera.near) + ", is expected");
    }
    const Vec3 view = direction(
        {camera.target[0] - camera.eye[0], camera.target[1] - camera.eye[1], camera.target[2] - camera.eye[2]});
    if (view == Vec3{}) throw failure("target", "equals \"eye\"", "the camera needs a direction to look into");
    const Vec3 up = direction(camera.up);
    if (up == Vec3{}) throw failure("up", "is zero", "a direction is expected");
    // 1e-9: what is left of the direction of a cross product must stand well above the rounding of its factors.
    const double sine = std::hypot(view[1] * up[2] - view[2] * up[1], view[2] * up[0] - view[0] * up[2],
                                   view[0] * up[1] - view[1] * up[0]);
    if (sine < 1e-9)
      throw failure("up", "is parallel to the view direction", "another direction than target − eye is expected");
  }

  /// Unit vector, or zero for zero; scaled first, so that no square over- or underflows.
  static Vec3 direction(const Vec3& v) {
    const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    if (largest == 0) return {};
    const Vec3 scaled{v[0] / largest, v[1] / largest, v[2] / largest};
    const double length = std::hypot(scaled[0], scaled[1], scaled[2]);
    return {scaled[0] / length, scaled[1] / length, scaled[2] / length};
  }

  const json& field(std::string_view key) const {
    const auto found = root_.find(std::string(key));
    if (found == root_.end())
      throw input_error(name_, 0, "field " + in_quotes(key) + " is missing; " + expected_fields);
    return *found;
  }

  double number(const json& value, const std::string& key) const {
    if (!value.is_number())
      throw failure(key, std::string("holds a JSON ") + value.type_name(), "a number is expected");
    const double result = value.get<double>();
    if (!(std::abs(result) <= max_input_magnitude)) {
      throw failure(key, "holds " + number_text(result), "a finite number of magnitude up to 2^80 is expected");
    }
    return result;
  }

  template <std::size_t N>
  std::array<double, N> numbers(const std::string& key) const {
    const json& value = field(key);
    const std::string expected = "an array of " + std::to_string(N) + " numbers is expected";
    if (!value.is_array()) throw failure(key, std::string("holds a JSON ") + value.type_name(), expected);
    if (value.size() != N) throw failure(key, "has " + std::to_string(value.size()) + " elements", expected);
    std::array<double, N> result{};
    for (std::size_t i = 0; i < N; ++i) result[i] = number(value[i], key);
    return result;
  }

  InputError failure(const std::string& key, const std::string& problem, const std::string& expected) const {
    return input_error(name_, line_of(key), "field " + in_quotes(key) + " " + problem + "; " + expected);
  }

  /// Line where a field is named, 0 if it is spelt with escapes.
  std::size_t line_of(const std::string& key) const {
    const std::size_t at = text_.find("\"" + key + "\"");
    return at == std::string_view::npos ? 0 : line_at(text_, at);
  }

  std::string_view text_;
  const std::string& name_;
  json root_;
};

}  // namespace

Camera load_camera(const std::string& path) { return parse_camera(read_file(path, "a camera in JSON"), path); }

Camera parse_camera(std::string_view text, const std::string& name) {
  refuse_wide_text(text, name);
  return CameraParser(text, name).parse();
}

std::string camera_text(const Camera& camera) {
  const auto list = [](std::span<const double> numbers) {
    std::string text;
    for (const double number : numbers)
      text +=
          (text.empty() ? "[" : ", ") + number_text(number + 0.0);  // no -0, which JSON readers take for the integer 0
    return text + "]";
  };
  if (camera.matrix) return "{\"matrix\": " + list(*camera.matrix) + "}\n";
  return "{\n  \"eye\": " + list(camera.eye) + ",\n  \"target\": " + list(camera.target) +
         ",\n  \"up\": " + list(camera.up) + ",\n  \"fovy\": " + number_text(camera.fovy) +
         ",\n  \"near\": " + number_text(camera.near) + ",\n  \"far\": " + number_text(camera.far) + "\n}\n";
}

}  // namespace quadrille::golden
