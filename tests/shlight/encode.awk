# encode.awk - the test picture, 16 x 8, as octal escapes for printf, in one of the formats that shlight reads.
#   awk -v kind=KIND -f encode.awk     KIND: pfm-little, pfm-big, grey-little, grey-big, flat, old, new
#   -v first=-Y -v second=+X           Radiance: the order of scanlines and pixels
#   -v header='EXPOSURE=2'             Radiance: a line for the header
# Its radiances are 0, 1/4, 1/2, 1 and 2: exact in every format, so that every file has the same coefficients.

function radiance(x, y, k) { # as an index: 0, 1/4, 1/2, 1, 2
    if (y < 2)
        return k + 1
    if (y == 5)
        return x < 12 ? 3 - k : 4
    return (3 * x + 5 * y + 7 * k + int(x / 5) * y) % 5
}

function octal(value) { return sprintf("\\%d%d%d", int(value / 64), int(value / 8) % 8, value % 8) }

function text(s,    i, out) { # in octal too: printf takes it as it is
    for (i = 1; i <= length(s); i++)
        out = out octal(index(ascii, substr(s, i, 1)) + 31)
    return out
}

function pfm(channels, little,    x, y, k, i, bytes, out) {
    bytes[0] = "0 0 0 0"; bytes[1] = "62 128 0 0"; bytes[2] = "63 0 0 0"; bytes[3] = "63 128 0 0"; bytes[4] = "64 0 0 0"
    out = text(channels == 3 ? "PF" : "Pf") newline text("16 8") newline text((little ? "-" : "") scale) newline
    for (y = 7; y >= 0; y--)
        for (x = 0; x < 16; x++)
            for (k = 0; k < channels; k++) {
                split(bytes[radiance(x, y, k)], byte, " ")
                for (i = 1; i <= 4; i++)
                    out = out octal(byte[little ? 5 - i : i])
            }
    return out
}

# The mantissa with the exponent 130: 64 is 1. Component 3 is that exponent.
function rgbe(x, y, k,    i) {
    if (k == 3)
        return 130
    i = radiance(x, y, k)
    return i == 0 ? 0 : 8 * 2 ^ i
}

# Component k of pixel j of scanline i.
function scan(i, j, k,    x, y) {
    x = substr(first, 2) == "X" ? i : j
    y = substr(first, 2) == "X" ? j : i
    if ((substr(first, 2) == "X" ? first : second) == "-X")
        x = 15 - x
    if ((substr(first, 2) == "Y" ? first : second) == "+Y")
        y = 7 - y
    return rgbe(x, y, k)
}

function pixel(i, j) { return octal(scan(i, j, 0)) octal(scan(i, j, 1)) octal(scan(i, j, 2)) octal(scan(i, j, 3)) }

function flat_scanline(i,    j, out) {
    for (j = 0; j < pixels; j++)
        out = out pixel(i, j)
    return out
}

function old_scanline(i,    j, run, out) {
    for (j = 0; j < pixels; j += run) {
        for (run = 1; j + run < pixels && pixel(i, j + run) == pixel(i, j);)
            run++
        out = out pixel(i, j) (run > 1 ? octal(1) octal(1) octal(1) octal(run - 1) : "")
    }
    return out
}

function new_scanline(i,    j, k, run, out) {
    out = octal(2) octal(2) octal(0) octal(pixels)
    for (k = 0; k < 4; k++)
        for (j = 0; j < pixels; j += run) {
            for (run = 1; j + run < pixels && scan(i, j + run, k) == scan(i, j, k);)
                run++
            out = out (run > 1 ? octal(128 + run) : octal(1)) octal(scan(i, j, k))
        }
    return out
}

function radiance_picture(    i, out) {
    scanlines = substr(first, 2) == "X" ? 16 : 8
    pixels = 24 - scanlines
    out = text("#?RADIANCE") newline text("FORMAT=32-bit_rle_rgbe") newline
    out = out (header == "" ? "" : text(header) newline) newline
    out = out text(first " " scanlines " " second " " pixels) newline
    for (i = 0; i < scanlines; i++)
        out = out (kind == "flat" ? flat_scanline(i) : kind == "old" ? old_scanline(i) : new_scanline(i))
    return out
}

BEGIN {
    for (i = 32; i < 127; i++)
        ascii = ascii sprintf("%c", i)
    newline = octal(10)
    first = first == "" ? "-Y" : first
    second = second == "" ? "+X" : second
    scale = scale == "" ? "1" : scale
    if (kind ~ /^(pfm|grey)-/)
        print pfm(kind ~ /^pfm/ ? 3 : 1, kind ~ /little$/)
    else
        print radiance_picture()
}
