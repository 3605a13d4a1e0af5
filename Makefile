# Cuvette. `make help` lists the targets.
#   make config=debug|release|sanitize|tsan|coverage|nocounters [CC=clang] [target]    each with its own build folder
# What is here: flags, programs, libraries, upkeep. In mk: arch.mk (instruction sets), tests.mk, check.mk (the long
# checks), install.mk (packages), doc.mk, wasm.mk, bench.mk, experiments.mk (studies, figures, paper).
.DEFAULT_GOAL := all
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

# Of these targets, those that make runs now. Order-only: nothing runs in parallel with a measurement or installation.
requested = $(filter $(1),$(MAKECMDGOALS))

# build, build/clang, build/sanitize, build/sanitize-clang, ...
clang := $(findstring clang,$(notdir $(firstword $(CC))))
ifeq ($(config),release)
build := build$(clang:%=/%)
else
build := build/$(config)$(clang:%=-%)
endif

PACKAGES := libpng zlib libjpeg hwloc yaml-0.1 jansson kissfft-float
# Of OpenEXR only the library in C, without the C++ ones that its description for pkg-config names.
OPENEXR := -lOpenEXRCore
warnings := -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla
# Constants that are enumerators are exact as doubles; newer versions of clang warn about them.
warnings += $(if $(clang),-Wno-enum-float-conversion)
# No notes on vectors as arguments, which gcc passes in another way since version 4.6.
warnings += -Wno-psabi
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
pkg_cflags = $(eval pkg_cflags := $$(shell pkg-config --cflags $(PACKAGES)) \
  $$(shell pkg-config --cflags-only-I OpenEXR))$(pkg_cflags)
pkg_libs = $(eval pkg_libs := $$(shell pkg-config --libs $(PACKAGES)) \
  $$(shell pkg-config --libs-only-L OpenEXR) $(OPENEXR))$(pkg_libs)
import_libs = $(eval import_libs := $$(shell pkg-config --libs jansson zlib) -lm)$(import_libs)
# Valgrind of Debian 12 cannot read the DWARF 5 that clang writes.
CFLAGS ?= -g$(if $(clang),dwarf-4)
# One set of objects for the program and both libraries: on the supported machines, position-independent code with
# hidden symbols is as fast. A shared library exports only what cuvette.h marks.
linkage := -fPIC -fvisibility=hidden
# Flags that may change a result; the others are for warnings and paths.
code_flags = -std=gnu17 -D_GNU_SOURCE $(linkage) $(arithmetic) $(optimize) $(CFLAGS) -Isrc -pthread
all_cflags = $(code_flags) -DCUVETTE_VERSION='"$(version)"' \
  -DCUVETTE_COMPILER_FLAGS='"$(config): $(optimize) $(arithmetic)"' $(warnings) $(errors)
all_libs = $(pkg_libs) -lm -pthread
program_libs = -lnlopt $(all_libs)

# Embree 3, which one of the peers links if it is installed. Detected at its first use, as above.
embree = $(eval embree := $$(shell \
  $$(CC) -E -include embree3/rtcore.h -x c /dev/null >/dev/null 2>&1 && echo yes))$(embree)

# The recipe of an object: $(1), its flags; $(2), what is said after its source.
define compile
$(call say,$(CC) $<$(2))
@mkdir -p $(@D)
$(quiet)$(CC) $(1) -MMD -MP -c -o $@ $<
endef
# An archive of all that it depends on.
define archive
@rm -f $@
$(quiet)ar rcs $@ $^
endef

