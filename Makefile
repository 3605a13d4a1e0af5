# Cuvette. `make help` lists the targets.
#   make config=debug|release|sanitize|tsan|coverage|nocounters [CC=clang] [target]    each with its own build folder
MAKEFLAGS += --no-builtin-rules
SHELL := /bin/bash
config ?= release
CC ?= gcc
ifeq ($(origin CC),default)
CC := gcc
endif
PREFIX ?= /usr/local
FUZZ_SECONDS ?= 60
# QUICK=1: the same path in seconds, with frames of at most 80 x 60 pixels, each measured once, in a folder of its own.
QUICK ?=
RESULTS ?= results$(if $(QUICK),/quick)

# Short lines while it builds; `make V=1` shows the commands.
quiet := $(if $(V),,@)
say = @$(if $(V),true,echo '  $(1)')

# As many jobs as processors, unless the caller says how many.
ifeq ($(MAKELEVEL)$(findstring -j,$(MAKEFLAGS)),0)
MAKEFLAGS += -j$(shell nproc)
endif

# build, build/clang, build/sanitize, build/sanitize-clang, ...
clang := $(findstring clang,$(notdir $(firstword $(CC))))
ifeq ($(config),release)
build := build$(clang:%=/%)
else
build := build/$(config)$(clang:%=-%)
endif

PACKAGES := libpng zlib libjpeg hwloc yaml-0.1 jansson
warnings := -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla
# Constants that are enumerators are exact as doubles; newer versions of clang warn about them.
warnings += $(if $(clang),-Wno-enum-float-conversion)
# A user's newer compiler may give more warnings: they are errors only in CI (STRICT=1) and in test programs.
STRICT ?=
# An undeclared function is always an error: its pointer arguments would be truncated.
errors := -Werror=implicit-function-declaration $(if $(STRICT),-Werror)
# In instrumented code gcc does not know the ranges of values, and its estimate of printf's output is wrong.
ifneq ($(filter sanitize tsan,$(config)),)
warnings += $(if $(clang),,-Wno-format-truncation)
endif
# Bits must not depend on the compiler: no contraction to FMA, and only relaxations that do not change results.
arithmetic := -ffp-contract=off -fno-math-errno -fno-trapping-math
optimize_release    := -O3
optimize_nocounters := -O3 -DCUVETTE_COUNTERS=0
optimize_debug      := -O0
optimize_sanitize   := -O1 -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
optimize_tsan       := -O1 -fsanitize=thread
# Threads share the counters of lines.
optimize_coverage   := -O1 --coverage -fprofile-update=atomic
optimize_fuzz       := -O1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
optimize := $(optimize_$(config))
$(if $(optimize),,$(error config=$(config) is not one of debug, release, sanitize, tsan, fuzz, coverage, nocounters))

# The library's version is in its header.
version := $(shell awk '/^.define CUVETTE_VERSION_/ {printf "%s%s", dot, $$3; dot = "."}' src/cuvette.h)
soname := libcuvette.so.$(firstword $(subst ., ,$(version)))
# pkg-config runs at its first use, not when this file is read: `make setup all` installs the libraries first.
pkg_cflags = $(eval pkg_cflags := $$(shell pkg-config --cflags $(PACKAGES)))$(pkg_cflags)
pkg_libs = $(eval pkg_libs := $$(shell pkg-config --libs $(PACKAGES)))$(pkg_libs)
import_libs = $(eval import_libs := $$(shell pkg-config --libs assimp jansson) -lm)$(import_libs)
# Valgrind of Debian 12 cannot read the DWARF 5 that clang writes.
CFLAGS ?= -g$(if $(clang),dwarf-4)
# One set of objects for the program and both libraries: on the supported machines, position-independent code with hidden symbols
# is as fast. A shared library exports only what cuvette.h marks.
linkage := -fPIC -fvisibility=hidden
# Flags that may change a result; the others are for warnings and paths.
code_flags = -std=gnu17 -D_GNU_SOURCE $(linkage) $(arithmetic) $(optimize) $(CFLAGS) -Isrc -pthread
all_cflags = $(code_flags) -DCUVETTE_VERSION='"$(version)"' \
  -DCUVETTE_COMPILER_FLAGS='"$(config): $(optimize) $(arithmetic)"' $(warnings) $(errors)
all_libs = $(pkg_libs) -lm -pthread

# Embree 3, which one of the peers links if it is installed. Detected at its first use, as above.
embree = $(eval embree := $$(shell $$(CC) -E -include embree3/rtcore.h -x c /dev/null >/dev/null 2>&1 && echo yes))$(embree)

# One source for all instruction sets of the architecture (src/base/isa.h): *_kernel.c is compiled once for each.
isa_flags_sse2   := -msse2 -Wno-psabi
isa_flags_avx2   := -mavx2 -Wno-psabi
isa_flags_avx512 := -mavx512f -mavx512dq -mavx512bw -mavx512vl -mprefer-vector-width=512
isas = $(eval isas := $$(call isas_of,$$(shell $$(CC) -dumpmachine)))$(isas)
isas_of = $(if $(filter x86_64-% amd64-%,$(1)),sse2 avx2 avx512,$(if $(filter aarch64-% arm64-%,$(1)),neon,plain))
isas_flags = $(foreach i,$(isas),$(isa_flags_$(i)))

