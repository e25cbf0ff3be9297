/* replay.c - runs a fuzz target without libFuzzer: on the files and folders named on the command line; and, with -n COUNT first, on so
 * many random variants of them, the same on every machine. Fails if there are no inputs. Before it dies of one it writes it to the
 * file failed-input. */
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FUZZ_NO_TARGET
#include "fuzz.h"

enum { REPLAY_SIZE = 4096, REPLAY_INPUTS = 4096, REPLAY_VARIANT = 192 };

typedef struct replay_input {
    uint8_t *bytes;
    size_t size;
} replay_input;

static replay_input replay_inputs[REPLAY_INPUTS];
static int replay_count;
static const uint8_t *replay_bytes; /* what is being run */
static size_t replay_size;

static void replay_died(int signal_number) {
    const int file = open("failed-input", O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file >= 0 && write(file, replay_bytes, replay_size) == (ssize_t)replay_size)
        close(file);
    signal(signal_number, SIG_DFL);
    raise(signal_number);
}

static void replay_run(const uint8_t *bytes, size_t size) {
    replay_bytes = bytes;
    replay_size = size;
    LLVMFuzzerTestOneInput(bytes, size);
}

static void replay_add_file(const char *path) {
    static uint8_t bytes[REPLAY_SIZE];
    FILE *file = fopen(path, "rb");
    if (!file || replay_count == REPLAY_INPUTS) {
        perror(path);
        exit(1);
    }
    replay_input *input = &replay_inputs[replay_count++];
    input->size = fread(bytes, 1, sizeof bytes, file);
    input->bytes = (uint8_t *)malloc(input->size + 1);
    if (!input->bytes)
        exit(1);
    memcpy(input->bytes, bytes, input->size);
    fclose(file);
}

static void replay_add(const char *path) {
    DIR *folder = opendir(path);
    if (!folder) {
        replay_add_file(path);
        return;
    }
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        char name[4096];
        if (entry->d_name[0] != '.' && snprintf(name, sizeof name, "%s/%s", path, entry->d_name) < (int)sizeof name)
            replay_add(name);
    }
    closedir(folder);
}

/* An input with its end cut or followed by another's, and a few bytes replaced. */
static size_t replay_vary(uint64_t *state, uint8_t variant[REPLAY_VARIANT]) {
    size_t size = 0;
    for (int part = 0; part < 2; part++) {
        const replay_input *input = &replay_inputs[fuzz_random(state) % (uint64_t)replay_count];
        const size_t cut = (size_t)fuzz_random(state) % (input->size + 1), room = REPLAY_VARIANT - size,
                     length = cut < room ? cut : room;
        memcpy(variant + size, input->bytes + (part && length < input->size ? input->size - length : 0), length);
        size += length;
    }
    for (uint64_t changes = fuzz_random(state) % 8; changes && size; changes--)
        variant[fuzz_random(state) % size] = (uint8_t)(fuzz_random(state) >> 32);
    return size;
}

int main(int argc, char **argv) {
    const int random = argc > 2 && strcmp(argv[1], "-n") == 0;
    const long variants = random ? atol(argv[2]) : 0;
    uint64_t state = 1;
    for (int i = random ? 3 : 1; i < argc; i++)
        replay_add(argv[i]);
    signal(SIGABRT, replay_died);
    signal(SIGSEGV, replay_died);
    signal(SIGBUS, replay_died);
    for (int i = 0; i < replay_count; i++)
        replay_run(replay_inputs[i].bytes, replay_inputs[i].size);
    for (long i = 0; i < variants && replay_count; i++) {
        uint8_t variant[REPLAY_VARIANT];
        const size_t size = replay_vary(&state, variant);
        replay_run(variant, size);
    }
    printf("%d inputs, %ld variants\n", replay_count, variants);
    return replay_count > 0 ? 0 : 1;
}
