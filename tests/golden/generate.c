/* Prints the golden values of the backend that it was compiled for; tests/golden/update.sh makes the two files. */
#include <stdio.h>

#include "golden.h"

int main(void) {
    golden_compute();
    printf("/* From tests/golden/update.sh: results of sh.h as bits of floats, the vocabulary's multiply-add %s. */\n",
           golden_fuses() ? "fused" : "not fused");
    for (int i = 0; i < golden_count; i++) {
        printf("{ \"%s\", %d, {", golden[i].name, golden[i].count);
        for (int j = 0; j < golden[i].count; j++) {
            uint32_t bits;
            memcpy(&bits, &golden[i].value[j], sizeof bits);
            printf("%s0x%08lx", j == 0 ? " " : j % 12 == 0 ? ",\n    " : ", ", (unsigned long)bits);
        }
        printf(" } },\n");
    }
    return 0;
}
