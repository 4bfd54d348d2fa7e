// The tag that C++ exceptions of WebAssembly carry; the compiler's own library has none.
__asm__(
    ".tagtype __cpp_exception i32\n"
    ".globl __cpp_exception\n"
    "__cpp_exception:\n");
