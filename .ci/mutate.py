#!/usr/bin/env python3
"""Mutation check: breaks include/sh.h in one place after the other, and reports what no test notices.

    .ci/coverage.sh DIR; .ci/mutate.py --coverage DIR [--sample N] [--seed S] [--jobs J] [--only REGEX] [--results FILE]
        [--address]

A mutant is a header in which one operator, comparison, constant, index, variable, function or statement is another one. Hundreds are
compiled into one header, where each is a copy of its function that a variable chooses. The tests that execute its line run until one
fails, fast ones and those of its section first, as the scalar backend; kernels that survive this, and what only the AVX2 backend
compiles, as the AVX2 backend. A test that runs out of time fails. Mutants that do not compile do not count. .ci/mutants.txt argues why some survive. Exits with 1 where less than
95 % of the others are killed.

--sample N   N mutants that count, drawn by the seed and by what they are; default: all
--only REGEX mutants of the sections and functions whose names match
--results F  one JSON object a line; mutants that it says are killed are not run again
--address    under the address sanitizer as well, as CI runs the tests: slow, for those that survive without
"""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEADER = ROOT / "include/sh.h"
LEAST = 95.0
FLAGS = {"scalar": ["-DSH_NO_SIMD"], "avx2": ["-mavx2", "-mfma"]}

# What CI's sanitizers would see as well, and costs next to nothing; a variable that is not set is NaN.
SANITIZERS = ["-fsanitize=bounds,shift,float-cast-overflow,signed-integer-overflow,integer-divide-by-zero", "-fsanitize-trap=all",
              "-ftrivial-auto-var-init=pattern"]

# ---- Mutants ----

Mutant = collections.namedtuple("Mutant", "start end text line function section variant name")

SWAPS = {
    "+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "<<": ">>", ">>": "<<", "&": "|", "|": "&", "==": "!=", "!=": "==",
    "<": "<= >=", "<=": "< >", ">": ">= <=", ">=": "> <", "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=",
    "|=": "&=", "&=": "|=", "++": "--", "--": "++", "x": "y", "y": "z", "z": "x", "a": "b", "b": "a", "xx": "xy", "xy": "xz",
    "xz": "yz", "yy": "xx", "yz": "xy", "zz": "xx", "SH_L0": "SH_L1", "SH_L1": "SH_L2", "SH_L2": "SH_L1", "SH_R0": "SH_X",
    "SH_X": "SH_Y", "SH_Y": "SH_Z", "SH_Z": "SH_X", "SH_XX": "SH_XY", "SH_XY": "SH_XZ", "SH_XZ": "SH_YY", "SH_YY": "SH_YZ",
    "SH_YZ": "SH_XX", "cos": "sin", "sin": "cos", "sqrt": "", "sqrtf": "", "fabs": "", "fabsf": "", "shi_add": "shi_sub",
    "shi_sub": "shi_add", "shi_mul": "shi_add", "shi_div": "shi_mul", "shi_min": "shi_max", "shi_max": "shi_min",
    "shi_abs": "", "shi_sqrt": "", "shi_shl": "shi_shr", "shi_shr": "shi_shl", "_mm256_add_ps": "_mm256_sub_ps",
    "_mm256_sub_ps": "_mm256_add_ps", "_mm256_mul_ps": "_mm256_add_ps", "_mm256_div_ps": "_mm256_mul_ps",
    "_mm256_fmadd_ps": "_mm256_fmsub_ps", "_mm256_min_ps": "_mm256_max_ps", "_mm256_max_ps": "_mm256_min_ps",
    "_mm256_unpacklo_ps": "_mm256_unpackhi_ps", "_mm256_unpackhi_ps": "_mm256_unpacklo_ps", "_mm256_or_ps": "_mm256_and_ps",
    "_mm256_unpacklo_pd": "_mm256_unpackhi_pd", "_mm256_unpackhi_pd": "_mm256_unpacklo_pd", "_CMP_LT_OQ": "_CMP_LE_OQ",
    "_mm256_slli_epi32": "_mm256_srli_epi32", "_mm256_srli_epi32": "_mm256_srai_epi32", "_mm256_add_epi32": "_mm256_sub_epi32",
    "_mm256_and_si256": "_mm256_or_si256", "_mm256_andnot_ps": "_mm256_and_ps",
}
# clang-format puts spaces on both sides of a binary operator, and of nothing else.
BINARY = re.compile(r"(?<=[\w)\]}] )(?:[-+*/%&|<>]|<<|>>|[=!<>]=|&&|\|\||[-+*/&|]=)(?=[ \n])")
STEP = re.compile(r"\+\+|--")
SIGN = re.compile(r"(?:(?<=[(\[])|(?<=[,=?:] )|(?<=return ))[-!](?=[\w(])")
NUMBER = re.compile(r"(?<![\w.])(?:0x[0-9a-fA-F]+u?|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?[fu]?)(?![\w.])")
WORD = re.compile(r"\b[A-Za-z_]\w*\b")
ARRAY_SIZE = re.compile(r"^ *(?:(?:const|static|unsigned) )*(?!return|case)\w+ (?:\*?\w+(?:\[[^\]]*\])*(?: = (?:\{[^}]*\}|[-\w.]+))?, )*"
                        r"\w+(?:\[[^\]]*\])+", re.M)
