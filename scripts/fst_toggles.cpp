// Bits that changed in a waveform, by scope: for scripts/switching.py, which builds it with the FST reader that comes
// with Verilator.
//   fst_toggles F.fst FIRST_TIME
// prints "toggles bits scope" lines. A net that several scopes know by a name counts once: where it is an output (its
// name ends in _o), the innermost of these, else where it is declared first. Changes before FIRST_TIME and of the clock
// do not count.
#include "fstapi.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace {

struct Net {
  std::string scope, value;
  std::size_t depth = 0;
  bool output = false, known = false;
  bool ignored = false;  ///< a clock, a parameter, what a lint rule wants
  std::uint32_t bits = 0;
  std::uint64_t toggles = 0;
};

struct Count {
  std::vector<Net> nets;
  std::uint64_t first_time = 0;

  void change(std::uint64_t time, fstHandle handle, const unsigned char* value) {
    Net& net = nets.at(handle);
    const std::size_t bits = net.bits;
    if (time >= first_time && !net.value.empty())
      for (std::size_t i = 0; i < bits; ++i) net.toggles += net.value[i] != static_cast<char>(value[i]) ? 1 : 0;
    net.value.assign(reinterpret_cast<const char*>(value), bits);
  }
};

void on_change(void* user, std::uint64_t time, fstHandle handle, const unsigned char* value) {
  static_cast<Count*>(user)->change(time, handle, value);
}
void on_long_change(void* user, std::uint64_t time, fstHandle handle, const unsigned char* value, std::uint32_t) {
  on_change(user, time, handle, value);
}

}  // namespace

int main(int argc, char** argv) {
  void* const file = argc == 3 ? fstReaderOpen(argv[1]) : nullptr;
  if (file == nullptr) {
    std::fprintf(stderr, "fst_toggles: %s\n", argc == 3 ? "not an FST file" : "usage: fst_toggles F.fst FIRST_TIME");
    return 2;
  }
  Count count;
  count.first_time = std::strtoull(argv[2], nullptr, 10);
  count.nets.resize(fstReaderGetMaxHandle(file) + 1);
  std::vector<std::string> scopes;
  while (const fstHier* item = fstReaderIterateHier(file)) {
    if (item->htyp == FST_HT_SCOPE) {
      scopes.push_back((scopes.empty() ? "" : scopes.back() + ".") + item->u.scope.name);
    } else if (item->htyp == FST_HT_UPSCOPE) {
      scopes.pop_back();
    } else if (item->htyp == FST_HT_VAR) {
      Net& net = count.nets.at(item->u.var.handle);
      const std::string name = item->u.var.name, plain = name.substr(0, name.find_first_of(" ["));
      const bool output = plain.ends_with("_o");
      net.bits = item->u.var.length;
      net.ignored =
          net.ignored || plain == "clk_i" || plain.starts_with("unused") || item->u.var.typ == FST_VT_VCD_PARAMETER;
      if (!net.known || (output && (!net.output || scopes.size() > net.depth))) {
        net.scope = scopes.empty() ? "" : scopes.back();
        net.depth = scopes.size();
        net.output = output;
      }
      net.known = true;
    }
  }
  fstReaderSetFacProcessMaskAll(file);
  fstReaderIterBlocks2(file, on_change, on_long_change, &count, nullptr);
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> by_scope;
  for (const Net& net : count.nets) {
    if (!net.known || net.ignored) continue;
    by_scope[net.scope].first += net.toggles;
    by_scope[net.scope].second += net.bits;
  }
  for (const auto& [scope, sum] : by_scope)
    std::printf("%llu %llu %s\n", static_cast<unsigned long long>(sum.first),
                static_cast<unsigned long long>(sum.second), scope.c_str());
  fstReaderClose(file);
  return 0;
}
