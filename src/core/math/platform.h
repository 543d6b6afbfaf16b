#pragma once

// What a translation unit needs to know about where it is compiled: the host alone, or host and device.

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
