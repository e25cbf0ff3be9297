/* What sh.h and its tests take from <string.h>, for clang in MSVC mode. */
#ifndef CI_STRING_H
#define CI_STRING_H

#include <stddef.h>

void *memcpy(void *, const void *, size_t);
void *memmove(void *, const void *, size_t);
void *memset(void *, int, size_t);
int memcmp(const void *, const void *, size_t);
int strcmp(const char *, const char *);
size_t strlen(const char *);

#endif
