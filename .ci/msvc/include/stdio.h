/* What the tests take from <stdio.h>, for clang in MSVC mode. mingw's C library formats. */
#ifndef CI_STDIO_H
#define CI_STDIO_H

#include <stdarg.h>
#include <stddef.h>

#define EOF (-1)

typedef struct _iobuf FILE;

int __mingw_printf(const char *, ...);
int __mingw_snprintf(char *, size_t, const char *, ...);
int __mingw_vsnprintf(char *, size_t, const char *, va_list);
#define printf __mingw_printf
#define snprintf __mingw_snprintf
#define vsnprintf __mingw_vsnprintf

FILE *fopen(const char *, const char *);
int fclose(FILE *);
size_t fread(void *, size_t, size_t, FILE *);
int fscanf(FILE *, const char *, ...);
int fgetc(FILE *);

#endif
