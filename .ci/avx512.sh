#!/usr/bin/env bash
# avx512.sh PROGRAM...: runs static x86-64 programs on an emulated processor with AVX-512 (Bochs, as a Skylake-X), for machines that have
# none. Boots Debian's kernel with an initial file system that holds the programs and an init that runs them; prints what they print,
# after the name of each, and fails if one of them does. Takes half a minute to boot.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
mkdir -p "$dir/root/dev" "$dir/disk/isolinux" "$dir/kernel"

kernel=$(apt-cache depends linux-image-cloud-amd64 | sed -n 's/.*Depends: \(linux-image[^ ]*\)/\1/p' | head -n 1)
(cd "$dir/kernel" && apt-get -qq download "$kernel" && dpkg -x ./*.deb .)

for program; do
    cp "$program" "$dir/root/${program##*/}"
done
cat >"$dir/init.c" <<'C'
/* Process 1: runs the programs named in its list, writes to the serial line. */
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>
static char *const programs[] = {
#include "list.h"
    NULL
};
static void run(char *program) {
    char *const arguments[] = { program, NULL }, *const environment[] = { NULL };
    int status = 0;
    const pid_t child = fork();
    if (child == 0) {
        execve(program, arguments, environment);
        _exit(127);
    }
    waitpid(child, &status, 0);
    printf("%s: status %d\n", program, status);
    fflush(stdout);
}
int main(void) {
    mknod("/dev/ttyS0", S_IFCHR | 0600, makedev(4, 64));
    const int line = open("/dev/ttyS0", O_RDWR | O_NOCTTY);
    dup2(line, 1);
    dup2(line, 2);
    for (int i = 0; programs[i]; i++)
        run(programs[i]);
    printf("all done\n");
    fflush(stdout);
    for (;;)
        pause();
}
C
for program; do
    echo "\"/${program##*/}\","
done >"$dir/list.h"
gcc -O1 -static "$dir/init.c" -o "$dir/root/init"
(cd "$dir/root" && find . | cpio --quiet -o -H newc | gzip -1) >"$dir/disk/isolinux/initrd.gz"

# Of Bochs' processor features, Linux is not to see PKU (bit 515), XSAVEC (321) and XSAVES (323): it would reject the size that Bochs
# reports for a compacted state, and switch AVX off.
cp "$dir"/kernel/boot/vmlinuz-* "$dir/disk/isolinux/vmlinuz"
cp /usr/lib/ISOLINUX/isolinux.bin /usr/lib/syslinux/modules/bios/ldlinux.c32 "$dir/disk/isolinux/"
cat >"$dir/disk/isolinux/isolinux.cfg" <<'CFG'
DEFAULT linux
PROMPT 0
TIMEOUT 1
LABEL linux
 KERNEL vmlinuz
 APPEND initrd=initrd.gz console=ttyS0,115200 quiet nokaslr mitigations=off tsc=reliable lpj=1000000 nosmp noapic acpi=off clearcpuid=515,321,323 rdinit=/init panic=-1
CFG
xorriso -as mkisofs -o "$dir/disk.iso" -b isolinux/isolinux.bin -c isolinux/boot.cat -no-emul-boot -boot-load-size 4 -boot-info-table \
    "$dir/disk" >"$dir/xorriso.log" 2>&1
cat >"$dir/bochsrc" <<CFG
megs: 256
romimage: file=/usr/share/bochs/BIOS-bochs-latest
vgaromimage: file=/usr/share/vgabios/vgabios.stdvga.bin
cpu: model=corei7_skylake_x, count=1, ips=200000000, reset_on_triple_fault=0
ata0: enabled=1, ioaddr1=0x1f0, ioaddr2=0x3f0, irq=14
ata0-master: type=cdrom, path=$dir/disk.iso, status=inserted
boot: cdrom
com1: enabled=1, mode=file, dev=$dir/serial.txt
display_library: term
sound: waveoutdrv=dummy, waveindrv=dummy, midioutdrv=dummy
log: $dir/bochs.log
clock: sync=none, time0=local
CFG
echo c >"$dir/continue"
# Bochs wants a terminal, and is ended when the programs are done.
TERM=xterm script -qec "exec bochs -q -f $dir/bochsrc -rc $dir/continue" /dev/null >"$dir/terminal.log" </dev/null &
for _ in $(seq 300); do
    sleep 1
    if grep -q '^all done' "$dir/serial.txt" 2>/dev/null; then
        break
    fi
done
kill $! && wait $! || true
tr -d '\r' <"$dir/serial.txt" | grep -v '^\[ *[0-9.]*\]' | tee "$dir/output.txt"
[ "$(grep -c ': status 0$' "$dir/output.txt")" = $# ]
