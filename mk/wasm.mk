# The library and the laboratory as a WebAssembly module, for browsers: build/wasm/simd128 and build/wasm/plain.
# Included by the Makefile. Debian's emscripten compiles it; its libraries come from Debian's source packages.

wasm := build/wasm
EMCC ?= emcc
# Debian's emscripten expects Debian's modules for node, whichever node is installed.
export NODE_PATH := $(if $(NODE_PATH),$(NODE_PATH):)/usr/share/nodejs:/usr/lib/nodejs

# Two modules of one source: a browser without 128-bit vectors refuses a module that has them.
WASM_ISAS ?= simd128 plain
wasm_isas := $(WASM_ISAS)
# Browsers with 128-bit vectors have these too: conversions without a test for traps, copies of memory.
wasm_isa_flags_simd128 := -msimd128 -mnontrapping-fptoint -mbulk-memory -msign-ext

# No studies, which measure a machine, and nothing of the operating system; src/wasm has what replaces them.
wasm_without := src/study/% src/engine/study% src/base/below.c src/base/child.c src/base/os_confine% \
  src/measure/hardware_counter.c src/measure/topology_discover.c src/measure/disturbances.c src/measure/levels.c \
  src/scene/assets/mesh_file.c src/base/worker_pool.c
wasm_web := $(filter-out src/web/http/http.c $(addprefix src/web/http/http_,events.c guard.c library.c request.c \
  send.c watch.c) $(addprefix src/web/api/,api_studies.c api_study_%) \
  $(addprefix src/web/session/,confine.c figures.c rescue.c studies.c study_files.c) \
  src/web/live/render_worker_thread.c,$(web))
