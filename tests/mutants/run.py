"""Run the mutants of a built copy (instrument.py): run.py TREE EQUIVALENT SECONDS.

First every test program of less than three minutes runs once without a mutant, which says how much processor time it
takes and which mutants it reaches (TREE/reached.tsv). Then each mutant runs in the tests that reach it until one case
fails: it is killed. Quick tests come first, and of these the ones that reach few mutants, have killed many or are
named like the file. A test that takes six times as much processor time as before has failed too: a loaded machine does
not change that. test_laws and test_acts try fewer scenes than in `make test`. A limit to the time by the clock, far
longer, is for tests that wait indefinitely. After the first of TURNS_S of tests a mutant waits until all others had
their turn, then for the next of them: most survivors would run for minutes, and most of the others are killed within a
second.
TREE/results.tsv has rows of number, killed or waiting or survived or unreached, the test that killed it, and how:
failed, processor time or clock; the last row of a number counts. TREE/passed.tsv has rows of number and a test that
it passed. Rows that the files have are kept, so that the same command goes on where it stopped: after SECONDS. A test
whose program changed since is as new, and mutants that survived wait for it; one that was killed stays so.
EQUIVALENT lists mutants that change nothing that can be seen: file, the whole line, text, changed text, why."""

import concurrent.futures
import glob
import hashlib
import math
import os
import resource
import subprocess
import sys
import threading
import time

LONGEST_S = 180  # longer tests are left out; seconds of processor time, like TURNS_S
TURNS_S = (2, 8, 30, math.inf)
FAILED = b"[  ERROR   ]"  # cmocka says so at once where a case fails; those that follow are not waited for
EXCLUDED = ("test_lab", "test_http", "test_bad_meshes", "test_study_estimate")  # need a server or quiet processors
writing = threading.Lock()


def environment(**more):
    here = os.getcwd()
    return {**os.environ, "LAWS_SCENES": "500", "ACTS_SCENE": "rod.yaml", "CUVETTE": f"{here}/build/cuvette",
            "CUVETTE_IMPORT": f"{here}/build/cuvette-import", **more}


def limits(cpu_s):
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(cpu_s), math.ceil(cpu_s)))


