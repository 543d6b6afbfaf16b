#pragma once

// What a translation unit must know about its target: the host alone, or host and device; and the instruction set, if
// it is compiled for several.

// Code that is compiled once per instruction set is in a namespace of its own each time. Otherwise the linker would use
// one copy of an inline function for all of them (render/kernels).
#if defined(ALHAZEN_ISA)
#define ALHAZEN_CORE alhazen::impl::inline ALHAZEN_ISA
#else
#define ALHAZEN_CORE alhazen::impl
#endif

#if defined(__CUDACC__)
#define ALHAZEN_HD __host__ __device__
#else
#define ALHAZEN_HD
#endif

#if defined(__CUDACC__)
#define ALHAZEN_INLINE __forceinline__
#elif defined(__GNUC__)
#define ALHAZEN_INLINE inline __attribute__((always_inline))
#else
#define ALHAZEN_INLINE inline
#endif

// Follows the parameters of a lambda in a hot loop.
#if defined(__GNUC__) && !defined(__CUDACC__)
#define ALHAZEN_INLINE_LAMBDA __attribute__((always_inline))
#else
#define ALHAZEN_INLINE_LAMBDA
#endif

// Rare parts of hot loops, which are better not inlined.
#if defined(__GNUC__) && !defined(__CUDACC__)
#define ALHAZEN_NOINLINE __attribute__((noinline))
#else
#define ALHAZEN_NOINLINE
#endif

// Small functions of the inner loops, which GCC does not inline by itself in large functions; nvcc does.
#if defined(__GNUC__) && !defined(__CUDACC__)
#define ALHAZEN_HOT inline __attribute__((always_inline))
#else
#define ALHAZEN_HOT inline
#endif

// Large functions that few scenes need. They are not inlined into loops, whose registers they would take on GPUs.
#if defined(__CUDACC__)
#define ALHAZEN_COLD inline __noinline__
#elif defined(__GNUC__)
#define ALHAZEN_COLD inline __attribute__((noinline))
#else
#define ALHAZEN_COLD inline
#endif

// Code that hardly ever runs; compilers move it away from the hot code.
#if defined(__GNUC__) && !defined(__CUDACC__)
#define ALHAZEN_RARE __attribute__((noinline, cold))
#define ALHAZEN_UNLIKELY(condition) __builtin_expect(condition, 0)
#elif defined(__CUDACC__)
#define ALHAZEN_RARE __noinline__
#define ALHAZEN_UNLIKELY(condition) (condition)
#else
#define ALHAZEN_RARE
#define ALHAZEN_UNLIKELY(condition) (condition)
#endif

// Precedes a loop of independent iterations, so that the compiler vectorizes it.
#if defined(__clang__)
#define ALHAZEN_SIDE_BY_SIDE _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__) && !defined(__CUDACC__)
#define ALHAZEN_SIDE_BY_SIDE _Pragma("GCC ivdep")
#else
#define ALHAZEN_SIDE_BY_SIDE
#endif
