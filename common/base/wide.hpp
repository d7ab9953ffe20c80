#pragma once

/// FATHOM_WIDE marks a function whose loops the compiler makes twice: for every processor, and for those with
/// 256-bit vectors, chosen when the program starts. Only for loops whose elements do not depend on each
/// other: then both give the same bits, for neither fuses a product with a sum.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define FATHOM_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define FATHOM_WIDE
#endif
/// What such a function calls has to be part of it.
#define FATHOM_WITHIN [[gnu::always_inline]] inline
