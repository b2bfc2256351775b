// For the few hot loops: one source compiled for several instruction sets, chosen when the program starts.
#pragma once

// Under ThreadSanitizer there is one version: the choice would run before the sanitizer is ready, and crash.
//
// Nothing is contracted and sums go over fixed lanes, so every version gives the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define LATERNA_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define LATERNA_CLONES
#endif
