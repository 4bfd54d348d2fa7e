// Units of work on several threads in any order, with progress on the calling thread.
#pragma once

#include <cstddef>
#include <functional>

namespace quadrille::sweep {

/// Calls body(unit, thread) for every unit from 0; thread is below max(threads, 1) and no two calls of one thread
/// overlap. `progress` (may be empty) gets the number of finished units on the calling thread now and then. The first
/// exception, from either, ends the call after the running units and is rethrown.
void run_units(std::size_t units, unsigned threads, const std::function<void(std::size_t, unsigned)>& body,
               const std::function<void(std::size_t)>& progress = {});

}  // namespace quadrille::sweep
