/* For clang's intrinsics' headers in MSVC mode. */
#include <stdlib.h>
