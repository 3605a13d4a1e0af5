# Test programs and tests. Included by the Makefile.

# Test programs are in the folders of what they test; their names are unique, and what is built has no folders.
tests := $(wildcard tests/*/test_*.c tests/*/*/test_*.c)
test_programs := $(addprefix $(build)/tests/,$(basename $(notdir $(tests))))
vpath test_%.c $(patsubst %/,%,$(sort $(dir $(tests))))
$(if $(filter-out $(words $(sort $(test_programs))),$(words $(tests))),$(error two test programs have one name))
# What several folders share; a helper of one folder is in it.
fixtures := -Itests/fixtures
benches := $(patsubst tests/bench/%.c,$(build)/tests/%,$(wildcard tests/bench/*.c))
vpath bench_%.c tests/bench
vpath recheck.c tests/tools
# Dependencies have the folder of their source: those of a source that has moved are read no more.
test_dependencies := $(patsubst %.c,$(build)/%.d,$(tests) $(wildcard tests/bench/*.c) tests/tools/recheck.c)
deps = -MMD -MP -MF$(build)/$(<:.c=.d)
fuzzers := $(patsubst tests/fuzz/%.c,$(build)/tests/fuzz_%,$(wildcard tests/fuzz/*.c))

# All test programs load one shared library of the program's objects, whose hidden symbols tests/tools/visible.c makes
# visible. Linked to archives each has a copy of the engine: gigabytes, and minutes of linking after each change. When
# only the library changes, no program is linked anew; when this file changes, all are.
tested_library := $(build)/tests/libtested.so
tested_objects := $(library_objects) $(web_objects) $(mpi_pure) $(call objects_of,$(fit))
# It runs on this machine, also where CC compiles for another.
HOSTCC ?= $(if $(findstring --sysroot,$(CC)),gcc,$(CC))
$(build)/tests/visible: tests/tools/visible.c $(build)/flags
	@mkdir -p $(@D)
	$(quiet)$(HOSTCC) -std=gnu17 -O1 -o $@ $<
$(tested_library): $(tested_objects) $(build)/tests/visible
	$(call say,link $@)
	$(quiet)$(CC) -r -nostdlib -o $(@:.so=.o) $(tested_objects) && $(build)/tests/visible $(@:.so=.o)
	$(quiet)$(CC) $(all_cflags) -shared -Wl,-soname,$(@F) -Wl,-Bsymbolic $(no_undefined) -o $@ $(@:.so=.o) $(LDFLAGS) \
	  $(program_libs)
	@rm $(@:.so=.o)

# Test programs do little work of their own: with -O3 gcc takes twice as long for them. Their functions are visible, so
# that one with the name of a system function takes its place in the library, too.
test_cflags = $(patsubst -O3,-O1,$(filter-out -fvisibility=hidden,$(all_cflags)))
test_libs = $(tested_library) -Wl,-rpath,'$$ORIGIN' $(LDFLAGS) $(all_libs)
$(build)/tests/test_%: test_%.c mk/tests.mk $(build)/flags | $(tested_library)
	$(call say,$(CC) $<)
	@mkdir -p $(@D) $(build)/$(<D)
	$(quiet)$(CC) $(test_cflags) -Werror $(pkg_cflags) $(fixtures) $(deps) -o $@ $< $(test_libs) -lcmocka

# Readers in programs, for fuzzers; their parsing of a command line does not run the command (tests/fuzz/arguments.c).
fuzzed_objects := $(filter-out %/cli/main.o,$(program_objects)) \
  $(call objects_of,$(filter-out %/main.c,$(wildcard src/import/*.c)))
fuzzed_libs = $(build)/libfuzzed.a $(build)/libweb.a $(build)/libcuvette.a $(LDFLAGS) $(program_libs) $(import_libs) \
  -lcmocka
parse_only := -Wl,--wrap=command_form_read
$(build)/libfuzzed.a: $(fuzzed_objects)
	$(archive)
$(build)/tests/fuzz_%: tests/fuzz/%.c $(build)/libfuzzed.a $(build)/libweb.a $(build)/libcuvette.a $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(all_cflags) $(pkg_cflags) $(fixtures) -fsanitize=fuzzer -MMD -MP -o $@ $< $(own_libs) $(fuzzed_libs)
$(build)/tests/fuzz_arguments: private own_libs = $(parse_only)
# The same without libFuzzer, all in one program.
replayed := $(patsubst tests/fuzz/%.c,$(build)/tests/replay/%.o,$(wildcard tests/fuzz/*.c))
$(build)/tests/replay/%.o: tests/fuzz/%.c $(build)/flags
	$(call compile,$(test_cflags) -Werror $(pkg_cflags) $(fixtures) -DFUZZ_REPLAY -DLLVMFuzzerTestOneInput=fuzz_$*)
$(build)/tests/test_fuzz_corpus: $(replayed) $(build)/libfuzzed.a $(build)/libweb.a $(build)/libcuvette.a
$(build)/tests/test_fuzz_corpus: private test_libs = $(replayed) $(parse_only) $(fuzzed_libs)

# Fault injection (tests/faults): a library to preload, the driver, and what it starts besides cuvette.
fault_tools := $(addprefix $(build)/faults/,preload.so faults engine_user lab_client)
fault_driver := $(addprefix tests/faults/,faults.c judge.c folder.c run.c trace.c)
fault_headers := $(wildcard tests/faults/*.h)
fault_flags = $(filter-out -fsanitize% -fno-sanitize% --coverage -fprofile%,$(all_cflags)) -Itests/faults
$(build)/faults/preload.so: tests/faults/preload.c
$(build)/faults/preload.so: private fault_link = -shared -fno-builtin -fvisibility=default
$(build)/faults/faults: $(fault_driver)
$(build)/faults/lab_client: tests/faults/lab_client.c
$(build)/faults/engine_user: tests/faults/engine_user.c $(build)/libcuvette.a
$(build)/faults/engine_user: private fault_link = $(build)/libcuvette.a $(LDFLAGS) $(all_libs)
$(fault_tools): $(fault_headers) $(build)/flags
	$(call say,$(CC) $@)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(fault_flags) -Werror -o $@ $(filter tests/%.c,$^) $(fault_link)

$(benches) $(build)/tests/recheck: $(build)/tests/%: %.c $(build)/libcuvette.a $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D) $(build)/$(<D)
	$(quiet)$(CC) $(all_cflags) $(pkg_cflags) $(fixtures) $(deps) -o $@ $< $(build)/libcuvette.a $(LDFLAGS) $(all_libs)

# Power cuts (tests/power): a library that records what the program does to files, and a reader of rows.
power_tools := $(build)/tests/power/reader $(build)/tests/power/record.so
$(build)/tests/power/reader: tests/power/reader.c $(build)/libcuvette.a $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(all_cflags) $(pkg_cflags) -MMD -MP -o $@ $< $(build)/libcuvette.a $(LDFLAGS) $(all_libs)
$(build)/tests/power/record.so: tests/power/record.c $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(plain_cflags) -fvisibility=default -shared -o $@ $< -ldl

# --- tests ---

programs = CUVETTE='$(abspath $(build)/cuvette)' CUVETTE_IMPORT='$(abspath $(build)/cuvette-import)'

# Checks of the sources, run in one configuration only.
source_checks := $(wildcard tests/source/*.sh)
script_folders := bench cli engine experiments lint manual study tools
every_script := $(source_checks) tests/faults/faults.sh tests/power/power_cuts.sh \
  $(filter-out tests/study/slurm.sh,$(wildcard $(script_folders:%=tests/%/*.sh)))
scripts := $(filter-out $(if $(filter-out release,$(config)$(clang)$(RUNNER)),$(source_checks)),$(every_script))
# make test only=NAME runs what has that name in any folder of tests: test_NAME.c, test_NAME.sh and NAME.sh.
named = $(filter $(build)/tests/test_$(1),$(test_programs)) $(filter %/test_$(1).sh %/$(1).sh,$(every_script))
test_names = $(sort $(patsubst test_%,%,$(basename $(notdir $(tests) $(every_script)))))
similar = $(shell name='$(1)'; printf '%s\n' $(test_names) | grep -F -e "$${name:0:3}")
unknown = $(error only=$(1): tests has no test_$(1).c, test_$(1).sh or $(1).sh; \
  $(or $(if $(similar),did you mean: $(similar)),ls tests/* shows the names))
selected := $(if $(only),$(foreach name,$(only),$(or \
  $(strip $(call named,$(name))),$(if $(call requested,test),$(call unknown,$(name))))),$(test_programs) $(scripts))
selected_programs = $(filter-out %.sh,$(selected))
selected_scripts = $(filter %.sh,$(selected))

# The part of two long tests that `make test` runs; `make check` runs the others. Random scenes of test_laws.c, fewer
# with instrumentation, and the slice of test_acts.c.
test_scenes := $(or $(LAWS_SCENES),$(if \
  $(RUNNER)$(filter coverage,$(config)),20,$(if $(filter release,$(config)),150,100)))
ACTS_SLICE ?= 34/96

.PHONY: test
# Programs that test scripts run.
tested = $(build)/cuvette $(build)/man/made $(build)/$(soname) $(build)/engine/libcuvette.a $(build)/tests/bench_mesh \
  $(build)/tests/recheck peers $(power_tools) $(if $(filter release,$(config)),$(fault_tools))
## test: every test; only=NAME: test_NAME.c, NAME.sh
test: $(selected_programs) $(build)/cuvette-import $(if $(selected_scripts),$(tested))
	@LAWS_SCENES='$(test_scenes)' ACTS_SLICE='$(ACTS_SLICE)' CC='$(CC)' BUILD='$(build)' CONFIG='$(config)' \
	  $(programs) $(kernel_environment) \
	  tests/run $(selected_scripts) $(selected_programs)

# The page in a real browser: only=NAME for tests/web/NAME.test.mjs alone, screenshots=FOLDER for images of every view,
# ENGINE=browser for the laboratory of `make wasm` in the page instead of the program. Installs Chromium and node if
# they are missing. Runs after everything that installs or measures.
.PHONY: test-web
## test-web: the page in Chromium; only=NAME, ENGINE=browser
test-web: $(build)/cuvette $(if $(filter browser,$(ENGINE)),wasm) | setup-web \
  $(call requested,test test-mpi experiments bench)
	@tests/source/format.sh --check $(build)/web-tests
	@node tests/web/run.mjs --program '$(abspath $(build)/cuvette)' --modules '$(abspath $(build)/web-tests)' \
	  $(if $(ENGINE),--engine '$(ENGINE)' --wasm '$(abspath $(wasm))') \
	  $(if $(screenshots),--screenshots '$(abspath $(screenshots))') $(only)

# cuvette-mpi with ranks on this machine.
.PHONY: test-mpi test-simgrid test-slurm
## test-mpi: cuvette-mpi with ranks on this machine
test-mpi: mpi $(build)/cuvette $(build)/cluster/messages | $(call requested,test experiments bench)
	@CUVETTE='$(abspath $(build)/cuvette)' tests/run tests/mpi/mpi.sh
## test-simgrid: the simulation of a cluster, with 4 and 64 ranks
test-simgrid: simulated | $(call requested,test experiments bench)
	@SIMULATED='$(abspath $(build)/cluster/simulated)' tests/run tests/mpi/simgrid.sh
# Killed tasks, a lost node, a limit of time, on a cluster of four nodes on this machine.
## test-slurm: a study on a real Slurm, five minutes
test-slurm: $(build)/cuvette
	@CUVETTE='$(abspath $(build)/cuvette)' tests/study/slurm.sh