PARAMETERS = re.compile(r"^SHI_(?:INLINE|FUNCTION) [^{;]*", re.M)
STATEMENT = re.compile(r"^ +(\*?\w+(?:(?:\.|->)\w+|\[[^\]]*\])*(?:(?: [-+*/|&]?= .*|\(.*\)|\+\+|--));|break;|continue;)$", re.M)


def other_numbers(text):
    """An integer's neighbours; a floating-point number 1e-3 of itself further, or 1 for 0."""
    body = text.rstrip("u") if text.startswith("0x") else text.rstrip("fu")
    suffix = text[len(body):]
    if re.search(r"[.eE]", body) and not body.startswith("0x"):
        return [repr(float(body) * 1.001 or 1.0) + suffix]
    value = int(body, 0)
    return [str(n) + suffix for n in (value + 1, value - 1) if n >= 0]


def blank(text):
    """Comments and strings replaced by as many blanks; line ends stay."""
    return re.sub(r'/\*.*?\*/|//[^\n]*|"[^"\n]*"', lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.S)


def edits(code):
    """(start, end, replacement) of every mutant. More room in an array changes nothing."""
    for pattern, part in (ARRAY_SIZE, r"\[[^\]]*\]"), (PARAMETERS, r".+"):
        code = pattern.sub(lambda m: re.sub(part, lambda n: re.sub(r"\w", "_", n[0]), m[0]), code)
    for pattern in (BINARY, STEP, WORD):
        for m in pattern.finditer(code):
            for other in SWAPS[m[0]].split(" ") if m[0] in SWAPS else []:
                yield m.start(), m.end(), other
    for m in SIGN.finditer(code):
        yield m.start(), m.end(), ""
    for m in NUMBER.finditer(code):
        for other in other_numbers(m[0]):
            yield m.start(), m.end(), other
    for m in STATEMENT.finditer(code):
        yield m.start(1), m.end(1), ";"


class Place:
    """Which function, section and backend each line belongs to."""

    def __init__(self, lines, has_code):
        self.has_code = has_code
        self.function, self.section, self.code_line, self.variant, self.kernels = {}, {}, {}, {}, None
        section = function = code_line = variant = None
        sections = 0
        for n, text in enumerate(lines, 1):
            if heading := re.match(r"/\* ---- (.*?) -+(?: \*/)?$", text):
                sections += heading[1].startswith("Coefficients")
                section = heading[1].split(":")[0]
                self.kernels = n if section == "Vector vocabulary" else self.kernels
            # The prototypes come first; the implementation begins with the second section of this name.
            if sections < 2:
                continue
            if re.match(r"(SHI_INLINE|SHI_FUNCTION|static|typedef|enum|#define) ?", text):
                name = re.search(r"\b(shi?_\w+)\(", text) or re.match(r"#define (\w+)|enum \{ (\w+)", text)
                function = next(filter(None, name.groups())) if name else None
                code_line, variant = None, "scalar" if text[0] in "#e" else None
            if variant != "scalar" and n in has_code["scalar"] or variant is None and n in has_code["avx2"]:
                variant = "scalar" if n in has_code["scalar"] else "avx2"
            if variant and n in has_code[variant]:
                code_line = n
            self.function[n], self.section[n], self.code_line[n], self.variant[n] = function, section, code_line, variant
            if re.match(r"\}|.*\}$", text) and not text.startswith(" "):
                function = variant = None

    def compiles(self, mutant, variant):
        """Whether the variant has code of the mutant that is worth trying."""
        return mutant.variant == variant or mutant.line > self.kernels and self.code_line[mutant.line] in self.has_code[variant]


