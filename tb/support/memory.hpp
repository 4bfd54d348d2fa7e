// How much memory the process has.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace quadrille::tb {

/// Bytes of the process that are in memory now; 0 where the system does not say.
inline std::uint64_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t size = 0, resident = 0;
  statm >> size >> resident;
  return statm ? resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

}  // namespace quadrille::tb
