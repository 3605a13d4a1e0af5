"""Run the mutants of a built copy (instrument.py): run.py TREE EQUIVALENT SECONDS.

First every test program of less than three minutes runs once without a mutant, which says how long it takes and which
mutants it reaches (TREE/reached.tsv). Then each mutant runs in the tests that reach it, quickest first, until one
fails: it is killed. A test that takes six times as long as before has failed too. After QUICK_S of tests a mutant waits
until all others had their turn: most survivors would run for minutes. TREE/results.tsv has rows of number, killed or
waiting or survived or unreached, and the test that killed it or that it passed last; the last row of a number counts.
Rows that the files have are kept, so that the same command goes on where it stopped: after SECONDS. EQUIVALENT lists
mutants that change nothing that can be seen: file, the whole line, text, changed text, why."""

import concurrent.futures
import glob
import os
import resource
import subprocess
import sys
import threading
import time

LONGEST_S = 180  # longer tests are left out
QUICK_S = 30
EXCLUDED = ("test_lab", "test_http", "test_bad_meshes", "test_study_estimate")  # need a server or quiet processors
writing = threading.Lock()


def environment(**more):
    here = os.getcwd()
    return {**os.environ, "LAWS_SCENES": "500", "CUVETTE": f"{here}/build/cuvette",
            "CUVETTE_IMPORT": f"{here}/build/cuvette-import", **more}


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def passes(test, limit_s, end, **more):
    """Whether the test passes within the limit, and the seconds; None: the end of all came first."""
    begun = time.monotonic()
    if begun > end:
        return None, 0.0
    process = subprocess.Popen([f"build/tests/{test}"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL, env=environment(**more), preexec_fn=limits,
                               start_new_session=True)
    try:
        passed = process.wait(min(limit_s, end - begun)) == 0
    except subprocess.TimeoutExpired:
        passed = None if end - begun < limit_s else False
    try:
        os.killpg(process.pid, 9)
    except ProcessLookupError:
        pass
    process.wait()
    return passed, time.monotonic() - begun


def append(path, *fields):
    with writing, open(path, "a") as file:
        file.write("\t".join(map(str, fields)) + "\n")


def rows_of(path):
    """The last row of each first field."""
    if not os.path.exists(path):
        return {}
    with open(path) as file:
        return {line.split("\t")[0]: line.rstrip("\n").split("\t") for line in file}


def measure(end):
    """Adds rows of test, seconds ("-": left out), reached mutants; returns whether all tests have one."""
    known = rows_of("reached.tsv")
    for path in sorted(glob.glob("build/tests/test_*")):
        test = os.path.basename(path)
        if "." in test or test.startswith(EXCLUDED) or test in known:
            continue
        if os.path.exists("reached.txt"):
            os.unlink("reached.txt")
        passed, seconds = passes(test, LONGEST_S, end, MUTANT_REACHED=os.path.abspath("reached.txt"))
        if passed is None:
            return False
        reached = []
        if os.path.exists("reached.txt"):
            with open("reached.txt") as file:
                reached = sorted({int(line) for line in file})
        left_out = "" if passed else ", left out: it fails without a mutant, or takes too long"
        print(f"{test}: {seconds:.1f} s, reaches {len(reached)}{left_out}", flush=True)
        append("reached.tsv", test, f"{seconds:.3f}" if passed else "-", ",".join(map(str, reached)))
    return True


def tests_by_time():
    return sorted((float(seconds), test, set(map(int, filter(None, reached.split(",")))))
                  for test, seconds, reached in rows_of("reached.tsv").values() if seconds != "-")


def judge(number, tests, end, quick, passed_last=""):
    """Adds rows of a mutant: after the tests of its first QUICK_S, or after the others, from the one after passed_last
    on."""
    own, before_s = [], 0.0
    for seconds, test, reaches in tests:
        if number in reaches:
            own.append((seconds, test, before_s < QUICK_S))
            before_s += seconds
    names = [test for _, test, _ in own]
    done = names.index(passed_last) + 1 if passed_last in names else 0
    for seconds, test, is_quick in own[done:]:
        if is_quick != quick:
            continue
        passed, _ = passes(test, 6 * seconds + 10, end, MUTANT=str(number))
        if passed is None:
            return
        if not passed:
            append("results.tsv", number, "killed", test)
            return
        if not quick:
            append("results.tsv", number, "waiting", test)
    more = any(not is_quick for _, _, is_quick in own)
    append("results.tsv", number, "unreached" if not own else "waiting" if quick and more else "survived", "")


def main():
    with open(sys.argv[2]) as file:
        equivalent = {tuple(line.split("\t")[:4]) for line in file}
    os.chdir(sys.argv[1])
    end = time.monotonic() + float(sys.argv[3])
    if measure(end):
        tests, done = tests_by_time(), rows_of("results.tsv")
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            left = [int(number) for number in rows_of("mutants.tsv") if number not in done]
            list(pool.map(lambda number: judge(number, tests, end, True), left))
            waiting = [row for row in rows_of("results.tsv").values() if row[1] == "waiting"]
            list(pool.map(lambda row: judge(int(row[0]), tests, end, False, row[2]), waiting))
    return report(equivalent)


def report(equivalent):
    mutants, rows = rows_of("mutants.tsv"), rows_of("results.tsv").values()
    counts = dict.fromkeys(("killed", "equivalent", "survived", "unreached", "waiting"), 0)
    for number, verdict, _ in rows:
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