sources := $(wildcard src/*.c src/*/*.c src/*/*/*.c src/*/*/*/*.c)
kernels := $(filter %_kernel.c,$(sources))
library := $(filter-out src/cli/% src/import/% src/web/% src/mpi/% src/wasm/% src/manual/% $(kernels),$(sources))
program := $(wildcard src/cli/*.c)
mpi := $(filter src/mpi/%,$(sources))
web := $(filter src/web/%,$(sources))
page := $(sort $(wildcard $(addprefix src/web/page/*.,html css js svg)))
importer := $(wildcard src/import/*.c) $(addprefix src/base/,status.c cancel.c number.c below.c float_environment.c grow.c large_pages.c os_confine_calls.c os_confine_files.c os_process.c)
kernel_objects := $(foreach i,$(isas),$(kernels:src/%.c=$(build)/obj/%.$(i).o))
library_objects := $(library:src/%.c=$(build)/obj/%.o) $(kernel_objects)
program_objects := $(program:src/%.c=$(build)/obj/%.o)
mpi_objects := $(mpi:src/%.c=$(build)/obj/%.o)
web_objects := $(web:src/%.c=$(build)/obj/%.o) $(build)/web/page_files.o
importer_objects := $(importer:src/%.c=$(build)/plain/%.o)
tests := $(wildcard tests/test_*.c)
test_programs := $(tests:tests/%.c=$(build)/tests/%)
web_tests := $(filter $(addprefix $(build)/tests/test_,http% lab% quantities),$(test_programs))
benches := $(patsubst tests/%.c,$(build)/tests/%,$(wildcard tests/bench_*.c))
fuzzers := $(patsubst tests/fuzz/%.c,$(build)/tests/fuzz_%,$(wildcard tests/fuzz/*.c))

.PHONY: all
all: $(build)/cuvette $(build)/cuvette-import $(build)/$(soname) $(build)/man/made ## build build/cuvette, the library and the manual (the default)

# A half-written file would look newer than its sources.
.DELETE_ON_ERROR:

$(build)/cuvette: $(program_objects) $(build)/libweb.a $(build)/libcuvette.a
	$(call say,link $@)
	$(quiet)$(CC) $(all_cflags) -o $@ $^ $(LDFLAGS) $(all_libs)

# The laboratory's server and its page: only for the program, not for the library.
$(build)/libweb.a: $(web_objects)
	@rm -f $@
	$(quiet)ar rcs $@ $^
$(build)/web/page_files.c: src/web/embed.sh src/web/page $(page)
	@mkdir -p $(@D)
	$(quiet)src/web/embed.sh $(page) >$@
$(build)/web/page_files.o: $(build)/web/page_files.c $(build)/flags
	$(call say,$(CC) $<)
	$(quiet)$(CC) $(all_cflags) $(pkg_cflags) -MMD -MP -c -o $@ $<

# The same program on the ranks of an MPI job (src/mpi); nothing else needs MPI. MPI_PACKAGE: its name for pkg-config.
MPI_PACKAGE ?= ompi-c
mpi_cflags = $(eval mpi_cflags := $$(shell pkg-config --cflags $(MPI_PACKAGE) 2>/dev/null))$(mpi_cflags)
mpi_libs = $(eval mpi_libs := $$(shell pkg-config --libs $(MPI_PACKAGE) 2>/dev/null))$(mpi_libs)
.PHONY: mpi setup-mpi test-mpi
test-mpi: mpi $(build)/cuvette $(build)/cluster/messages | $(filter test experiments bench,$(MAKECMDGOALS)) ## test cuvette-mpi with ranks on this machine
	@CUVETTE='$(abspath $(build)/cuvette)' tests/run tests/mpi.sh
mpi: $(build)/cuvette-mpi $(build)/cuvette-import ## build build/cuvette-mpi, for the ranks of an MPI job
setup-mpi: | $(filter setup setup-python,$(MAKECMDGOALS)) ## install what make mpi requires: OpenMPI
	@.ci/setup-mpi
$(build)/cuvette-mpi: $(mpi_objects) $(filter-out %/cli/main.o,$(program_objects)) $(build)/libweb.a $(build)/libcuvette.a
	$(call say,link $@)
	$(quiet)$(CC) $(all_cflags) -o $@ $^ $(LDFLAGS) $(mpi_libs) $(all_libs)
$(build)/obj/mpi/%.o: private own_cflags = $(mpi_cflags)
mpi_pure := $(patsubst %,$(build)/obj/mpi/%.o,handout tracing)
$(mpi_pure): private own_cflags =
$(filter-out $(mpi_pure),$(mpi_objects)): | mpi-tools
.PHONY: mpi-tools
mpi-tools: | $(filter setup-mpi,$(MAKECMDGOALS))
	@pkg-config --exists $(MPI_PACKAGE) || { echo 'mpi: OpenMPI ($(MPI_PACKAGE)) is not installed; run: make setup-mpi' >&2; exit 1; }

# The mesh importer, the only program linked to assimp. Built without sanitizers, which need more address space than the limit that it
# sets itself.
plain_cflags = $(filter-out -fsanitize% -fno-sanitize%,$(all_cflags))
$(build)/cuvette-import: $(importer_objects)
	$(call say,link $@)
	$(quiet)$(CC) $(plain_cflags) -o $@ $^ $(filter-out -fsanitize%,$(LDFLAGS)) $(import_libs)
$(build)/plain/%.o: src/%.c $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(plain_cflags) -MMD -MP -c -o $@ $<

# The last place where the importer is looked for; not part of the flags, which a PREFIX only for `make install` must not change.
$(build)/obj/scene/assets/mesh_program.o: private all_cflags += -DCUVETTE_LIBEXEC='"$(PREFIX)/libexec/cuvette"'

$(build)/libcuvette.a: $(library_objects)
	@rm -f $@
	$(quiet)ar rcs $@ $^

# For other programs: as above without internal symbols, which could clash with the program's own (a static library does not hide any itself).
$(build)/engine/libcuvette.a: $(library_objects)
	$(call say,link $@)
	@mkdir -p $(@D) && rm -f $@
	$(quiet)$(CC) -r -nostdlib -o $(@D)/cuvette.o $^ && objcopy --localize-hidden $(@D)/cuvette.o && ar rcs $@ $(@D)/cuvette.o
	@rm $(@D)/cuvette.o

# Instrumented code leaves the symbols of the instrumentation to the program.
$(build)/$(soname): $(library_objects)
	$(call say,link $@)
	$(quiet)$(CC) $(all_cflags) -shared -Wl,-soname,$(soname) $(if $(filter sanitize tsan fuzz,$(config)),,-Wl,-z,defs) -o $@ $^ $(LDFLAGS) $(all_libs)

# The identity of the build (src/base/build_id.h): code of these folders can change a film or a time.
measured_code := $(sort $(foreach room,base optics geometry measure image softbody scene render realism job,$(wildcard \
  $(addprefix src/$(room)/,*.[ch] */*.[ch] */*/*.[ch]))))
$(build)/build_id: always $(build)/flags
	@{ $(CC) --version | head -n 1; echo '$(subst ','\'',$(code_flags) $(isas_flags))'; cat $(measured_code); } | \
	  sha256sum | cut -c 1-16 >$@.new
	@{ git rev-parse --short HEAD && git diff --quiet HEAD -- src Makefile || echo +; } 2>/dev/null | tr -d '\n' >>$@.new
	@cmp -s $@.new $@ && rm $@.new || mv $@.new $@
$(build)/obj/base/build_id.o: $(build)/build_id
$(build)/obj/base/build_id.o: private all_cflags += -DCUVETTE_BUILD_ID='"$(shell sed -n 1p $(build)/build_id 2>/dev/null)"' \
  -DCUVETTE_BUILD_COMMIT='"$(shell sed 1d $(build)/build_id 2>/dev/null)"'

$(build)/obj/%.o: src/%.c $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(all_cflags) $(pkg_cflags) $(own_cflags) -MMD -MP -c -o $@ $<
$(build)/obj/study/plot_style.o: plots/style.gp
$(build)/obj/study/slurm_script.o: experiments/cluster/study.slurm
web_cflags = $(eval web_cflags := $$(shell pkg-config --cflags libmicrohttpd))$(web_cflags)
$(build)/obj/web/%.o: private own_cflags = $(web_cflags)

define kernel_rule
$(build)/obj/%_kernel.$(1).o: src/%_kernel.c $(build)/flags
	$$(call say,$$(CC) $$< for $(1))
	@mkdir -p $$(@D)
	$$(quiet)$$(CC) $$(all_cflags) $$(isa_flags_$(1)) -DKERNEL_ISA=$(1) -MMD -MP -c -o $$@ $$<
endef
$(foreach i,$(isas),$(eval $(call kernel_rule,$(i))))

# Test programs do little work of their own: with -O3 gcc takes twice as long for them.
test_cflags = $(all_cflags:-O3=-O1)
$(build)/tests/test_%: tests/test_%.c $(build)/libcuvette.a $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(test_cflags) -Werror $(pkg_cflags) -Itests -MMD -MP -o $@ $< $(test_web) $(build)/libcuvette.a $(LDFLAGS) $(all_libs) -lcmocka
$(build)/tests/test_handout $(build)/tests/test_tracing: $(build)/tests/test_%: $(build)/obj/mpi/%.o
$(build)/tests/test_handout $(build)/tests/test_tracing: private test_web = $(build)/obj/mpi/$(@F:test_%=%).o
$(web_tests): $(build)/libweb.a
$(web_tests): private test_web = $(build)/libweb.a

# Readers in programs, for fuzzers; their parsing of a command line does not run the command (tests/fuzz/arguments.c).
fuzzed_objects := $(filter-out %/cli/main.o,$(program_objects)) $(patsubst src/%.c,$(build)/obj/%.o,$(filter-out %/main.c,$(wildcard src/import/*.c)))
fuzzed_libs = $(build)/libfuzzed.a $(build)/libweb.a $(build)/libcuvette.a $(LDFLAGS) $(all_libs) $(import_libs) -lcmocka
parse_only := -Wl,--wrap=command_form_read
$(build)/libfuzzed.a: $(fuzzed_objects)
	@rm -f $@
	$(quiet)ar rcs $@ $^
$(build)/tests/fuzz_%: tests/fuzz/%.c $(build)/libfuzzed.a $(build)/libweb.a $(build)/libcuvette.a $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(all_cflags) $(pkg_cflags) -Itests -fsanitize=fuzzer -MMD -MP -o $@ $< $(own_libs) $(fuzzed_libs)
$(build)/tests/fuzz_arguments: private own_libs = $(parse_only)
# The same without libFuzzer, all in one program.
replayed := $(patsubst tests/fuzz/%.c,$(build)/tests/replay/%.o,$(wildcard tests/fuzz/*.c))
$(build)/tests/replay/%.o: tests/fuzz/%.c $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(test_cflags) -Werror $(pkg_cflags) -Itests -DFUZZ_REPLAY -DLLVMFuzzerTestOneInput=fuzz_$* -MMD -MP -c -o $@ $<
$(build)/tests/test_fuzz_corpus: $(replayed) $(build)/libfuzzed.a $(build)/libweb.a
$(build)/tests/test_fuzz_corpus: private test_web = $(replayed) $(parse_only) $(fuzzed_libs)

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

$(benches) $(build)/tests/recheck: $(build)/tests/%: tests/%.c $(build)/libcuvette.a $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(all_cflags) $(pkg_cflags) -Itests -MMD -MP -o $@ $< $(build)/libcuvette.a $(LDFLAGS) $(all_libs)

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

# Rebuilds everything when the compiler or its flags change. Everything that is compiled depends on it, so that it
# also waits for setup when both are requested.
.PHONY: always
flags_text = $(subst ','\'',$(filter-out -Werror,$(CC) $(all_cflags) $(isas_flags)))
$(build)/flags: always | $(filter setup setup-peers setup-doc setup-mpi,$(MAKECMDGOALS))
	@mkdir -p $(@D)
	@echo '$(flags_text)' | cmp -s - $@ || echo '$(flags_text)' >$@

# cuvette-mpi's loops on simulated clusters (experiments/cluster/simulated): src/mpi/messenger.c and handout.c as they are, by
# SimGrid's compiler; and by OpenMPI's the same without tracing, whose time is that of the messages. All are built at once.
.PHONY: simulated setup-simgrid simulate-mpi test-simgrid
simulated_folder := experiments/cluster/simulated
simulated_sources := $(wildcard $(simulated_folder)/*.c) src/mpi/handout.c src/render/core/schedule.c src/base/status.c src/base/cancel.c
simulated_flags = -std=gnu17 -D_GNU_SOURCE -O2 -g $(filter -W%,$(all_cflags)) -Isrc -I$(simulated_folder)
simulated: $(build)/cluster/simulated
setup-simgrid: | $(filter setup setup-mpi,$(MAKECMDGOALS)) ## install what make simulate-mpi requires: SimGrid
	@.ci/setup-simgrid
$(build)/cluster/simulated: private compiler = smpicc -DSIMULATED
$(build)/cluster/messages: private compiler = mpicc
$(build)/cluster/simulated $(build)/cluster/messages: $(simulated_sources) $(wildcard $(simulated_folder)/*.h) src/mpi/messenger.c $(wildcard src/mpi/*.h) $(build)/flags | $(filter setup-simgrid setup-mpi,$(MAKECMDGOALS))
	$(call say,$(firstword $(compiler)) $(simulated_folder))
	@mkdir -p $(@D)
	$(quiet)$(compiler) $(simulated_flags) -DMESSAGES_ARE_KEPT -include simulated_mpi.h -c -o $@-messenger.o src/mpi/messenger.c
	$(quiet)$(compiler) $(simulated_flags) -o $@ $(filter-out %/messenger.c,$(filter %.c,$^)) $@-messenger.o -lm
simulate-mpi: simulated ## simulate cuvette-mpi on clusters of 1 to 4096 ranks (half an hour); the table is results/cluster.csv
	TABLE='$(abspath $(RESULTS))/cluster.csv' $(simulated_folder)/study.sh
test-simgrid: simulated | $(filter test experiments bench,$(MAKECMDGOALS)) ## test the simulation of a cluster, with 4 and 64 ranks
	@SIMULATED='$(abspath $(build)/cluster/simulated)' tests/run tests/simgrid.sh

# What the same bits everywhere cost (experiments/determinism.sh): the program without parts of that, FILM-CONTRACT-COMPILER. Sums of
# the film fixed or float (render/core/film.h); products and sums of the kernels contracted (fast) to FMA, which SSE2 does not have,
# or not (off). gcc or clang compiles the kernels and what writes the film; all else is that of $(build).
.PHONY: variants
VARIANTS ?= $(foreach compiler,gcc clang,$(addsuffix -$(compiler),fixed-off fixed-fast float-off float-fast))
in_tracer := src/optics/% src/geometry/% src/render/%
tracer := $(filter $(in_tracer),$(library))
tracer_kernels := $(filter $(in_tracer),$(kernels))
film_users = $(eval film_users := $$(shell grep -lE 'film_(sum|units|add|radiance)' $$(tracer) $$(tracer_kernels)))$(film_users)
variants: $(VARIANTS:%=$(build)/variants/%/cuvette) $(build)/cuvette-import ## build the program without what makes the same bits everywhere: build/variants
variant_cflags = $(patsubst -ffp-contract=%,-ffp-contract=$(1),$(code_flags)) -g0 -w -MMD -MP
# $(1): its name; $(2): compiler; $(3): contract; $(4): flags of the film. Objects replace those of the library after them.
define variant_rules
variant_objects_$(1) := $$(patsubst src/%.c,$$(build)/variants/$(1)/%.o,src/base/build_id.c $$(filter-out %_kernel.c,$$(film_users))) \
  $$(foreach i,$$(isas),$$(patsubst src/%.c,$$(build)/variants/$(1)/%.$$(i).o,$$(filter %_kernel.c,$$(film_users)))) \
  $(if $(filter off-$(notdir $(CC)),$(3)-$(2)),,$$(foreach i,$$(isas),$$(patsubst \
  src/%.c,$$(build)/variants/fixed-$(3)-$(2)/%.$$(i).o,$$(filter-out $$(film_users),$$(tracer_kernels)))))
$$(build)/variants/$(1)/%.o: src/%.c $$(build)/flags
	$$(call say,$(2) $$< for $(1))
	@mkdir -p $$(@D)
	$$(quiet)$(2) $$(call variant_cflags,off) $(4) -DCUVETTE_BUILD_ID='"$(1)"' -c -o $$@ $$<
$$(build)/variants/$(1)/cuvette: $$(program_objects) $$(build)/libweb.a $$(variant_objects_$(1)) $$(build)/libcuvette.a
	$$(call say,link $$@)
	$$(quiet)$$(CC) $$(all_cflags) -o $$@ $$^ $$(LDFLAGS) $$(all_libs)
-include $$(variant_objects_$(1):.o=.d)
endef
# $(1): its name; $(2): compiler; $(3): instruction set; $(4): contract; $(5): flags of the film
define variant_kernel_rule
$$(build)/variants/$(1)/%_kernel.$(3).o: src/%_kernel.c $$(build)/flags
	$$(call say,$(2) $$< for $(1) $(3))
	@mkdir -p $$(@D)
	$$(quiet)$(2) $$(call variant_cflags,$(4)) $$(isa_flags_$(3)) $$(if $$(filter fast-avx2,$(4)-$(3)),-mfma) $(5) -DKERNEL_ISA=$(3) -c -o $$@ $$<
endef
variant_part = $(word $(2),$(subst -, ,$(1)))
variant_film = $(if $(filter float-%,$(1)),-DCUVETTE_FILM_FLOAT=1)
ifneq ($(filter variants,$(MAKECMDGOALS)),)
variant_names := $(sort $(VARIANTS) $(VARIANTS:float-%=fixed-%))
$(foreach v,$(variant_names),$(eval $(call \
  variant_rules,$(v),$(call variant_part,$(v),3),$(call variant_part,$(v),2),$(call variant_film,$(v)))))
$(foreach v,$(variant_names),$(foreach i,$(isas),$(eval $(call \
  variant_kernel_rule,$(v),$(call variant_part,$(v),3),$(i),$(if $(filter sse2,$(i)),off,$(call variant_part,$(v),2)),$(call variant_film,$(v))))))
endif

# The programs that the benchmarks compare with: the report's algorithm, which needs only a compiler, and Embree if installed.
# The program that calls Embree is compiled for the machine that it runs on.
report_sources := $(wildcard experiments/peers/report/*.[ch])
.PHONY: peers
peers: $(build)/peers/report $(build)/libcuvette.a ## build the programs that the benchmarks compare with (experiments/peers)
	@$(if $(embree),$(MAKE) --no-print-directory build=$(build) $(build)/peers/embree)
$(build)/peers/report: $(report_sources) $(build)/flags
	$(call say,$(CC) experiments/peers/report)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(all_cflags) -o $@ $(filter %.c,$^) $(LDFLAGS) -lm -pthread
$(build)/peers/embree: experiments/peers/embree.c $(build)/libcuvette.a $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(all_cflags) -march=native -MMD -MP -o $@ $< $(build)/libcuvette.a $(LDFLAGS) -lembree3 $(all_libs)

-include $(build)/peers/embree.d
-include $(library_objects:.o=.d) $(program_objects:.o=.d) $(web_objects:.o=.d) $(mpi_objects:.o=.d) $(importer_objects:.o=.d) $(test_programs:=.d) $(fuzzers:=.d) $(replayed:.o=.d) $(fuzzed_objects:.o=.d) $(benches:=.d) $(build)/tests/power/reader.d $(build)/account_keys.d

.PHONY: setup
setup: ## install the required packages (Debian 12); does nothing if they are installed
	@.ci/setup

.PHONY: setup-python
setup-python: | $(filter setup setup-peers,$(MAKECMDGOALS)) ## install what the Python module and its tests require (Debian's cffi, NumPy, pandas, pytest)
	@PYTHON='$(PYTHON)' .ci/setup-python

.PHONY: setup-paper
setup-paper: | $(filter setup setup-doc,$(MAKECMDGOALS)) ## install what make paper requires: LaTeX
	@.ci/setup-paper

.PHONY: setup-peers
setup-peers: | $(filter setup,$(MAKECMDGOALS)) ## install the programs that the benchmarks compare with: POV-Ray, Tachyon, Embree
	@.ci/setup-peers

include src/wasm/wasm.mk

# --- documentation ---

# The manual in build/man: the pages of src/manual, three of them completed between their comments "begin PART" and "end PART" from the
# table of parameters, the list of quantities (src/job/quantities.c) and results/README.md.
complete = set -o pipefail; $(2) | sed -i '/^\.\\" begin $(1)/r /dev/stdin' $(build)/man/man5/$(3)
$(build)/man/made: $(wildcard src/manual/man?/*) src/manual/results.awk results/README.md $(build)/cuvette $(build)/account_keys
	@rm -rf $(@D) && mkdir -p $(@D) && cp -r src/manual/man? $(@D)
	@$(call complete,parameters,$(build)/cuvette params --man,cuvette-scene.5)
	@$(call complete,account,$(build)/account_keys,cuvette-account.5)
	@$(call complete,results,awk -f src/manual/results.awk results/README.md,cuvette-results.5)
	@touch $@
$(build)/account_keys: src/manual/account_keys.c $(build)/libcuvette.a $(build)/flags
	$(call say,$(CC) $<)
	$(quiet)$(CC) $(all_cflags) $(pkg_cflags) -MMD -MP -o $@ $< $(build)/libcuvette.a $(LDFLAGS) $(all_libs)

# The manual, the API, the lessons and the gallery as HTML in build/doc, to read offline.
.PHONY: doc doc-tools setup-doc test-doc
setup-doc: | $(filter setup setup-peers,$(MAKECMDGOALS)) ## install the programs that make doc needs: mandoc, cmark-gfm, python3
	@.ci/setup-doc
doc: $(build)/cuvette $(build)/man/made doc-tools ## write the documentation as HTML: build/doc/index.html
	@rm -rf $(build)/doc
	@python3 -B src/manual/site/build.py $(build)/cuvette $(build)/man $(build)/doc
	@echo 'documentation: $(build)/doc/index.html'
doc-tools: | $(filter setup-doc setup-site,$(MAKECMDGOALS))
	@for tool in python3 mandoc cmark-gfm; do command -v $$tool >/dev/null || \
	  { echo "doc: $$tool is not installed; run: make setup-doc" >&2; exit 1; }; done
test-doc: $(build)/cuvette $(build)/man/made | doc-tools ## check the documentation: complete, every link resolves; part of make test
	@BUILD='$(build)' CUVETTE='$(abspath $(build)/cuvette)' tests/run tests/doc.sh

include src/web/site/site.mk

# --- tests ---

# Checks of the sources, run in one configuration only.
source_checks := tests/layers.sh tests/headers.sh tests/vectorise.sh tests/targets.sh tests/format.sh tests/fault_texts.sh \
  tests/compile_commands.sh tests/words.sh tests/doc.sh
every_script := $(filter-out tests/arch.sh tests/mpi.sh tests/slurm.sh tests/simgrid.sh,$(wildcard tests/*.sh))
scripts := $(filter-out $(if $(filter-out release,$(config)$(clang)$(RUNNER)),$(source_checks)),$(every_script))
# make test only=NAME runs what has that name: tests/test_NAME.c, tests/test_NAME.sh and tests/NAME.sh.
named = $(filter $(build)/tests/test_$(1),$(test_programs)) $(filter tests/test_$(1).sh tests/$(1).sh,$(every_script))
test_names = $(sort $(patsubst test_%,%,$(basename $(notdir $(tests) $(every_script)))))
similar = $(shell name='$(1)'; printf '%s\n' $(test_names) | grep -F -e "$${name:0:3}")
unknown = $(error only=$(1): there is no tests/test_$(1).c, tests/test_$(1).sh or tests/$(1).sh; \
  $(or $(if $(similar),did you mean: $(similar)),ls tests shows the names))
selected := $(if $(only),$(foreach name,$(only),$(or $(strip $(call named,$(name))),$(if $(filter test,$(MAKECMDGOALS)),$(call unknown,$(name))))), \
  $(test_programs) $(scripts))
selected_programs = $(filter-out %.sh,$(selected))
selected_scripts = $(filter %.sh,$(selected))

kernel_environment = KERNEL_FLAGS='$(code_flags)' $(foreach i,$(isas),KERNEL_FLAGS_$(i)='$(isa_flags_$(i))')

# The part of two long tests that `make test` runs; `make check` runs the others. Random scenes of tests/test_laws.c, fewer with
# instrumentation, and the slice of tests/test_acts.c.
test_scenes := $(if $(LAWS_SCENES),$(LAWS_SCENES),$(if $(RUNNER)$(filter coverage,$(config)),20,$(if $(filter release,$(config)),150,100)))
ACTS_SLICE ?= 34/96

.PHONY: test
# Programs that test scripts run.
tested = $(build)/cuvette $(build)/man/made $(build)/$(soname) $(build)/engine/libcuvette.a $(build)/tests/bench_mesh $(build)/tests/recheck peers $(power_tools) \
  $(if $(filter release,$(config)),$(fault_tools))
test: $(selected_programs) $(build)/cuvette-import $(if $(selected_scripts),$(tested)) ## build and run every test; only=NAME for tests/test_NAME.c and tests/NAME.sh alone
	@LAWS_SCENES='$(test_scenes)' ACTS_SLICE='$(ACTS_SLICE)' CC='$(CC)' BUILD='$(build)' CONFIG='$(config)' CUVETTE='$(abspath $(build)/cuvette)' CUVETTE_IMPORT='$(abspath $(build)/cuvette-import)' $(kernel_environment) \
	  tests/run $(selected_scripts) $(selected_programs)

# The tables of results/README.md, which people read where nothing is built, equal the list of quantities.
.PHONY: dictionary
dictionary: $(build)/tests/test_quantities ## renew the tables of results/README.md from the list of quantities
	@CUVETTE_RENEW=1 $< >/dev/null 2>&1 && $<

# The page in a real browser: only=NAME for tests/web/NAME.test.mjs alone, screenshots=FOLDER for images of every view, ENGINE=browser for the
# laboratory of `make wasm` in the page instead of the program. Runs after everything that installs or measures.
.PHONY: test-web setup-web
setup-web: | $(filter setup setup-peers setup-python setup-mpi setup-wasm,$(MAKECMDGOALS))
	@.ci/setup-web $(build)/web-tests
test-web: $(build)/cuvette $(if $(filter browser,$(ENGINE)),wasm) | setup-web $(filter test test-mpi experiments bench,$(MAKECMDGOALS)) ## test the laboratory's page in Chromium, installed with node if missing; only=NAME for one file, ENGINE=browser without the server
	@tests/format.sh --check $(build)/web-tests
	@node tests/web/run.mjs --program '$(abspath $(build)/cuvette)' --modules '$(abspath $(build)/web-tests)' \
	  $(if $(ENGINE),--engine '$(ENGINE)' --wasm '$(abspath $(wasm))') \
	  $(if $(screenshots),--screenshots '$(abspath $(screenshots))') $(only)

# Other architectures, with Debian's cross compilers and qemu-user: arch="s390x" for one of .ci/architectures, SIZE=160x120 for larger films.
.PHONY: test-arch setup-arch
setup-arch: | $(filter setup,$(MAKECMDGOALS)) ## install what test-arch requires: cross compilers, qemu-user, libraries in build/arch
	@.ci/setup-arch $(build)/arch $(arch)
test-arch: $(build)/cuvette $(build)/cuvette-import | $(filter setup-arch,$(MAKECMDGOALS)) ## build for arm64, s390x and riscv64; compare films, files and rows with this machine's
	@CUVETTE='$(abspath $(build)/cuvette)' MAKE='$(MAKE)' tests/arch.sh $(build)/arch $(arch)

# A cluster of four nodes on this machine.
.PHONY: test-slurm setup-slurm
setup-slurm: | $(filter setup,$(MAKECMDGOALS)) ## install what test-slurm requires: Slurm's daemons and commands, munge
	@.ci/setup-slurm
test-slurm: $(build)/cuvette | $(filter setup-slurm,$(MAKECMDGOALS)) ## run a study on a real Slurm, five minutes: killed tasks, a lost node, a time limit
	@CUVETTE='$(abspath $(build)/cuvette)' tests/slurm.sh

# The Python module (src/python): Python text only, which loads the shared library of this build or installation.
PYTHON ?= $(firstword $(wildcard /usr/bin/python3) python3)
module := $(build)/python/cuvette
module_sources := $(wildcard src/python/cuvette/*.py src/python/cuvette/py.typed)
$(module)/_declarations.py: src/python/declare.py src/cuvette.h $(module_sources) $(build)/cuvette | $(filter setup-python,$(MAKECMDGOALS))
	$(call say,python $@)
	@mkdir -p $(@D)
	$(quiet)$(build)/cuvette params --json >$(build)/python/params.json
	$(quiet)cp $(module_sources) $(@D)/
	$(quiet)$(PYTHON) src/python/declare.py src/cuvette.h $(build)/python/params.json $(@D)
.PHONY: python test-python
python: $(module)/_declarations.py all ## build the Python module; try it with PYTHONPATH=build/python
test-python: python | $(filter test test-mpi test-web experiments bench,$(MAKECMDGOALS)) ## test the Python module with pytest; only=NAME for tests/python/test_NAME.py alone
	@MALLOC_PERTURB_=165 PYTHONPATH='$(abspath $(build)/python)' CUVETTE='$(abspath $(build)/cuvette)' CC='$(CC)' \
	  $(PYTHON) -m pytest -q -p no:cacheprovider $(if $(only),$(only:%=tests/python/test_%.py),tests/python)

.PHONY: layers headers vectorise
layers: ## check the layers of includes
	@tests/run tests/layers.sh
headers: $(build)/flags ## check that every header compiles alone, as C17 and as C++17
	@CHECK=1 CC='$(CC)' tests/run tests/headers.sh
vectorise: $(build)/flags ## report which kernel loops are vectorised; fail if a required one is not
	@CHECK=1 $(kernel_environment) bash tests/vectorise.sh | sed -n 's/^# //p; /^not ok/p'; exit $${PIPESTATUS[0]}

.PHONY: sanitize tsan valgrind clang
sanitize: ## build and test with AddressSanitizer and UndefinedBehaviorSanitizer
	@$(MAKE) STRICT=1 config=sanitize build=$(build)/sanitize TEST_LIMIT_S=3600 test
tsan: ## build and test with ThreadSanitizer
	@$(MAKE) STRICT=1 config=tsan build=$(build)/tsan TEST_LIMIT_S=3600 test
valgrind: ## run the test programs under valgrind
	@$(MAKE) RUNNER='valgrind -q --error-exitcode=9 --leak-check=full --max-threads=1100 --suppressions=tests/valgrind.supp' \
	  TEST_LIMIT_S=3600 selected_scripts= test
clang: ## build and test with clang
	@$(MAKE) STRICT=1 CC=clang build=$(build)/clang test

.PHONY: instructions setup-instructions
setup-instructions: | $(filter setup setup-doc,$(MAKECMDGOALS)) ## install what make instructions requires: valgrind
	@.ci/setup-instructions
instructions: $(build)/cuvette ## count the instructions of six frames: none may need over 1 % more than before
	@CC='$(CC)' CUVETTE='$(abspath $(build)/cuvette)' tests/instructions/instructions.sh

.PHONY: power-cuts
power-cuts: $(build)/cuvette $(power_tools) ## judge every state that a power cut can leave of studies, animations, images (10 minutes)
	@BUILD='$(build)' CONFIG='$(config)' CUVETTE='$(abspath $(build)/cuvette)' POWER_STATES=$${POWER_STATES:-1000000} \
	  POWER_STATES_PER_CUT=$${POWER_STATES_PER_CUT:-20000} POWER_RESUMED=$${POWER_RESUMED:-30} bash tests/power_cuts.sh

# Random scenes in runs of 10 000, one run per processing unit at a time; LAWS_SCENES in total for each law, starting with LAWS_SEED.
.PHONY: laws law-faults
laws: LAWS_SCENES ?= 1000000
laws: LAWS_SEED ?= 1
laws: $(build)/tests/test_laws ## test the laws on a million random scenes
	@seq $(LAWS_SEED) $$(($(LAWS_SEED) + ($(LAWS_SCENES) + 9999) / 10000 - 1)) | \
	  LAWS_SCENES=10000 xargs -P "$$(nproc)" -I SEED tests/faults/run_seed.sh $(build)/tests/test_laws SEED
law-faults: ## insert known faults into the sources, one at a time: the laws must detect each
	@tests/faults/laws.sh

# Memory and system calls that fail, in every command, the library and the laboratory: all sites, or those of only=NAME of
# tests/faults/commands.txt; kinds=memory,write-enospc. `make test` tries a part of them.
.PHONY: faults fault-checks
faults: $(build)/cuvette $(build)/cuvette-import $(fault_tools) ## fail every allocation and system call of every command once (an hour); only=NAME for one
	@BUILD='$(build)' CUVETTE='$(abspath $(build)/cuvette)' FAULTS_EVERY=1 FAULTS_DEPTH=0 FAULTS_ONLY='$(only)' FAULTS_KINDS='$(kinds)' \
	  bash tests/faults.sh
fault-checks: $(build)/cuvette $(build)/cuvette-import $(fault_tools) ## remove checks from the sources, one at a time: the faults must detect each
	@BUILD='$(abspath $(build))' tests/faults/checks.sh

# Lines of src that the tests run, among them the fuzzers' inputs (test_fuzz_corpus); made by gcc. coverage drops the
# counts of earlier runs, coverage-add keeps them. The report is written after tests that fail, too.
GCOV ?= $(subst gcc,gcov,$(lastword $(CC)))
of_coverage = $(if $(clang),$(error coverage: only gcc is supported; leave CC=$(CC) out))--no-print-directory STRICT=1 \
  config=coverage build=$(build)/coverage TEST_LIMIT_S=3600
.PHONY: coverage coverage-add coverage-report run_coverage report_coverage
coverage: ## report which lines of src the tests run, in build/coverage/report; only=NAME as for test (needs gcovr)
	@$(MAKE) $(of_coverage) run_coverage
coverage-add: ## run tests for coverage-report; only=NAME
	@$(MAKE) $(of_coverage) test
coverage-report: ## report which lines of src all tests have run since the last `make coverage`, or since the file changed
	@$(MAKE) $(of_coverage) report_coverage
run_coverage:
	@mkdir -p $(build) && find $(build) -name '*.gcda' -delete
	@code=0; $(MAKE) --no-print-directory build=$(build) test || code=$$?; \
	  $(MAKE) --no-print-directory build=$(build) report_coverage && exit $$code
report_coverage:
	@command -v gcovr >/dev/null || { echo 'coverage: gcovr is not installed; install it with: apt-get install gcovr' >&2; exit 1; }
	@mkdir -p $(build)/report
	@gcovr --gcov-executable '$(GCOV)' --root . --filter src/ --exclude-throw-branches --html-details $(build)/report/index.html \
	  --txt $(build)/report/missed.txt --print-summary $(build)
	@echo 'report: $(build)/report/index.html; the lines that neither tests nor the inputs of fuzzers reach: $(build)/report/missed.txt'

# Small errors in the sources, one at a time, that a test must detect; everything that checks, in slices.
.PHONY: mutants check
mutants: $(build)/cuvette ## insert 600 small errors into physics and statistics: a unit test must detect each (hours; goes on)
	@BUILD='$(build)' tests/mutants/mutants.sh
check: $(build)/cuvette ## run everything that checks, in slices that go on where they stopped (hours); CHECK_SECONDS=300 for five minutes, only="acts sanitize-2" for some
	@BUILD='$(build)' CC='$(CC)' tests/check/check.sh $(only)

.PHONY: interrupts
MOMENTS ?= 1000
interrupts: $(build)/cuvette $(build)/cuvette-import ## Ctrl-C at MOMENTS=1000 random moments of all commands: what is left, and after how long
	@rm -f $(build)/interrupts.txt; CUVETTE='$(abspath $(build)/cuvette)' CUVETTE_IMPORT='$(abspath $(build)/cuvette-import)' CC='$(CC)' \
	  LATENCY='$(abspath $(build)/interrupts.txt)' MOMENTS=$$((($(MOMENTS) + 31) / 32)) bash tests/interrupt.sh all

# The fuzzers that have waited longest: FUZZ_TOTAL seconds in all, FUZZ_SECONDS each; only=NAME for tests/fuzz/NAME.c alone.
.PHONY: fuzz fuzz-merge run_fuzzers merge_corpus
selected_fuzzers = $(if $(only),$(only:%=$(build)/tests/fuzz_%),$(fuzzers))
fuzz: ## feed the readers with libFuzzer (clang), FUZZ_SECONDS=60 each; FUZZ_TOTAL=600: only that long, whose turn it is
	@$(MAKE) config=fuzz CC=clang build=$(build)/fuzz run_fuzzers
run_fuzzers: $(selected_fuzzers)
	@FUZZ_SECONDS='$(FUZZ_SECONDS)' FUZZ_TOTAL='$(FUZZ_TOTAL)' tests/fuzz/run.sh $(build) $(only)
fuzz-merge: ## renew tests/fuzz/corpus from what the fuzzers kept; only=NAME
	@$(MAKE) config=fuzz CC=clang build=$(build)/fuzz merge_corpus
merge_corpus: $(selected_fuzzers)
	@tests/fuzz/run.sh --merge $(build) $(only)

# --- studies, figures, paper ---

.PHONY: experiments experiments-full tables figures claims paper bench
# Nothing runs in parallel with a measurement.
requested = $(filter $(1),$(MAKECMDGOALS))
experiments: | $(call requested,test)
experiments-full: | $(call requested,test experiments)
bench: | $(call requested,test experiments)
claims paper: | $(call requested,experiments figures)
experiments: $(build)/cuvette-import
experiments: $(build)/cuvette ## run the studies that reproduce the reports (resumes): tables, figures, closing page; QUICK=1 for a look
	@$(MAKE) --no-print-directory build=$(build) RESULTS=$(RESULTS) $(RESULTS)/figures/fan.svg $(RESULTS)/figures/trace.svg
	@$(run_studies)
run_studies = CUVETTE='$(abspath $(build)/cuvette)' experiments/run.sh $(if $(QUICK),--quick) --results '$(RESULTS)'
experiments-full: $(build)/cuvette-import
experiments-full: $(build)/cuvette ## run the studies of experiments/full as well: an hour more
	@$(run_studies) experiments/*.study experiments/full/*.study
	@$(if $(QUICK),,$(MAKE) --no-print-directory build=$(build) RESULTS=$(RESULTS) $(RESULTS)/tables/growth.tsv \
	  $(RESULTS)/tables/paths.tsv figures)

tables: $(build)/cuvette ## summarise the existing rows: RESULTS/tables, which figures, claims and the paper read; RESULTS=DIR, ENVIRONMENT=HEX
	@CUVETTE='$(abspath $(build)/cuvette)' ENVIRONMENT='$(ENVIRONMENT)' experiments/tables.sh '$(RESULTS)'

# What no study can sweep: measured once; remove the table to measure again.
$(RESULTS)/tables/growth.tsv: | $(build)/cuvette
	@mkdir -p $(@D)
	experiments/growth.sh $(build)/cuvette >$@.new && mv $@.new $@
$(RESULTS)/tables/paths.tsv: | $(build)/cuvette
	@mkdir -p $(@D)
	TABLE=$@.new experiments/paths.sh $(build)/cuvette && mv $@.new $@

figures: tables $(RESULTS)/figures/fan.svg $(RESULTS)/figures/trace.svg $(RESULTS)/displacement/points.csv ## draw the figures whose rows exist; one line says why another is skipped
	@mkdir -p $(RESULTS)
	plots/draw.sh --results $(RESULTS)

# How far the vessel moves what is seen through it.
$(RESULTS)/displacement/points.csv: experiments/displacement.sh experiments/scenes/rod.yaml | $(build)/cuvette
	@mkdir -p $(@D)
	experiments/displacement.sh $(build)/cuvette >$@.new && mv $@.new $@

# Rays through the filled vessel with focus and caustic; and the ray tree of one ray.
$(RESULTS)/figures/fan.svg: experiments/scenes/rod.yaml | $(build)/cuvette
	@mkdir -p $(@D)
	$(build)/cuvette fan $< --from -3,1.5,0 --to 3,1.5,0 --width 1.9 --rays 41 --set rod.visible=off -o $@
$(RESULTS)/figures/trace.svg: experiments/scenes/rod.yaml | $(build)/cuvette
	@mkdir -p $(@D)
	$(build)/cuvette trace $< --ray=-3,1.5,0.6,1,0,0 --depth 5 --set rod.visible=off -o $@

# The rows of this clone, or the committed run if there are none and no folder is given.
claimed = $(if $(QUICK)$(filter-out file,$(origin RESULTS))$(wildcard $(RESULTS)/*/rows*.csv),$(RESULTS),results/reference)
claims: $(build)/cuvette ## judge each claim of the paper by the rows: reproduced, not reproduced, underpowered; RESULTS=DIR, ENVIRONMENT=HEX
	@CUVETTE='$(abspath $(build)/cuvette)' ENVIRONMENT='$(ENVIRONMENT)' experiments/tables.sh '$(claimed)'
	@paper/claims.py '$(claimed)' $(build)/claims

