/* sh.h included twice, with headers between that it uses itself. */
#include "sh.h"

#include <math.h>
#include <string.h>

#include "sh.h"

#define PROBE probe_twice
#include "probe.h"
