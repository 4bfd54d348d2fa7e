// The floating-point number of 113 bits of significand that the compiler has.
#pragma once

namespace quadrille {

#if __LDBL_MANT_DIG__ == 113
using Float113 = long double;  ///< aarch64, WebAssembly
#else
using Float113 = __float128;
#endif

}  // namespace quadrille