sources := $(wildcard src/*.c src/*/*.c src/*/*/*.c src/*/*/*/*.c)
kernels := $(filter %_kernel.c,$(sources))
library := $(filter-out src/cli/% src/import/% src/web/% src/mpi/% src/wasm/% src/manual/% src/study/fit/% $(kernels),\
  $(sources))
# `cuvette fit`, which needs NLopt: only for the program.
fit := $(wildcard src/study/fit/*.c)
program := $(wildcard src/cli/*.c)
mpi := $(filter src/mpi/%,$(sources))
web := $(filter src/web/%,$(sources))
page := $(sort $(wildcard $(foreach e,html css js json svg jpg,src/web/page/*.$(e) src/web/page/*/*.$(e))))
importer := $(wildcard src/import/*.c) $(addprefix src/base/,status.c cancel.c number.c below.c float_environment.c \
  array.c text.c os_confine.c os_process.c thread_team.c worker_pool.c json_build.c)
objects_of = $(1:src/%.c=$(build)/obj/%.o)
include mk/arch.mk
library_objects := $(call objects_of,$(library)) $(kernel_objects)
program_objects := $(call objects_of,$(program) $(fit))
mpi_objects := $(call objects_of,$(mpi))
web_objects := $(call objects_of,$(web)) $(build)/web/page_files.o
importer_objects := $(importer:src/%.c=$(build)/plain/%.o)

.PHONY: all
## all: build/cuvette, the library and the manual (the default)
all: $(build)/cuvette $(build)/cuvette-import $(build)/$(soname) $(build)/man/made

# A half-written file would look newer than its sources.
.DELETE_ON_ERROR:

$(build)/cuvette: $(program_objects) $(build)/libweb.a $(build)/libcuvette.a
	$(call say,link $@)
	$(quiet)$(CC) $(all_cflags) -o $@ $^ $(LDFLAGS) $(program_libs)

# The laboratory's server and its page: only for the program, not for the library.
$(build)/libweb.a: $(web_objects)
	$(archive)
$(build)/web/page_files.c: src/web/embed.sh $(sort $(dir $(page))) $(page)
	@mkdir -p $(@D)
	$(quiet)src/web/embed.sh src/web/page $(page) >$@
$(build)/web/page_files.o: $(build)/web/page_files.c $(build)/flags
	$(call compile,$(all_cflags) $(pkg_cflags))

# The same program on the ranks of an MPI job (src/mpi); nothing else needs MPI. MPI_PACKAGE: its name for pkg-config.
MPI_PACKAGE ?= ompi-c
mpi_cflags = $(eval mpi_cflags := $$(shell pkg-config --cflags $(MPI_PACKAGE) 2>/dev/null))$(mpi_cflags)
mpi_libs = $(eval mpi_libs := $$(shell pkg-config --libs $(MPI_PACKAGE) 2>/dev/null))$(mpi_libs)
.PHONY: mpi mpi-tools
## mpi: build/cuvette-mpi, for the ranks of an MPI job
mpi: $(build)/cuvette-mpi $(build)/cuvette-import
$(build)/cuvette-mpi: $(mpi_objects) $(filter-out %/cli/main.o %/cli/fit.o $(call objects_of,$(fit)), \
  $(program_objects)) $(build)/libweb.a \
  $(build)/libcuvette.a
	$(call say,link $@)
	$(quiet)$(CC) $(all_cflags) -o $@ $^ $(LDFLAGS) $(mpi_libs) $(all_libs)
$(build)/obj/mpi/%.o: private own_cflags = $(mpi_cflags)
mpi_pure := $(patsubst %,$(build)/obj/mpi/%.o,handout tracing)
$(mpi_pure): private own_cflags =
$(filter-out $(mpi_pure),$(mpi_objects)): | mpi-tools
mpi-tools: | $(call requested,setup-mpi)
	@pkg-config --exists $(MPI_PACKAGE) || \
	  { echo 'mpi: OpenMPI ($(MPI_PACKAGE)) is not installed; run: make setup-mpi' >&2; exit 1; }

# The mesh importer, a program of its own. Built without sanitizers, which need more address space than the limit that
# it sets itself.
plain_cflags = $(filter-out -fsanitize% -fno-sanitize%,$(all_cflags))
$(build)/cuvette-import: $(importer_objects)
	$(call say,link $@)
	$(quiet)$(CC) $(plain_cflags) -o $@ $^ $(filter-out -fsanitize%,$(LDFLAGS)) $(import_libs)
$(build)/plain/%.o: src/%.c $(build)/flags
	$(call compile,$(plain_cflags))

# The last place where the importer is looked for; not part of the flags, which a PREFIX only for `make install` must
# not change.
$(build)/obj/scene/assets/mesh_file.o: private all_cflags += -DCUVETTE_LIBEXEC='"$(PREFIX)/libexec/cuvette"'

$(build)/libcuvette.a: $(library_objects)
	$(archive)

# For other programs: as above without internal symbols, which could clash with the program's own (a static library does
# not hide any itself).
$(build)/engine/libcuvette.a: $(library_objects)
	$(call say,link $@)
	@mkdir -p $(@D) && rm -f $@
	$(quiet)$(CC) -r -nostdlib -o $(@D)/cuvette.o $^ && objcopy --localize-hidden $(@D)/cuvette.o && \
	  ar rcs $@ $(@D)/cuvette.o
	@rm $(@D)/cuvette.o

# Instrumented code leaves the symbols of the instrumentation to the program.
no_undefined := $(if $(filter sanitize tsan fuzz,$(config)),,-Wl,-z,defs)
$(build)/$(soname): $(library_objects)
	$(call say,link $@)
	$(quiet)$(CC) $(all_cflags) -shared -Wl,-soname,$(soname) $(no_undefined) -o $@ $^ $(LDFLAGS) $(all_libs)

# The identity of the build (src/base/installed.h): code of these folders can change a film or a time.
measured_code := $(sort $(foreach room,base optics geometry measure image softbody scene render realism job,$(wildcard \
  $(addprefix src/$(room)/,*.[ch] */*.[ch] */*/*.[ch]))))
$(build)/build_id: always $(build)/flags
	@{ $(CC) --version | head -n 1; \
	  echo '$(subst ','\'',$(code_flags) $(isas_flags))'; cat $(measured_code); } | \
	  sha256sum | cut -c 1-16 >$@.new
	@{ git rev-parse --short HEAD && git diff --quiet HEAD -- src Makefile mk || echo +; } 2>/dev/null | \
	  tr -d '\n' >>$@.new
	@cmp -s $@.new $@ && rm $@.new || mv $@.new $@
$(build)/obj/base/build_id.o: $(build)/build_id
$(build)/obj/base/build_id.o: private all_cflags += \
  -DCUVETTE_BUILD_ID='"$(shell sed -n 1p $(build)/build_id 2>/dev/null)"' \
  -DCUVETTE_BUILD_COMMIT='"$(shell sed 1d $(build)/build_id 2>/dev/null)"'

$(build)/obj/%.o: src/%.c $(build)/flags
	$(call compile,$(all_cflags) $(pkg_cflags) $(own_cflags))
$(build)/obj/study/plot/plot_script.o: plots/style.gp
$(build)/obj/cli/lens_report.o: plots/lens.gp
$(build)/obj/study/run/slurm.o: experiments/cluster/study.slurm
web_cflags = $(eval web_cflags := $$(shell pkg-config --cflags libmicrohttpd))$(web_cflags)
$(build)/obj/web/%.o: private own_cflags = $(web_cflags)

# Rebuilds everything when the compiler or its flags change. Everything that is compiled depends on it, so that it
# also waits for what `make setup all` installs.
.PHONY: always
flags_text = $(subst ','\'',$(filter-out -Werror,$(CC) $(all_cflags) $(isas_flags)))
$(build)/flags: always | $(call requested,setup%)
	@mkdir -p $(@D)
	@echo '$(flags_text)' | cmp -s - $@ || echo '$(flags_text)' >$@

include mk/install.mk mk/tests.mk mk/check.mk mk/doc.mk mk/wasm.mk mk/bench.mk mk/experiments.mk

compiled_objects := $(library_objects) $(program_objects) $(web_objects) $(mpi_objects) $(importer_objects) \
  $(replayed) $(fuzzed_objects)
-include $(compiled_objects:.o=.d) $(test_dependencies) $(addsuffix .d,$(fuzzers) $(build)/tests/power/reader \
  $(build)/peers/embree $(build)/account_keys)

# For clangd and other tools that parse C: all C files, with the flags of this configuration.
.PHONY: compiled compile_commands.json
by_scripts := $(filter-out %/recheck.c,$(wildcard tests/tools/*.c)) \
  $(wildcard experiments/engine/*.c tests/faults/*.c tests/power/*.c)
compiled: all peers $(mpi_objects) $(test_programs) $(benches) $(build)/tests/recheck $(fuzzers) \
  $(by_scripts:%.c=$(build)/by-scripts/%.o)
$(build)/by-scripts/%.o: %.c $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(all_cflags) $(pkg_cflags) -c -o $@ $<
## compile_commands.json: the compilation database for clangd
compile_commands.json:
	@MAKE='$(MAKE)' .ci/compile_commands $@ build=$(build) compiled

.PHONY: format clean distclean help
## format: lay out C, shell and, after setup-web, the page
format:
	@tests/source/format.sh --write $(build)/web-tests
## clean, distclean: remove the build folder; also tables and figures
clean:
	rm -rf $(build)
distclean: clean
	rm -rf build $(RESULTS)/tables $(RESULTS)/figures
	@test ! -f paper/Makefile || $(MAKE) -C paper clean
help:
	@echo 'make [config=NAME] [CC=clang] [V=1] TARGET...; CONTRIBUTING.md says more'
	@sed -n 's/^## \([^:]*\): /\1\t/p' $(filter-out %.d,$(MAKEFILE_LIST)) | expand -t 24
