/* sh_bench - run time and error of sh.h, beside a baseline and a physical limit that are measured in the same run.
 *
 * A topic is a file with a function that adds its cases to a list: see bench_case in bench.h. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200112L /* NOLINT(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): the name is POSIX's */
#endif

#include "../examples/output_file.h"

#include "bench_bounds.h"
#include "bench_closure.h"
#include "bench_eval.h"
#include "bench_models.h"
#include "bench_operators.h"
#include "bench_project.h"
#include "bench_sample.h"
#include "bench_skip.h"
#include "bench_square.h"
#include "bench_svg.h"

static const char usage[] = "usage: sh_bench [--list] [--filter TEXT] [--quick] [--json FILE] [--svg FILE] [--help]\n"
                            "       sh_bench --models FILE [--env FILE...]\n"
                            "       sh_bench --bounds FILE\n"
                            "\n"
                            "Measures sh.h: each case in turns with its baseline and with its physical limit.\n"
                            "\n"
                            "  --list         print the names of the cases, and measure nothing\n"
                            "  --filter TEXT  only cases whose name contains TEXT\n"
                            "  --quick        seconds instead of minutes, less repeatable\n"
                            "  --json FILE    write the results as JSON\n"
                            "  --svg FILE     plot run time against error\n"
                            "  --models FILE  measure the models of irradiance instead, and plot run time against model error\n"
                            "  --env FILE...  panoramas (PFM, multiples of 128x64) to add to the lights of that plot\n"
                            "  --bounds FILE  measure nothing, and draw the bounds and the closure of irradiance for eight lights\n"
                            "\n"
                            "Exit status: 0; 1 if an error is larger than its bound; 2 if something cannot be done.\n";

typedef struct bench_options {
    int list, quick, help;
    const char *filter, *json, *svg, *models, *bounds;
    const char *const *env; /* of argv */
    int env_count;
} bench_options;

/* One line on stderr; the status to exit with. */
static int complain(const char *what, const char *about) {
    fprintf(stderr, "sh_bench: %s '%s'\n", what, about);
    return 2;
}

/* ---- Command line ------------------------------------------------------------------------------------------------------------ */

static int parse(int argc, char **argv, bench_options *options) {
    memset(options, 0, sizeof *options);
    for (int i = 1; i < argc; i++) {
        const char *option = argv[i];
        const char **value = strcmp(option, "--filter") == 0 ? &options->filter
                             : strcmp(option, "--json") == 0 ? &options->json
                             : strcmp(option, "--svg") == 0  ? &options->svg
                             : strcmp(option, "--models") == 0 ? &options->models
                             : strcmp(option, "--bounds") == 0 ? &options->bounds
                                                             : NULL;
        if (value && i + 1 == argc)
            return complain("nothing follows", option);
        if (value)
            *value = argv[++i];
        else if (strcmp(option, "--env") == 0) {
            options->env = (const char *const *)(argv + i + 1);
            for (; i + 1 < argc && strncmp(argv[i + 1], "--", 2) != 0; i++)
                options->env_count++;
        } else if (strcmp(option, "--list") == 0)
            options->list = 1;
        else if (strcmp(option, "--quick") == 0)
            options->quick = 1;
        else if (strcmp(option, "--help") == 0 || strcmp(option, "-h") == 0)
            options->help = 1;
        else
            return complain("unknown option", option);
    }
    return 0;
}

static bench_list matching_cases(const char *filter) {
    bench_list all = { NULL, 0, 0 };
    bench_eval_cases(&all);
    bench_closure_cases(&all);
    bench_skip_cases(&all);
    bench_sample_cases(&all);
    bench_equirect_cases(&all);
    bench_square_cases(&all);
    bench_operator_cases(&all);
    int kept = 0;
    for (int i = 0; i < all.count; i++)
        if (!filter || strstr(all.cases[i].name, filter))
            all.cases[kept++] = all.cases[i];
    all.count = kept;
    return all;
}

/* ---- Output files ------------------------------------------------------------------------------------------------------------ */

static int cannot_write(const char *path, int error) {
    return error ? complain(strerror(error), path) : 0;
}

/* Whether a file can be written there: better known before minutes of measuring than after. */
static int check_output(const char *path) {
    output_file out;
    const int error = path ? output_open(path, &out) : 0;
    if (path && !error)
        output_close(&out, 0);
    return cannot_write(path, error);
}

typedef void (*bench_writer)(FILE *file, const bench_machine *machine, const bench_result *results, int count);

static int write_output(const char *path, bench_writer writer, const bench_machine *machine, const bench_result *results,
                        int count) {
    output_file out;
    int error = path ? output_open(path, &out) : 0;
    if (path && !error) {
        writer(out.file, machine, results, count);
        error = output_close(&out, 1);
    }
    return cannot_write(path, error);
}

/* ---- Main -------------------------------------------------------------------------------------------------------------------- */

static void measure_all(const bench_list *list, int quick, bench_result *results) {
    for (int i = 0; i < list->count; i++) {
        bench_case *test = &list->cases[i];
        test->prepare(test);
        results[i] = quick ? bench_measure(test, 0.012, 5) : bench_measure(test, 0.7, 5);
        bench_free_all();
        bench_print_result(&results[i], i ? &results[i - 1] : NULL);
    }
}

static int report_failures(const bench_result *results, int count) {
    int status = 0;
    for (int i = 0; i < count; i++)
        if (bench_failed(&results[i])) {
            fprintf(stderr, "sh_bench: %s: error %.1e, allowed %.1e\n", results[i].test->name, results[i].error,
                    results[i].test->error_bound);
            status = 1;
        }
    return status;
}

static int measure_and_report(const bench_list *list, const bench_options *options) {
    if (check_output(options->json) || check_output(options->svg))
        return 2;
    const bench_machine machine = bench_describe_machine();
    bench_result *results = (bench_result *)bench_check(calloc((size_t)list->count, sizeof *results));
    bench_print_heading(&machine);
    measure_all(list, options->quick, results);
    int status = report_failures(results, list->count);
    if (write_output(options->json, bench_write_json, &machine, results, list->count) ||
        write_output(options->svg, bench_write_svg, &machine, results, list->count))
        status = 2;
    free(results);
    return status;
}

/* The chart of models, with panoramas from `env`; or without models, that of bounds. */
static int draw(const char *path, int models, const char *const *env, int env_count) {
    output_file out;
    int unread = 0, error = output_open(path, &out);
    if (error)
        return cannot_write(path, error);
    if (models)
        unread = bench_models(out.file, env, env_count);
    else
        bench_bounds(out.file);
    error = output_close(&out, !unread);
    /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a panorama that cannot be read is one of the list */
    return unread ? complain("cannot read panorama", env[unread - 1]) : cannot_write(path, error);
}

int main(int argc, char **argv) {
    bench_options options;
    if (parse(argc, argv, &options))
        return 2;
    if (options.help) {
        fputs(usage, stdout);
        return 0;
    }
    if (options.models || options.bounds) {
        const int failed = options.models ? draw(options.models, 1, options.env, options.env_count) : 0;
        return options.bounds && draw(options.bounds, 0, NULL, 0) ? 2 : failed;
    }
    bench_list list = matching_cases(options.filter);
    int status = 0;
    if (list.count == 0)
        status = complain("no case name contains", options.filter);
    else if (options.list)
        for (int i = 0; i < list.count; i++)
            puts(list.cases[i].name);
    else
        status = measure_and_report(&list, &options);
    free(list.cases);
    if (fflush(stdout) != 0)
        return complain("cannot write", "standard output");
    return status;
}
