/* What the probes and their main agree on. */
#ifndef PROBES_H
#define PROBES_H

enum {
    PROBE_SCALAR = 23,           /* results that every probe computes */
    PROBE_SIZE = PROBE_SCALAR + 27 /* and those that need images, left out by SH_NO_BATCH */
};

#ifdef __cplusplus
extern "C" {
#endif

/* Each writes its results and returns how many. The first group is in files of its own, ... */
int probe_alone(float result[PROBE_SIZE]);
int probe_twice(float result[PROBE_SIZE]);
int probe_last(float result[PROBE_SIZE]);
int probe_windows(float result[PROBE_SIZE]);
int probe_no_batch(float result[PROBE_SIZE]);

/* ... the second is unit.c, compiled with different flags and as C++. */
int probe_default(float result[PROBE_SIZE]);
int probe_scalar(float result[PROBE_SIZE]);
int probe_cxx(float result[PROBE_SIZE]);
int probe_avx2(float result[PROBE_SIZE]);
int probe_avx512(float result[PROBE_SIZE]);

#ifdef __cplusplus
}
#endif

#endif
