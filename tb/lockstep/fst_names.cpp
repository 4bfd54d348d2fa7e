#include "tb/lockstep/fst_names.hpp"

// The reader that Verilator brings along, in the way in which it compiles it itself.
#define FST_CONFIG_INCLUDE "gtkwave/fst_config.h"
#include "gtkwave/fastlz.c"
#include "gtkwave/fstapi.c"
#include "gtkwave/lz4.c"

#include <algorithm>

namespace quadrille::tb {

std::set<std::string> fst_signal_names(const std::string& file) {
  std::set<std::string> names;
  void* reader = fstReaderOpen(file.c_str());
  if (reader == nullptr) return names;
  while (const fstHier* entry = fstReaderIterateHier(reader)) {
    if (entry->htyp == FST_HT_SCOPE) fstReaderPushScope(reader, entry->u.scope.name, nullptr);
    if (entry->htyp == FST_HT_UPSCOPE) fstReaderPopScope(reader);
    if (entry->htyp != FST_HT_VAR) continue;
    std::string name = std::string(fstReaderGetCurrentFlatScope(reader)) + "." + entry->u.var.name;
    std::erase(name, ' ');
    names.insert(name);
  }
  fstReaderClose(reader);
  return names;
}

}  // namespace quadrille::tb
