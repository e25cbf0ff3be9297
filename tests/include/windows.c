/* sh.h after the macros that windows.h defines. */
#define near
#define far
#define IN
#define OUT
#define small char
#define min(a, b) (((a) < (b)) ? (a) : (b))
#define max(a, b) (((a) > (b)) ? (a) : (b))

#include "sh.h"

#define PROBE probe_windows
#include "probe.h"
