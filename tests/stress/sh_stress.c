/* sh_stress - the worst error of every public function of sh.h, as Markdown.
 *
 *     sh_stress [--quick] [--part errors|sums|approximations] [--filter TEXT] [--count N] [--svg FILE]
 *
 * --quick runs a short form of everything in seconds; without it, each part takes minutes. --filter runs only the errors of functions
 * whose name contains TEXT. --count sets how long their search is. --svg writes the plot of the sums' errors. The exit status is 0 if
 * every bound holds and nothing was NaN. */
#define TEST_OWN_MAIN
#include "stress_accumulation.h"
#include "stress_analysis.h"
#include "stress_batches.h"
#include "stress_closures.h"
#include "stress_coefficients.h"
#include "stress_directions.h"
#include "stress_exhaustive.h"
#include "stress_images.h"
#include "stress_lights.h"
#include "stress_operators.h"

#define GROUP(title, cases) { title, cases, sizeof cases / sizeof cases[0] }
static const struct {
    const char *title;
    const stress_case *test;
    size_t count;
} stress_groups[] = {
    GROUP("Coefficients, reconstruction, zonal kernels", stress_coefficient_cases),
    GROUP("Bounded irradiance and other models", stress_closure_cases),
    GROUP("Analysis", stress_analysis_cases),
    GROUP("Operators, conversion, storage, fitting", stress_operator_cases),
    GROUP("Lights", stress_light_cases),
    GROUP("Directions and functions", stress_direction_cases),
    GROUP("Batches", stress_batch_cases),
    GROUP("Images", stress_image_cases),
};

typedef struct stress_options {
    int quick, count;
    const char *part, *filter, *svg;
} stress_options;

static int stress_parse(int argc, char **argv, stress_options *options) {
    for (int i = 1; i < argc; i++) {
        const char *value = i + 1 < argc ? argv[i + 1] : NULL;
        if (strcmp(argv[i], "--quick") == 0) {
            options->quick = 1;
            continue;
        }
        if (!value)
            return 0;
        if (strcmp(argv[i], "--part") == 0)
            options->part = value;
        else if (strcmp(argv[i], "--filter") == 0)
            options->filter = value;
        else if (strcmp(argv[i], "--count") == 0)
            options->count = atoi(value);
        else if (strcmp(argv[i], "--svg") == 0)
            options->svg = value;
        else
            return 0;
        i++;
    }
    return 1;
}

static int stress_errors(const stress_options *options) {
    const int count = options->count ? options->count : options->quick ? 300 : 20000;
    int bad = 0;
    printf("Backend: %s. Inputs of each class, and steps of each climb: %d, fewer for costly functions.\n\n", SH_SIMD_NAME, count);
    for (size_t g = 0; g < sizeof stress_groups / sizeof stress_groups[0]; g++) {
        printf("### %s\n\n| function | bound | uniform input | worst | class of the worst |\n|---|---|---|---|---|\n",
               stress_groups[g].title);
        for (size_t i = 0; i < stress_groups[g].count; i++)
            if (!options->filter || strstr(stress_groups[g].test[i].name, options->filter))
                bad += !stress_row(&stress_groups[g].test[i], count);
        printf("\n");
    }
    return bad;
}

static int stress_has(const stress_options *options, const char *part) {
    return !options->part || strcmp(options->part, part) == 0;
}

int main(int argc, char **argv) {
    stress_options options = { 0, 0, NULL, NULL, NULL };
    int bad = 0;
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ); /* rows appear as they are found */
    if (!stress_parse(argc, argv, &options)) {
        fprintf(stderr,
                "usage: sh_stress [--quick] [--part errors|sums|approximations] [--filter TEXT] [--count N] [--svg FILE]\n");
        return 2;
    }
    if (stress_has(&options, "errors"))
        bad += stress_errors(&options);
    if (stress_has(&options, "sums") && !options.filter) {
        printf("### Sums\n\n| sum | bound | worst |\n|---|---|---|\n");
        bad += stress_accumulation(options.quick, options.svg);
        printf("\n");
    }
    if (stress_has(&options, "approximations") && !options.filter) {
        printf("### Approximations\n\n| approximation | arguments | bound | worst |\n|---|---|---|---|\n");
        bad += stress_exhaustive(options.quick);
        printf("\n");
    }
    printf("%s\n", bad ? "Some bounds do not hold." : "Every bound holds.");
    return bad != 0;
}
