// The rounding that the lanes rely on.
#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#elif !defined(__aarch64__) && !defined(__wasm__)
#include <cfenv>
#endif

namespace quadrille {

/// Rounds toward zero until it is gone. Results below the normal numbers, on which no bit hangs, are 0 where the
/// processor can: quicker.
class TowardZero {
 public:
  TowardZero() : before_(get()) { set(toward_zero); }
  ~TowardZero() { set(before_); }
  TowardZero(const TowardZero&) = delete;
  TowardZero& operator=(const TowardZero&) = delete;

 private:
#if defined(__x86_64__)
  using Word = unsigned;
  static constexpr Word toward_zero = _MM_MASK_MASK | _MM_ROUND_TOWARD_ZERO | _MM_FLUSH_ZERO_ON;
  static Word get() { return _mm_getcsr(); }
  static void set(Word word) { _mm_setcsr(word); }
#elif defined(__aarch64__)
  using Word = std::uint64_t;
  static constexpr Word toward_zero = Word{3} << 22 | Word{1} << 24;  // RMode, FZ
  static Word get() {
    Word word;
    asm volatile("mrs %0, fpcr" : "=r"(word));
    return word;
  }
  static void set(Word word) { asm volatile("msr fpcr, %0" : : "r"(word) : "memory"); }
#elif defined(__wasm__)
  using Word = int;  // it has no modes: wide_portable.hpp rounds by itself
  static constexpr Word toward_zero = 0;
  static Word get() { return 0; }
  static void set(Word) {}
#else
  using Word = int;
  static constexpr Word toward_zero = FE_TOWARDZERO;
  static Word get() { return std::fegetround(); }
  static void set(Word word) { std::fesetround(word); }
#endif
  Word before_;
};

}  // namespace quadrille