def all_mutants(source, has_code):
    code = blank(source)
    lines = source.split("\n")
    place = Place(lines, has_code)
    starts = [0]
    for text in lines:
        starts.append(starts[-1] + len(text) + 1)
    line = 1
    found = []
    for start, end, text in sorted(set(edits(code))):
        while starts[line] <= start:
            line += 1
        where = lines[line - 1]
        skip = re.match(r" *#(if|elif|include|error|pragma|define \w+\()|for \(.*(\+\+|--)\) ?\{?$", where)
        if skip and where.lstrip().startswith("#") or not place.variant.get(line) or not place.function[line]:
            continue
        if text in ("++", "--") and re.match(r" *for \(", where):
            continue
        at = start - starts[line - 1]
        name = "%s{%s -> %s}%s" % (where[:at], source[start:end], text, where[at + end - start:])
        section = place.section[line] + (" (AVX2)" if place.variant[line] == "avx2" else "")
        found.append(Mutant(start, end, text, line, place.function[line], section, place.variant[line], name.strip()))
    return found, place


def shuffled(mutants, seed):
    """In an order that a change of one function leaves to the mutants of the others."""
    seen = collections.Counter()

    def rank(mutant):
        seen[mutant.function, mutant.name] += 1
        text = "%d %s %s %d" % (seed, mutant.function, mutant.name, seen[mutant.function, mutant.name])
        return hashlib.sha256(text.encode()).digest()

    return sorted(mutants, key=rank)


# ---- Headers ----

FUNCTION = re.compile(r"^SHI_(?:INLINE|FUNCTION) [^;{}]*?\b(\w+)\(([^;{}]*)\) \{", re.M)
CHOICE = """#include <stdlib.h>
static int mutant;
__attribute__((constructor)) static void mutant_read(void) {
    const char *text = getenv("MUTANT");
    mutant = text ? atoi(text) : 0;
}
"""


def functions(code):
    """(start, start of the body, end, name, names of the parameters) of every function."""
    for m in FUNCTION.finditer(code):
        end, depth = m.end(), 1
        while depth:
            depth += {"{": 1, "}": -1}.get(code[end], 0)
            end += 1
        parameters = [re.search(r"(\w+)(?:\[[^\]]*\])*$", p.strip())[1] for p in m[2].split(",")]
        yield m.start(), m.end() - 1, end, m[1], [p for p in parameters if p != "void"]


def header_of(source, mutants):
    """The header with all mutants, which are {number: mutant}; and for each of its lines the mutant's number or None. Leaves out what is
    not in a function."""
    pieces, at, owner = [CHOICE], 0, [None] * CHOICE.count("\n")
    inside = sorted(mutants.items(), key=lambda item: item[1].start)

    def add(text, number=None):
        pieces.append(text)
        owner.extend([number] * text.count("\n"))

    for start, body, end, name, parameters in functions(blank(source)):
        mine = [(n, m) for n, m in inside if body < m.start and m.end < end]
        add(source[at:start])
        at = start
        for n, m in mine:
            add(re.sub(r"\b%s\(" % name, "%s_%d(" % (name, n), source[start:body], count=1), n)
            add(source[body:m.start] + m.text + source[m.end:end] + "\n", n)
        if mine:
            cases = ["case %d: return %s_%d(%s);" % (n, name, n, ", ".join(parameters)) for n, _ in mine]
            add(source[start:body] + "{ switch (mutant) { " + " ".join(cases) + " } ")
            at = body + 1
    add(source[at:])
    return "".join(pieces).replace(" __attribute__((always_inline))", ""), owner + [None]


def preprocessed(header, variant):
    """What the compiler sees."""
    command = ["clang", "-std=c99", *FLAGS[variant], "-E", "-P", "-x", "c", "-"]
    return subprocess.run(command, input=header, capture_output=True, text=True).stdout


def valid_of(source, mutants, variant, folder):
    """Those of the mutants that compile."""
    while True:
        text, owner = header_of(source, mutants)
        pathlib.Path(folder, "sh.h").write_text(text)
        command = ["clang", "-std=c99", "-w", *FLAGS[variant], "-fsyntax-only", "-ferror-limit=0", "-x", "c", folder + "/sh.h"]
        errors = subprocess.run(command, capture_output=True, text=True).stderr
        bad = {owner[int(line) - 1] for line in re.findall(r"^[^\n:]*sh\.h:(\d+):\d+: (?:fatal )?error:", errors, re.M)}
        if not bad:
            return mutants
        if bad == {None}:
            sys.exit(errors)
        mutants = {n: m for n, m in mutants.items() if n not in bad}


