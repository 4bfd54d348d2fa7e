#include "tb/verify/faults/mutant_list.hpp"

#include "model/selected_mutant.hpp"

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

namespace quadrille {

int selected_mutant = 0;

namespace tb {
namespace {

constexpr const char* switch_of_the_rtl = "QUADRILLE_MUTANT";  // read by quadrille_mutant_pkg

}  // namespace

NLOHMANN_JSON_SERIALIZE_ENUM(Mutant::Side, {{Mutant::Side::rtl, "rtl"},
                                            {Mutant::Side::model, "model"},
                                            {Mutant::Side::common, "common"}})

std::vector<Mutant> read_mutants() {
  std::ifstream in(QUADRILLE_FAULTS);
  std::vector<Mutant> list;
  for (const auto& entry : nlohmann::json::parse(in))
    list.push_back({entry.at("name"), entry.at("class"), entry.at("side"), entry.at("rtl"), entry.at("model"),
                    entry.at("generated"), entry.at("number"), entry.at("checks"), entry.at("scenario"),
                    entry.at("equivalent")});
  return list;
}

Selected::Selected(const Mutant& mutant, bool rtl, bool model) {
  if (rtl) setenv(switch_of_the_rtl, std::to_string(mutant.number).c_str(), 1);
  if (model) selected_mutant = mutant.number;
}

int selected_in_rtl() {
  const char* number = std::getenv(switch_of_the_rtl);
  return number == nullptr ? 0 : std::atoi(number);
}

bool anything_selected() { return selected_mutant != 0 || selected_in_rtl() != 0; }

Selected::~Selected() {
  unsetenv(switch_of_the_rtl);
  selected_mutant = 0;
}

}  // namespace tb
}  // namespace quadrille
