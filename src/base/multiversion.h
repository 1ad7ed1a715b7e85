// multiversion.h: compiles a hot host function for several instruction sets.
#pragma once

// One version is picked at load time. Without contraction all versions give the same bits. The levels name features; a
// processor's name would only match that vendor's. A function whose vectors are as wide as AVX-512's has a wide version
// of its own, which may be called where has_wide_vectors().
#if defined(__GNUC__) && !defined(__CUDACC__) && defined(__x86_64__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ESPDIFF_MULTIVERSION __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#define ESPDIFF_NARROW_VERSION __attribute__((target_clones("default", "arch=x86-64-v3")))
#define ESPDIFF_WIDE_VERSION __attribute__((target("arch=x86-64-v4")))
namespace espdiff {
inline bool has_wide_vectors() { return __builtin_cpu_supports("x86-64-v4") != 0; }
}  // namespace espdiff
#else
#define ESPDIFF_MULTIVERSION
#define ESPDIFF_NARROW_VERSION
#define ESPDIFF_WIDE_VERSION
namespace espdiff {
inline bool has_wide_vectors() { return false; }
}  // namespace espdiff
#endif
