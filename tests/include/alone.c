/* sh.h needs nothing before it. */
#include "sh.h"

#define PROBE probe_alone
#include "probe.h"
