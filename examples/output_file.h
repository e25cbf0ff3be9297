/* output_file.h - files that are complete or not there: written under another name, which only a whole one loses. Includers define
 * _POSIX_C_SOURCE as 200112L or more where the system is POSIX's. */
#ifndef OUTPUT_FILE_H
#define OUTPUT_FILE_H

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if !defined(_WIN32)
#include <sys/stat.h>
#endif

typedef struct output_file {
    FILE *file;
    const char *path;
    char *name; /* what it has until it is whole */
} output_file;

/* Whether `path` is something that a file must not replace, and is written to as it is: a link, such as /dev/stdout, a pipe, a device. */
static inline int output_is_special(const char *path) {
#if defined(_WIN32)
    (void)path;
    return 0;
#else
    struct stat status;
    return lstat(path, &status) == 0 && !S_ISREG(status.st_mode);
#endif
}

static inline int output_errno(void) {
    const int error = errno;
    return error ? error : EIO;
}

/* 0, or errno and nothing to close. */
static inline int output_open(const char *path, output_file *out) {
    const size_t size = strlen(path) + sizeof ".part";
    out->path = path;
    out->name = (char *)malloc(size);
    if (!out->name)
        return ENOMEM;
    snprintf(out->name, size, "%s%s", path, output_is_special(path) ? "" : ".part");
    errno = 0;
    out->file = fopen(out->name, "wb");
    if (out->file)
        return 0;
    const int error = output_errno();
    free(out->name);
    return error;
}

/* Closes the file, and gives it its name if `keep` and all of it could be written; otherwise removes it. 0, or errno. */
static inline int output_close(output_file *out, int keep) {
    const int special = strcmp(out->name, out->path) == 0;
    errno = 0;
    int error = fflush(out->file) != 0 || ferror(out->file) ? output_errno() : 0;
    if (fclose(out->file) != 0 && !error)
        error = output_errno();
#if defined(_WIN32)
    if (keep && !error)
        remove(out->path); /* rename does not replace a file there */
#endif
    if (keep && !error && !special && rename(out->name, out->path) != 0)
        error = output_errno();
    if ((!keep || error) && !special)
        remove(out->name);
    free(out->name);
    return error;
}

#endif /* OUTPUT_FILE_H */