paper: $(build)/cuvette ## rebuild the paper and its supplement from existing rows, without measuring
	$(MAKE) -C paper CUVETTE='$(abspath $(build)/cuvette)' $(if $(QUICK),RESULTS='$(RESULTS)')

# The build by clang, if it is installed and another compiler made this one.
bench_clang = $(if $(clang),,$(shell command -v clang >/dev/null && echo $(build)/by-clang/cuvette))
bench: all peers $(build)/tests/bench_mesh $(build)/tests/bench_rows ## benchmark frames and rays as ratios to other programs; REPS=7 rounds
	@$(MAKE) --no-print-directory config=nocounters build=$(build)/nocounters $(build)/nocounters/cuvette
	@$(if $(bench_clang),$(MAKE) --no-print-directory CC=clang build=$(build)/by-clang $(build)/by-clang/cuvette)
	CUVETTE='$(abspath $(build)/cuvette)' NOCOUNTERS='$(abspath $(build)/nocounters/cuvette)' experiments/bench.sh
	@echo
	experiments/solids_bench.sh $(build)/cuvette
	@echo
	experiments/lights_bench.sh $(build)/cuvette
	@echo
	experiments/slime_bench.sh $(build)/cuvette
	@echo
	experiments/process_bench.sh $(build)/cuvette $(bench_clang)
	@echo
	experiments/mesh_bench.sh $(build)/tests/bench_mesh
	@echo
	experiments/paths.sh $(build)/cuvette
	@echo
	$(build)/tests/bench_rows

