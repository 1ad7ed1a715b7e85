// multiversion.h: compiles a hot host function for several instruction sets.
#pragma once

// One version is picked at load time. Without contraction all versions give the same bits. The levels name features; a
// processor's name would only match that vendor's.
#if defined(__GNUC__) && !defined(__CUDACC__) && defined(__x86_64__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ESPDIFF_MULTIVERSION __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define ESPDIFF_MULTIVERSION
#endif
