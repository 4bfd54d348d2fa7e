#include "tb/mutants/mutant_list.hpp"

#include "model/selected_mutant.hpp"

#include <toml++/toml.h>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace quadrille {

int selected_mutant = 0;

namespace tb {
namespace {

constexpr const char* switch_of_the_rtl = "QUADRILLE_MUTANT";  // read by quadrille_mutant_pkg

/// As select_mutants.py computes it.
int number_of(const std::string& name) {
  std::uint32_t value = 0x811c9dc5;
  for (const char c : name) value = (value ^ static_cast<unsigned char>(c)) * 0x01000193;
  return static_cast<int>((value & 0x3fffffff) | 0x20000000);
}

Mutant::Side side_of(const std::string& text, const std::string& name) {
  if (text == "rtl") return Mutant::Side::rtl;
  if (text == "model") return Mutant::Side::model;
  if (text == "common") return Mutant::Side::common;
  throw std::runtime_error(name + ": side must be rtl, model or common, not " + text);
}

Mutant read(const toml::table& entry) {
  Mutant m;
  const auto text = [&](const toml::table& from, const char* key) {
    const auto value = from[key].value<std::string>();
    if (!value || value->empty()) throw std::runtime_error("mutant " + m.name + " has no " + key);
    return *value;
  };
  m.name = text(entry, "name");
  m.fault_class = text(entry, "class");
  m.number = number_of(m.name);
  const auto edit = [&](const toml::table& place) {
    (text(place, "file").starts_with("rtl/") ? m.in_rtl : m.in_model) = true;
  };
  if (const toml::array* edits = entry["edit"].as_array())
    for (const toml::node& node : *edits) edit(*node.as_table());
  else
    edit(entry);
  m.side = side_of(entry["side"].value_or(std::string(m.in_rtl ? "rtl" : "model")), m.name);
  const bool fits = m.side == Mutant::Side::rtl ? m.in_rtl && !m.in_model : m.in_model;
  if (!fits || (m.side == Mutant::Side::model && m.in_rtl))
    throw std::runtime_error("mutant " + m.name + ": its files are not those of its side");
  if (const toml::array* list = entry["caught_by"].as_array())
    for (const toml::node& check : *list) m.caught_by.push_back(check.value<std::string>().value());
  m.scenario = entry["scenario"].value<std::string>();
  m.equivalent = entry["equivalent"].value<std::string>();
  if (m.equivalent && !m.caught_by.empty())
    throw std::runtime_error("mutant " + m.name + " is called equivalent, yet something catches it");
  return m;
}

}  // namespace

std::vector<Mutant> read_mutants() {
  const toml::table file =
      toml::parse_file((std::filesystem::path(QUADRILLE_SOURCE_DIR) / "tb/mutants/mutants.toml").string());
  std::vector<Mutant> list;
  for (const toml::node& node : *file["mutant"].as_array()) list.push_back(read(*node.as_table()));
  return list;
}

Mutant generated_mutant(const nlohmann::ordered_json& entry) {
  Mutant m;
  m.name = entry.at("name");
  m.fault_class = entry.at("class");
  m.number = number_of(m.name);
  m.side = side_of(entry.at("side"), m.name);
  for (const auto& edit : entry.at("edit"))
    (edit.at("file").get<std::string>().starts_with("rtl/") ? m.in_rtl : m.in_model) = true;
  return m;
}

Selected::Selected(const Mutant& mutant, bool rtl, bool model) {
  if (rtl) setenv(switch_of_the_rtl, std::to_string(mutant.number).c_str(), 1);
  if (model) selected_mutant = mutant.number;
}

bool anything_selected() { return selected_mutant != 0 || std::getenv(switch_of_the_rtl) != nullptr; }

Selected::~Selected() {
  unsetenv(switch_of_the_rtl);
  selected_mutant = 0;
}

}  // namespace tb
}  // namespace quadrille