# ---- Tests ----


class Tests:
    """What is known of the test programs: the lines that they execute, and their time."""

    def __init__(self, coverage, place, address):
        self.sanitizers = [*SANITIZERS, "-fsanitize=address"] if address else SANITIZERS
        self.slowness = 4 if address else 2
        self.place, self.hits, self.seconds, self.good = place, {}, {}, set()
        for file in coverage.glob("test_*.hits"):
            test = tuple(file.name.split(".")[:2])
            hits = read_hits(file)
            # Golden values notice every mutant, but know no right from wrong.
            if test[1] in FLAGS and test[0] != "test_golden" and any(hits.values()):
                self.hits[test] = hits
                self.seconds[test] = float(file.with_suffix(".seconds").read_text())

    def patience(self, test, section):
        """Less for a test that is fast and mostly executes the section."""
        lines = [n for n, count in self.hits[test].items() if count]
        share = sum(self.place.section.get(n) == section for n in lines) / len(lines)
        return (0.5 + self.seconds[test]) / (0.1 + share)

    def of(self, mutant, variant):
        """The tests that execute the mutant's line, the best first."""
        line = self.place.code_line[mutant.line]
        tests = [t for t in self.hits if t[1] == variant and (line is None or self.hits[t].get(line))]
        return sorted(tests, key=lambda test: self.patience(test, self.place.section[mutant.line]))


class Programs:
    """The test programs with one header, each compiled when it is needed."""

    def __init__(self, header, tests, folder):
        self.tests, self.folder = tests, folder
        pathlib.Path(folder, "sh.h").write_text(header)
        self.lock = {test: threading.Lock() for test in tests.hits}
        self.path = {}

    def get(self, test):
        """The program's path, or None if it does not compile."""
        with self.lock[test]:
            if test not in self.path:
                self.path[test] = self.compile(test)
            return self.path[test]

    def compile(self, test):
        program = "%s/%s.%s" % (self.folder, *test)
        command = ["clang", "-std=c99", "-O1", "-w", *FLAGS[test[1]], *self.tests.sanitizers, "-DTEST_STOP_AT_FAILURE",
                   '-DSH_ENVS_DIR="../shared/envs"', "-I" + self.folder, "tests/%s.c" % test[0], "-o", program, "-lm"]
        return None if subprocess.run(command, cwd=ROOT, stderr=subprocess.DEVNULL).returncode else program

    def passes(self, test, number):
        """The limit is a multiple of the time that the program took to measure the coverage."""
        command = ["prlimit", "--cpu=%d" % (2 + int(self.tests.slowness * self.tests.seconds[test])), "--core=0", self.get(test)]
        return subprocess.run(command, cwd=ROOT, env={**os.environ, "MUTANT": str(number)}, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL).returncode == 0

    def run(self, mutant, variant, number):
        """killed, survived or invalid, with the test that killed it."""
        for test in self.tests.of(mutant, variant):
            if not self.get(test):
                return "invalid", None
            if not self.passes(test, number):
                if number and test not in self.tests.good:
                    if not self.passes(test, 0):
                        raise RuntimeError("%s.%s fails before any mutation" % test)
                    self.tests.good.add(test)
                return "killed", test[0]
        return "survived", None


