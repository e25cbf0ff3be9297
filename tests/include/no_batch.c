/* SH_NO_BATCH leaves out the intrinsics' headers. */
#define SH_NO_BATCH
#include "sh.h"

#if defined(_IMMINTRIN_H_INCLUDED) || defined(__IMMINTRIN_H) || defined(_XMMINTRIN_H_INCLUDED) || defined(__XMMINTRIN_H) || \
    defined(__ARM_NEON_H)
#error "SH_NO_BATCH includes intrinsics"
#endif

#define PROBE probe_no_batch
#include "probe.h"