# --- installation, upkeep ---

.PHONY: install install-python uninstall
LIBDIR ?= $(PREFIX)/lib
share := $(PREFIX)/share
pages := $(patsubst src/manual/%,%,$(wildcard src/manual/man?/*))
# What is installed: mode, file and place of each, without DESTDIR. The list that notes it is what `make uninstall` reads.
list := $(share)/cuvette/installed-files
define files
  echo '755 $(build)/cuvette $(PREFIX)/bin/cuvette'; \
  $(if $(wildcard $(build)/cuvette-mpi)$(filter mpi,$(MAKECMDGOALS)),echo '755 $(build)/cuvette-mpi $(PREFIX)/bin/cuvette-mpi';) \
  echo '755 $(build)/cuvette-import $(PREFIX)/libexec/cuvette/cuvette-import'; \
  echo '644 src/cuvette.h $(PREFIX)/include/cuvette.h'; \
  echo '644 $(build)/engine/libcuvette.a $(LIBDIR)/libcuvette.a'; \
  echo '644 $(build)/$(soname) $(LIBDIR)/libcuvette.so.$(version)'; \
  echo 'link libcuvette.so.$(version) $(LIBDIR)/$(soname)'; \
  echo 'link $(soname) $(LIBDIR)/libcuvette.so'; \
  echo '644 $(build)/cuvette.pc $(LIBDIR)/pkgconfig/cuvette.pc'; \
  for page in $(pages); do echo "644 $(build)/man/$$page $(share)/man/$$page"; done; \
  echo '644 src/cli/cuvette.bash $(share)/bash-completion/completions/cuvette'; \
  for text in LICENSE README.md CHANGELOG.md src/licences.md; do echo "644 $$text $(share)/doc/cuvette/$${text##*/}"; done; \
  $(if $(wildcard $(build)/live.html)$(filter site,$(MAKECMDGOALS)),echo '644 $(build)/live.html $(share)/cuvette/live.html';) \
  find experiments plots -type f ! -path '*/__pycache__/*' | while read -r file; do \
    test -x "$$file" && mode=755 || mode=644; echo "$$mode $$file $(share)/cuvette/$$file"; done
endef
install: $(build)/cuvette $(build)/man/made $(build)/cuvette-import $(build)/$(soname) $(build)/engine/libcuvette.a | $(filter mpi site,$(MAKECMDGOALS)) ## install under PREFIX (/usr/local), below DESTDIR; with cuvette-mpi where make mpi has built it, and live.html of make site
	@sed 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(LIBDIR)|; s|@VERSION@|$(version)|; s|@LIBRARIES@|$(strip $(all_libs))|' src/cuvette.pc.in >$(build)/cuvette.pc
	@{ $(files); } | DESTDIR='$(DESTDIR)' .ci/install '$(list)'
	@.ci/install-notes '$(DESTDIR)' '$(PREFIX)' '$(LIBDIR)'
# The Python module, where python3 finds it.
module_place = $(shell $(PYTHON) src/python/place.py $(PREFIX))/cuvette
install-python: python install ## the same, and the Python module where python3 finds it
	@for file in $(module)/*.py $(module)/py.typed; do echo "644 $$file $(module_place)/$${file##*/}"; done | \
	  DESTDIR='$(DESTDIR)' .ci/install '$(list)'
