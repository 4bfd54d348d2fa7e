#include "golden/explain/compare.hpp"

namespace quadrille::explain {

void compare(Stage& stage, const RecordLayout& layout, const Record* record) {
  stage.compared = record != nullptr ? Stage::Compared::same : Stage::Compared::differs;
  if (record == nullptr) {
    stage.remarks.push_back("The RTL has nothing for this pixel here.");
    return;
  }
  for (Number& number : stage.numbers) {
    number.other = number.stored;
    for (Field& field : number.other) {
      const RecordField& at = layout.field(field.name, field.index);
      const std::uint64_t expected = field.value;
      field.value = field.is_signed ? static_cast<std::uint64_t>(record->get_signed(at)) : record->get(at);
      number.differs = number.differs || field.value != expected;
    }
    if (number.differs) stage.compared = Stage::Compared::differs;
  }
}

}  // namespace quadrille::explain
