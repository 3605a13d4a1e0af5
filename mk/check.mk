# The long checks: instruments, faults, coverage, fuzzers, mutants. Included by the Makefile.

# AddressSanitizer and UndefinedBehaviorSanitizer; ThreadSanitizer; the test programs under valgrind; another compiler.
.PHONY: sanitize tsan valgrind clang
## sanitize, tsan: test with the sanitizers; only=NAME
under_valgrind := valgrind -q --error-exitcode=9 --leak-check=full --max-threads=1100 \
  --suppressions=tests/tools/valgrind.supp
## valgrind, clang: test programs under valgrind; all tests with clang
sanitize:
	@$(MAKE) STRICT=1 config=sanitize build=$(build)/sanitize TEST_LIMIT_S=3600 test
tsan:
	@$(MAKE) STRICT=1 config=tsan build=$(build)/tsan TEST_LIMIT_S=3600 test
valgrind:
	@$(MAKE) RUNNER='$(under_valgrind)' TEST_LIMIT_S=3600 selected_scripts= test
clang:
	@$(MAKE) STRICT=1 CC=clang build=$(build)/clang test

.PHONY: instructions
## instructions: of six frames: none may need over 1 % more
instructions: $(build)/cuvette
	@CC='$(CC)' CUVETTE='$(abspath $(build)/cuvette)' tests/instructions/instructions.sh

.PHONY: power-cuts
## power-cuts: all states that a power cut can leave (10 min)
power-cuts: $(build)/cuvette $(power_tools)
	@BUILD='$(build)' CONFIG='$(config)' CUVETTE='$(abspath $(build)/cuvette)' POWER_STATES=$${POWER_STATES:-1000000} \
	  POWER_STATES_PER_CUT=$${POWER_STATES_PER_CUT:-20000} POWER_RESUMED=$${POWER_RESUMED:-30} \
	  bash tests/power/power_cuts.sh

# Random scenes in runs of 10 000, one run per processing unit at a time; LAWS_SCENES in total for each law, starting
# with LAWS_SEED. law-faults inserts known faults into the sources, one at a time: the laws must detect each.
.PHONY: laws law-faults
laws: LAWS_SCENES ?= 1000000
laws: LAWS_SEED ?= 1
## laws, law-faults: a million random scenes; known faults, found
laws: $(build)/tests/test_laws
	@seq $(LAWS_SEED) $$(($(LAWS_SEED) + ($(LAWS_SCENES) + 9999) / 10000 - 1)) | \
	  LAWS_SCENES=10000 xargs -P "$$(nproc)" -I SEED tests/faults/run_seed.sh $(build)/tests/test_laws SEED
law-faults:
	@tests/faults/laws.sh

# Memory and system calls that fail, in every command, the library and the laboratory (an hour): all sites, or those of
# only=NAME of tests/faults/commands.txt; kinds=memory,write-enospc. `make test` tries a part of them. fault-checks
# removes checks from the sources, one at a time: the faults must detect each.
.PHONY: faults fault-checks
## faults, fault-checks: fail all allocations and calls; and without some checks
faults: $(build)/cuvette $(build)/cuvette-import $(fault_tools)
	@BUILD='$(build)' CUVETTE='$(abspath $(build)/cuvette)' FAULTS_EVERY=1 FAULTS_DEPTH=0 FAULTS_ONLY='$(only)' \
	  FAULTS_KINDS='$(kinds)' bash tests/faults/faults.sh
fault-checks: $(build)/cuvette $(build)/cuvette-import $(fault_tools)
	@BUILD='$(abspath $(build))' tests/faults/checks.sh

# Lines of src that the tests run, among them the fuzzers' inputs (test_fuzz_corpus); made by gcc. coverage drops the
# counts of earlier runs, coverage-add keeps them. The report is written after tests that fail, too.
GCOV ?= $(subst gcc,gcov,$(lastword $(CC)))
of_coverage = $(if $(clang),$(error coverage: only gcc is supported; leave CC=$(CC) out))--no-print-directory STRICT=1 \
  config=coverage build=$(build)/coverage TEST_LIMIT_S=3600
.PHONY: coverage coverage-add coverage-report run_coverage report_coverage
## coverage[-add|-report]: lines of src that tests run: build/coverage/report
coverage:
	@$(MAKE) $(of_coverage) run_coverage
# Runs tests for coverage-report; only=NAME.
coverage-add:
	@$(MAKE) $(of_coverage) test
# What all tests have run since the last `make coverage`, or since the file changed.
coverage-report:
	@$(MAKE) $(of_coverage) report_coverage
run_coverage:
	@mkdir -p $(build) && find $(build) -name '*.gcda' -delete
	@code=0; $(MAKE) --no-print-directory build=$(build) test || code=$$?; \
	  $(MAKE) --no-print-directory build=$(build) report_coverage && exit $$code
report_coverage:
	@command -v gcovr >/dev/null || \
	  { echo 'coverage: gcovr is not installed; install it with: apt-get install gcovr' >&2; exit 1; }
	@mkdir -p $(build)/report
	@gcovr --gcov-executable '$(GCOV)' --root . --filter src/ --exclude-throw-branches \
	  --html-details $(build)/report/index.html --txt $(build)/report/missed.txt --print-summary $(build)
	@echo 'report: $(build)/report/index.html; the lines that neither tests nor the inputs of fuzzers reach:' \
	  '$(build)/report/missed.txt'

# Small errors in the sources, one at a time, that a test must detect; everything that checks, in slices.
.PHONY: mutants check
## mutants: unit tests must detect 600 small errors (hours)
mutants: $(build)/cuvette
	@BUILD='$(build)' tests/mutants/mutants.sh
## check: all that checks, in slices that go on (hours)
check: $(build)/cuvette
	@BUILD='$(build)' CC='$(CC)' tests/check/check.sh $(only)

.PHONY: interrupts
MOMENTS ?= 1000
## interrupts: Ctrl-C at MOMENTS=1000 moments of all commands
interrupts: $(build)/cuvette $(build)/cuvette-import
	@rm -f $(build)/interrupts.txt; $(programs) CC='$(CC)' \
	  LATENCY='$(abspath $(build)/interrupts.txt)' MOMENTS=$$((($(MOMENTS) + 31) / 32)) bash tests/cli/interrupt.sh all

# The fuzzers that have waited longest: FUZZ_TOTAL seconds in all, FUZZ_SECONDS each; only=NAME for tests/fuzz/NAME.c
# alone. fuzz-merge renews tests/fuzz/corpus from what they kept.
.PHONY: fuzz fuzz-merge run_fuzzers merge_corpus
selected_fuzzers = $(if $(only),$(only:%=$(build)/tests/fuzz_%),$(fuzzers))
## fuzz, fuzz-merge: feed the readers (libFuzzer); renew the corpus
fuzz:
	@$(MAKE) config=fuzz CC=clang build=$(build)/fuzz run_fuzzers
run_fuzzers: $(selected_fuzzers)
	@FUZZ_SECONDS='$(FUZZ_SECONDS)' FUZZ_TOTAL='$(FUZZ_TOTAL)' tests/fuzz/run.sh $(build) $(only)
fuzz-merge:
	@$(MAKE) config=fuzz CC=clang build=$(build)/fuzz merge_corpus
merge_corpus: $(selected_fuzzers)
	@tests/fuzz/run.sh --merge $(build) $(only)
