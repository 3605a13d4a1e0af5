"""Run the mutants of a built copy (instrument.py): run.py TREE EQUIVALENT SECONDS.

First every test program of less than three minutes runs once without a mutant, which says how long it takes and which
mutants it reaches. Then each mutant runs in the tests that reach it, quickest first, until one fails: it is killed. A
test that takes six times as long as before has failed too. After QUICK_S of tests a mutant waits until all others had
their turn: most survivors would run for minutes. TREE/results.tsv has rows of number, killed or waiting or survived or
unreached, and the test that killed it; the last row of a number counts. Rows that it has are kept, so that the same
command goes on where it stopped, after SECONDS at the latest. EQUIVALENT lists mutants that change nothing that can be
seen: file, the whole line, text, changed text, why."""

import concurrent.futures
import glob
import os
import resource
import subprocess
import sys
import time

LONGEST_S = 180  # longer tests are left out
QUICK_S = 30
EXCLUDED = ("test_lab", "test_http", "test_bad_meshes", "test_study_estimate")  # need a server or quiet processors


def environment(**more):
    here = os.getcwd()
    return {**os.environ, "LAWS_SCENES": "500", "CUVETTE": f"{here}/build/cuvette",
            "CUVETTE_IMPORT": f"{here}/build/cuvette-import", **more}


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def passes(test, limit_s, **more):
    begun = time.monotonic()
    process = subprocess.Popen([f"build/tests/{test}"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL, env=environment(**more), preexec_fn=limits,
                               start_new_session=True)
    try:
        code = process.wait(limit_s)
    except subprocess.TimeoutExpired:
        code = 1
    try:
        os.killpg(process.pid, 9)
    except ProcessLookupError:
        pass
    process.wait()
    return code == 0, time.monotonic() - begun


def measure():
    """Rows of test, seconds, reached mutants; kept in reached.tsv."""
    if not os.path.exists("reached.tsv"):
        rows = []
        for path in sorted(glob.glob("build/tests/test_*")):
            test = os.path.basename(path)
            if "." in test or test.startswith(EXCLUDED):
                continue
            if os.path.exists("reached.txt"):
                os.unlink("reached.txt")
            passed, seconds = passes(test, LONGEST_S, MUTANT_REACHED=os.path.abspath("reached.txt"))
            reached = set()
            if os.path.exists("reached.txt"):
                with open("reached.txt") as file:
                    reached = {line.strip() for line in file}
            left_out = "" if passed else ", left out: it fails without a mutant, or takes too long"
            print(f"{test}: {seconds:.1f} s, reaches {len(reached)}{left_out}", flush=True)
            if passed:
                rows.append(f"{test}\t{seconds:.3f}\t{','.join(sorted(reached, key=int))}\n")
        with open("reached.tsv", "w") as file:
            file.writelines(rows)
    with open("reached.tsv") as file:
        rows = [line.rstrip("\n").split("\t") for line in file]
    return sorted((float(seconds), test, set(map(int, filter(None, reached.split(",")))))
                  for test, seconds, reached in rows)


def judge(number, tests, end, quick):
    """The row of a mutant after the tests of its first QUICK_S, or after the others; None: no time is left."""
    reached, before_s, more = False, 0.0, False
    for seconds, test, reaches in tests:
        if number not in reaches:
            continue
        reached = True
        is_quick = before_s < QUICK_S
        before_s += seconds
        more |= not is_quick
        if is_quick != quick:
            continue
        if time.monotonic() > end:
            return None
        if not passes(test, 6 * seconds + 10, MUTANT=str(number))[0]:
            return f"{number}\tkilled\t{test}\n"
    verdict = "unreached" if not reached else "waiting" if quick and more else "survived"
    return f"{number}\t{verdict}\t\n"


def results():
    """The last row of each mutant: number, verdict, test."""
    if not os.path.exists("results.tsv"):
        return []
    with open("results.tsv") as file:
        return list({line.split("\t")[0]: line.rstrip("\n").split("\t") for line in file}.values())


def judge_all(numbers, tests, end, quick):
    with open("results.tsv", "a") as file, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for row in pool.map(lambda number: judge(number, tests, end, quick), numbers):
            if row:
                file.write(row)
                file.flush()


def main():
    with open(sys.argv[2]) as file:
        equivalent = {tuple(line.split("\t")[:4]) for line in file}
    os.chdir(sys.argv[1])
    end = time.monotonic() + float(sys.argv[3])
    tests = measure()
    done = {int(row[0]) for row in results()}
    with open("mutants.tsv") as file:
        judge_all([n for n in (int(line.split("\t")[0]) for line in file) if n not in done], tests, end, True)
    judge_all([int(row[0]) for row in results() if row[1] == "waiting"], tests, end, False)
    return report(equivalent)


def report(equivalent):
    with open("mutants.tsv") as file:
        mutants = {line.split("\t")[0]: line.rstrip("\n").split("\t") for line in file}
    rows = results()
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