wasm_sources := $(filter-out $(wasm_without),$(library)) $(kernels) $(wasm_web) $(filter src/wasm/%,$(sources)) \
  $(filter-out src/import/main.c,$(wildcard src/import/*.c))

wasm_flags = -std=gnu17 -D_GNU_SOURCE -O3 $(arithmetic) -Isrc -I$(wasm)/libraries/include -include src/wasm/lacking.h \
  -DCUVETTE_VERSION='"$(version)"' -DCUVETTE_COMPILER_FLAGS='"wasm: -O3 $(arithmetic)"' \
  $(filter-out -Wvla,$(warnings)) -Wno-enum-float-conversion -Wno-shorten-64-to-32 -Wno-pass-failed $(errors)
wasm_scripts := $(addprefix src/wasm/,memory.js lab_worker.js tile_worker.js worker.js)
wasm_libs := $(addprefix $(wasm)/libraries/lib/lib,png.a jpeg.a OpenEXRCore.a yaml.a jansson.a kissfft.a z.a)

.PHONY: wasm
## wasm: the laboratory as WebAssembly: build/wasm
wasm: $(foreach i,$(wasm_isas),$(wasm)/$(i)/worker.js)

wasm_flags_text = $(subst ','\'',$(EMCC) $(filter-out -Werror,$(wasm_flags)) $(wasm_isa_flags_simd128))
# Compiling would disturb what measures and what has time limits.
wasm_after := setup% test test-mpi test-python experiments bench $(if $(ENGINE),,test-web)
$(wasm)/flags: always | $(call requested,$(wasm_after))
	@command -v $(firstword $(EMCC)) >/dev/null || \
	  { echo 'wasm: emscripten is not installed; run: make setup-wasm' >&2; exit 1; }
	@mkdir -p $(@D)
	@echo '$(wasm_flags_text)' | cmp -s - $@ || echo '$(wasm_flags_text)' >$@
$(wasm)/libraries/complete: src/wasm/libraries.sh | $(wasm)/flags
	$(call say,emcc $(wasm)/libraries)
	$(quiet)src/wasm/libraries.sh $(wasm)/sources $(@D) >$(wasm)/libraries.log 2>&1 || \
	  { tail -n 20 $(wasm)/libraries.log | cut -c 1-300 >&2; exit 1; }
	@touch $@
$(wasm_libs): $(wasm)/libraries/complete

# emcc takes longer to start than to compile most files: one start compiles all changed files of a folder, and all of
# them if a header has changed. build_id.c has flags of its own.
wasm_folders := $(sort $(patsubst src/%/,%,$(dir $(wasm_sources))))
wasm_root := $(CURDIR)
wasm_folder_sources = $(filter-out src/base/build_id.c,$(foreach s,$(wasm_sources),$(if \
  $(filter src/$(1)/,$(dir $(s))),$(s))))
wasm_changed = $(if $(filter-out %.c,$?),$(filter %.c,$^),$(filter %.c,$?))
wasm_absolute = $(subst -Isrc,-I$(wasm_root)/src,$(subst \
  -I$(wasm),-I$(wasm_root)/$(wasm),$(subst src/wasm/,$(wasm_root)/src/wasm/,$(1)))) \
  -fmacro-prefix-map=$(wasm_root)/=

define wasm_folder_rules
$(wasm)/$(1)/obj/$(2)/compiled: $(call wasm_folder_sources,$(2)) $(wasm)/flags $(wasm)/libraries/complete
	$$(call say,emcc src/$(2) for $(1))
	@mkdir -p $$(@D)
	$$(quiet)cd $$(@D) && $(EMCC) $$(call wasm_absolute,$$(wasm_flags)) $(wasm_isa_flags_$(1)) -DKERNEL_ISA=$(1) -MMD -MP \
	  -MT $$@ -c $$(sort $$(abspath $$(wasm_changed)))
	@touch $$@
-include $$(patsubst src/%.c,$(wasm)/$(1)/obj/%.d,$(call wasm_folder_sources,$(2)))
endef

define wasm_rules
wasm_objects_$(1) := $(patsubst src/%.c,$(wasm)/$(1)/obj/%.o,$(wasm_sources))
$(wasm)/$(1)/obj/web/compiled $(wasm)/$(1)/obj/web/%/compiled: private wasm_flags += -include src/wasm/no_threads.h
$(wasm)/$(1)/obj/base/build_id.o: src/base/build_id.c $(build)/build_id $(wasm)/flags $(wasm)/libraries/complete
	@mkdir -p $$(@D)
	$$(quiet)$(EMCC) $$(wasm_flags) $(wasm_isa_flags_$(1)) -DCUVETTE_BUILD_ID='"$$(shell sed -n 1p $(build)/build_id)"' \
	  -DCUVETTE_BUILD_COMMIT='"$$(shell sed 1d $(build)/build_id)"' -c -o $$@ $$<
$(wasm)/$(1)/cuvette.wasm: $(foreach f,$(wasm_folders),$(wasm)/$(1)/obj/$(f)/compiled) \
  $(wasm)/$(1)/obj/base/build_id.o $(wasm_libs) $(wasm)/exports
	$$(call say,link $$@)
	$$(quiet)$(EMCC) -O3 $(wasm_isa_flags_$(1)) $$(wasm_link) -o $$(@:.wasm=.js) $$(wasm_objects_$(1)) $(wasm_libs)
# The script of all workers.
$(wasm)/$(1)/worker.js: $(wasm)/$(1)/cuvette.wasm $(wasm_scripts)
	$$(quiet)cat $(wasm)/$(1)/cuvette.js $(wasm_scripts) >$$@
endef
$(foreach i,$(wasm_isas),$(eval $(call wasm_rules,$(i))))
$(foreach i,$(wasm_isas),$(foreach f,$(wasm_folders),$(eval $(call wasm_folder_rules,$(i),$(f)))))

# Everything that cuvette.h declares, but for studies, and what the scripts of src/wasm call.
$(wasm)/exports: src/cuvette.h src/wasm/exports.h mk/wasm.mk
	@mkdir -p $(@D)
	@{ grep -oh '\bcuvette_[a-z0-9_]*(' src/cuvette.h | grep -v '_study_\|each_column\|each_lens_number\|text_destroy'; \
	  grep -oh '\bwasm_[a-z0-9_]*(' src/wasm/exports.h; echo 'malloc('; echo 'free('; } | sort -u | \
	  sed 's/^/_/; s/($$//' >$@

# Memory grows; a stack as that of a thread. The page compiles the module once for all its workers.
wasm_link = -sEXPORTED_FUNCTIONS=@$(wasm)/exports \
  -sEXPORTED_RUNTIME_METHODS=FS,UTF8ToString,stringToUTF8,lengthBytesUTF8 -sMODULARIZE -sEXPORT_NAME=cuvette \
  -sWASM_BIGINT -sENVIRONMENT=web,worker,node -sALLOW_MEMORY_GROWTH -sMAXIMUM_MEMORY=2GB -sTOTAL_STACK=1MB \
  -sINITIAL_MEMORY=32MB -sALLOW_TABLE_GROWTH -sFILESYSTEM -sERROR_ON_UNDEFINED_SYMBOLS=1 \
  -sINCOMING_MODULE_JS_API=instantiateWasm,print,printErr,locateFile --js-library src/wasm/imports.js

.PHONY: test-wasm bench-wasm
wasm_tests = $(sort $(wildcard tests/wasm/*.test.mjs))
## test-wasm: the WebAssembly modules in node
test-wasm: wasm $(build)/cuvette $(build)/cuvette-import
	@WASM_ISAS='$(wasm_isas)' node --test --test-reporter=tap $(wasm_tests) | node tests/wasm/summary.mjs
## bench-wasm: speed of the modules and the native program
bench-wasm: wasm $(build)/cuvette
	@WASM_ISAS='$(wasm_isas)' node tests/wasm/bench.mjs