class Batch:
    """Mutants that are compiled together; those outside of functions, each for itself."""

    def __init__(self, source, mutants, tests, folder):
        self.source, self.tests, self.folder = source, tests, folder
        self.number = {m: n for n, m in enumerate(mutants, 1)}
        spans = [(body, end) for _, body, end, _, _ in functions(blank(source))]
        inside = {n: m for m, n in self.number.items() if any(b < m.start < e for b, e in spans)}
        self.alone = set(mutants) - set(inside.values())
        self.preprocessed = {variant: preprocessed(source, variant) for variant in FLAGS}
        self.programs = {}
        for variant in FLAGS:
            where = tempfile.mkdtemp(dir=folder)
            some = {n: m for n, m in inside.items() if tests.place.compiles(m, variant)}
            valid = valid_of(source, some, variant, where)
            programs = Programs(header_of(source, valid)[0], tests, where)
            self.programs.update({(m, variant): programs for m in valid.values()})

    def run(self, mutant):
        result = "invalid", None
        for variant in FLAGS:
            if result[0] != "killed":
                result = self.run_as(mutant, variant) or result
        return result

    def run_as(self, mutant, variant):
        """As one of the variants; None where it has no code of the mutant."""
        if (mutant, variant) in self.programs:
            return self.programs[mutant, variant].run(mutant, variant, self.number[mutant])
        header = self.source[:mutant.start] + mutant.text + self.source[mutant.end:]
        if mutant not in self.alone or preprocessed(header, variant) == self.preprocessed[variant]:
            return None
        with tempfile.TemporaryDirectory(dir=self.folder) as folder:
            return Programs(header, self.tests, folder).run(mutant, variant, 0)


def read_hits(file):
    return {int(line): int(count) for line, count in map(str.split, file.read_text().splitlines())}


# ---- Report ----


def read_arguments(path):
    """Lines `function, or * | text of the mutant's line, or * | reason`."""
    return [tuple(map(str.strip, line.split(" | "))) for line in path.read_text().splitlines() if line and line[0] != "#"]


BATCH = 500


def results_of(source, mutants, tests, jobs, known):
    """(mutant, (result, test)) in the order of the mutants."""
    for first in range(0, len(mutants), BATCH):
        some = mutants[first:first + BATCH]
        with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            batch = Batch(source, [m for m in some if m not in known], tests, folder)
            futures = [(m, None if m in known else pool.submit(batch.run, m)) for m in some]
            try:
                for mutant, future in futures:
                    yield mutant, future.result() if future else known[mutant]
            finally:
                pool.shutdown(cancel_futures=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--coverage", type=pathlib.Path, required=True)
    parser.add_argument("--sample", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", default="")
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--address", action="store_true")
    parser.add_argument("--list", action="store_true", help="print the mutants and run none")
    options = parser.parse_args()

    source = HEADER.read_text()
    has_code = {variant: read_hits(options.coverage / ("all.%s.hits" % variant)) for variant in FLAGS}
    mutants, place = all_mutants(source, has_code)
    arguments = read_arguments(ROOT / ".ci/mutants.txt")

    def argued(mutant):
        return next((a for a in arguments if a[0] in ("*", mutant.function) and (a[1] == "*" or a[1] in mutant.name)), None)

    for stale in sorted(set(arguments) - {argued(m) for m in mutants}):
        print("no such mutant, in .ci/mutants.txt: %s | %s" % stale[:2])

    mutants = [m for m in mutants if re.search(options.only, m.function) or re.search(options.only, m.section)]
    if options.sample:
        mutants = shuffled(mutants, options.seed)[:options.sample + options.sample // 4 + 10]
    if options.list:
        print("\n".join("%s | %s" % (m.function, m.name) for m in mutants))
        return 0
    known = {}
    if options.results and options.results.exists():
        before = {(r["function"], r["name"]): (r["result"], r["test"])
                  for r in map(json.loads, options.results.read_text().splitlines()) if r["result"] != "survived"}
        known = {m: before[m.function, m.name] for m in mutants if (m.function, m.name) in before}
    log = options.results.open("a") if options.results else None

    counts = collections.defaultdict(collections.Counter)
    valid = 0
    for mutant, (result, test) in results_of(source, mutants, Tests(options.coverage, place, options.address), options.jobs, known):
        if log and mutant not in known:
            print(json.dumps({**mutant._asdict(), "result": result, "test": test}), file=log, flush=True)
        if result == "survived":
            reason = argued(mutant)
            result = "argued" if reason else result
            print("%s: line %d, %s | %s%s" % (result, mutant.line, mutant.function, mutant.name,
                                               " | " + reason[2] if reason else ""), flush=True)
        counts[mutant.section][result] += 1
        valid += result != "invalid"
        if valid == options.sample:
            break

    total = sum(counts.values(), collections.Counter())
    for section, count in [*sorted(counts.items()), ("all", total)]:
        tried = count["killed"] + count["survived"]
        print("%6.2f %% of %4d killed, %3d argued: %s" % (100.0 * count["killed"] / max(tried, 1), tried, count["argued"], section))
    return total["killed"] < LEAST / 100.0 * (total["killed"] + total["survived"])


if __name__ == "__main__":
    sys.exit(main())
