/* sh.h after the headers of the C library with the most macros: tgmath.h replaces the mathematical functions, complex.h defines I. */
#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#ifdef __cplusplus
#include <algorithm>
#include <cmath>
#include <complex>
using namespace std;
#else
#include <complex.h>
#include <tgmath.h>
#endif

#include "sh.h"

#define PROBE probe_last
#include "probe.h"
