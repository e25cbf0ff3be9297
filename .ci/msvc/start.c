/* What the C run-time of MSVC has and that of mingw has not, or under another name: the mark of a program that uses floating-point
 * numbers, and the probe of the stack before a large frame. */
int _fltused = 0x9875;
__asm__(".text\n.globl __chkstk\n__chkstk: jmp ___chkstk_ms");
