/* The least that a user of sh.h does: white light from everywhere reads as white. */
#include "sh.h"

#include <stdio.h>

int main(void) {
    const float up[3] = { 0.0f, 0.0f, 1.0f };
    const float white[SH_COUNT(SH_L2)] = { 1.0f };
    float irradiance = sh_irradiance(SH_L2, white, up);

    printf("irradiance / pi = %g\n", (double)irradiance);
    return irradiance == 1.0f ? 0 : 1;
}
