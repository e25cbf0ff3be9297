/* What sh.h and its tests take from <stdlib.h>, for clang in MSVC mode. */
#ifndef CI_STDLIB_H
#define CI_STDLIB_H

#include <stddef.h>

void *malloc(size_t);
void *calloc(size_t, size_t);
void free(void *);
void exit(int);
int abs(int);
char *getenv(const char *);
void qsort(void *, size_t, size_t, int (*)(const void *, const void *));

#endif
