/* Compiled several times, with PROBE and the flags of an instruction set given by the build. */
#include "sh.h"

#include "probe.h"