uninstall: ## remove the files that make install installed
	@DESTDIR='$(DESTDIR)' .ci/install --remove '$(list)'

.PHONY: setup-deb deb test-deb
setup-deb: | $(filter setup,$(MAKECMDGOALS)) ## install what the Debian packages require: debhelper, lintian, ...
	@.ci/setup-deb
deb: | $(filter setup setup-deb setup-python setup-doc,$(MAKECMDGOALS)) ## build the Debian packages in build/deb, and check them by lintian
	@MAKEFLAGS= .ci/deb $(build)/deb
test-deb: ## install the packages of make deb in a fresh Debian 12, use and remove them (root, debootstrap)
	@.ci/test-deb $(build)/deb

# For clangd and other tools that parse C: all C files, with the flags of this configuration.
.PHONY: compiled compile_commands.json
by_scripts := tests/json_get.c tests/free_space.c tests/limit.c $(wildcard tests/interrupt/*.c experiments/engine/*.c tests/faults/*.c tests/power/*.c)
compiled: all peers $(mpi_objects) $(test_programs) $(benches) $(build)/tests/recheck $(fuzzers) $(by_scripts:%.c=$(build)/by-scripts/%.o)
$(build)/by-scripts/%.o: %.c $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(all_cflags) $(pkg_cflags) -c -o $@ $<
compile_commands.json: ## write the compilation database for clangd
	@MAKE='$(MAKE)' .ci/compile_commands $@ build=$(build) compiled

.PHONY: format format-check clean distclean help
format: ## format the sources: clang-format, shfmt and, after setup-web, prettier
	@tests/format.sh --write $(build)/web-tests
format-check: ## check the format of the sources; part of make test
	@tests/run tests/format.sh
clean: ## remove the build folder
	rm -rf $(build)
distclean: clean ## also remove tables and figures; measured rows stay in results/
	rm -rf build $(RESULTS)/tables $(RESULTS)/figures
	@test ! -f paper/Makefile || $(MAKE) -C paper clean
help: ## list the targets
	@sed -n 's/^\([a-z_.-]*\):.*## \(.*\)/  make \1\t\2/p' $(filter-out %.d,$(MAKEFILE_LIST)) | expand -t 30