def run(test, cpu_s, clock_s, end, **more):
    """How the test ends within its limits (passed, failed, processor time, clock; None: the end of all came first), the
    seconds of processor time and those of the clock."""
    begun = time.monotonic()
    if begun > end:
        return None, 0.0, 0.0
    process = subprocess.Popen([f"build/tests/{test}"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, env=environment(**more),
                               preexec_fn=lambda: limits(cpu_s), start_new_session=True)
    os.set_blocking(process.stderr.fileno(), False)
    pid, pause_s, how, said = 0, 0.001, "", b""
    while not how:
        time.sleep(pause_s)
        pause_s = min(0.05, 1.2 * pause_s)
        pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        now = time.monotonic()
        said = said[1 - len(FAILED):] + (process.stderr.read() or b"")
        how = ("ended" if pid else "failed" if FAILED in said else "clock" if now - begun > clock_s
               else "stopped" if now > end else "")
    process.stderr.close()
    try:
        os.killpg(process.pid, 9)
    except ProcessLookupError:
        pass
    if not pid:
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    used_s = usage.ru_utime + usage.ru_stime
    if how == "ended":
        how = "passed" if process.returncode == 0 else "processor time" if used_s > cpu_s - 1 else "failed"
    return None if how == "stopped" else how, used_s, now - begun


def append(path, *fields):
    with writing, open(path, "a") as file:
        file.write("\t".join(map(str, fields)) + "\n")


def rows_of(path):
    """The last row of each first field."""
    if not os.path.exists(path):
        return {}
    with open(path) as file:
        return {line.split("\t")[0]: line.rstrip("\n").split("\t") for line in file}


def digest(test):
    with open(f"build/tests/{test}", "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def forget(tests):
    """Mutants have not passed these tests, and those that survived wait for them."""
    if os.path.exists("passed.tsv"):
        with open("passed.tsv") as file:
            kept = [line for line in file if line.split()[1] not in tests]
        with open("passed.tsv.new", "w") as file:
            file.writelines(kept)
        os.rename("passed.tsv.new", "passed.tsv")
    for number, verdict, *_ in rows_of("results.tsv").values():
        if tests and verdict in ("survived", "unreached"):
            append("results.tsv", number, "waiting", "", "")


def measure(end, pool):
    """Adds rows of test, seconds of processor time ("-": left out), of the clock, reached mutants, digest of the
    program; returns whether all tests have one."""
    known = rows_of("reached.tsv")
    names = [os.path.basename(path) for path in sorted(glob.glob("build/tests/test_*"))]
    names = [test for test in names if "." not in test and not test.startswith(EXCLUDED)]
    left = [test for test in names if test not in known or known[test][4] != digest(test)]
    forget(left)
    return all(pool.map(lambda test: measure_one(test, end), left))


def measure_one(test, end):
    path = os.path.abspath(f"reached.{test}")
    if os.path.exists(path):
        os.unlink(path)
    how, cpu_s, clock_s = run(test, LONGEST_S, 10 * LONGEST_S, end, MUTANT_REACHED=path)
    reached = []
    if os.path.exists(path):
        with open(path) as file:
            reached = sorted({int(line) for line in file})
        os.unlink(path)
    if how is None:
        return False
    left_out = "" if how == "passed" else f", left out: {how} without a mutant"
    print(f"{test}: {cpu_s:.1f} s of processor time, reaches {len(reached)}{left_out}", flush=True)
    append("reached.tsv", test, "-" if left_out else f"{cpu_s:.3f}", f"{clock_s:.3f}", ",".join(map(str, reached)),
           digest(test))
    return True


class Test:
    def __init__(self, name, cpu_s, clock_s, reached):
        self.name, self.cpu_s, self.clock_s = name, float(cpu_s), float(clock_s)
        self.reaches = set(map(int, filter(None, reached.split(","))))
        self.runs = self.kills = 0

    def cost(self, words):
        """The processor time that a kill is likely to take, of a mutant in a file of these words."""
        likely = 1.0 / math.sqrt(len(self.reaches)) + (1.0 if words & set(self.name.split("_")) else 0.0)
        return (self.cpu_s + 0.02) * (self.runs + 2.0) / (self.kills + likely)


def tests_measured():
    return [Test(*row[:4]) for row in rows_of("reached.tsv").values() if row[1] != "-" and row[3]]


def passed_before():
    passed = {}
    if os.path.exists("passed.tsv"):
        with open("passed.tsv") as file:
            for number, test in (line.split() for line in file):
                passed.setdefault(number, set()).add(test)
    return passed


def judge(mutant, tests, passed, end, limit_s):
    """Adds a row of a mutant after at most limit_s of tests that it has not passed before."""
    number, path = mutant[:2]
    words = set(os.path.splitext(os.path.basename(path))[0].split("_"))
    own = [test for test in tests if int(number) in test.reaches]
    left = sorted((t for t in own if t.name not in passed.get(number, ())), key=lambda t: t.cost(words))
    used_s = 0.0
    for test in left:
        if used_s >= limit_s:
            break
        if test.cpu_s > limit_s:
            continue
        most_s = 6 * test.cpu_s + 10
        how, cpu_s, _ = run(test.name, most_s, 20 * test.clock_s + 10 * most_s, end, MUTANT=number)
        if how is None:
            return
        used_s += cpu_s
        test.runs, test.kills = test.runs + 1, test.kills + (how != "passed")
        if how != "passed":
            append("results.tsv", number, "killed", test.name, how)
            return
        append("passed.tsv", number, test.name)
        passed.setdefault(number, set()).add(test.name)
    lacking = any(test.name not in passed.get(number, ()) for test in own)
    append("results.tsv", number, "waiting" if lacking else "survived" if own else "unreached", "", "")


def main():
    with open(sys.argv[2]) as file:
        equivalent = {tuple(line.split("\t")[:4]) for line in file}
    os.chdir(sys.argv[1])
    end = time.monotonic() + float(sys.argv[3])
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        if measure(end, pool):
            tests, mutants = tests_measured(), rows_of("mutants.tsv")
            for limit_s in TURNS_S:
                done, passed = rows_of("results.tsv"), passed_before()
                left = [mutant for number, mutant in mutants.items()
                        if done.get(number, [None, "waiting"])[1] == "waiting"]
                list(pool.map(lambda mutant: judge(mutant, tests, passed, end, limit_s), left))
    return report(equivalent)


def report(equivalent):
    mutants, rows = rows_of("mutants.tsv"), rows_of("results.tsv").values()
    counts = dict.fromkeys(("killed", "equivalent", "survived", "unreached", "waiting"), 0)
    for number, verdict, *_ in rows:
        _, path, line, kind, old, new, whole_line = mutants[number]
        if verdict != "killed" and (path, whole_line, old, new) in equivalent:
            verdict = "equivalent"
        counts[verdict] += 1
        if verdict in ("survived", "unreached"):
            print(f"{verdict} {number}: {path}:{line}: {kind}: {old}  ->  {new or '(left out)'}")
    print(f"{len(mutants)} mutants: " + ", ".join(f"{n} {verdict}" for verdict, n in counts.items()) +
          f", {len(mutants) - len(rows)} not run yet")
    return counts["survived"] + counts["unreached"] > 0  # those that wait may yet be killed


sys.exit(main())
