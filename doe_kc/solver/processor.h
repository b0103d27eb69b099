/* Loops over matrices, compiled once for each set of vector instructions; the processor at hand chooses when the
   library is loaded. */
#include <stdlib.h>

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GLIBC__)
#define FOR_THIS_PROCESSOR __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define FOR_THIS_PROCESSOR
#endif

