# Benchmarks, and what they compare with. Included by the Makefile.

# The programs that the benchmarks compare with: the report's algorithm, which needs only a compiler, and Embree if
# installed. The program that calls Embree is compiled for the machine that it runs on.
report_sources := $(wildcard experiments/peers/report/*.[ch])
.PHONY: peers
## peers: programs that the benchmarks compare with
peers: $(build)/peers/report $(build)/libcuvette.a
	@$(if $(embree),$(MAKE) --no-print-directory build=$(build) $(build)/peers/embree)
$(build)/peers/report: $(report_sources) $(build)/flags
	$(call say,$(CC) experiments/peers/report)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(all_cflags) -o $@ $(filter %.c,$^) $(LDFLAGS) -lm -pthread
$(build)/peers/embree: experiments/peers/embree.c $(build)/libcuvette.a $(build)/flags
	$(call say,$(CC) $<)
	@mkdir -p $(@D)
	$(quiet)$(CC) $(all_cflags) -march=native -MMD -MP -o $@ $< $(build)/libcuvette.a $(LDFLAGS) -lembree3 \
	  $(all_libs)

# The build by clang, if it is installed and another compiler made this one.
bench_clang = $(if $(clang),,$(shell command -v clang >/dev/null && echo $(build)/by-clang/cuvette))
## bench: frames and rays as ratios to other programs
.PHONY: bench
bench: all peers $(build)/tests/bench_mesh $(build)/tests/bench_rows
	@$(MAKE) --no-print-directory config=nocounters build=$(build)/nocounters $(build)/nocounters/cuvette
	@$(if $(bench_clang),$(MAKE) --no-print-directory CC=clang build=$(build)/by-clang $(build)/by-clang/cuvette)
	CUVETTE='$(build)/cuvette' NOCOUNTERS='$(build)/nocounters/cuvette' CLANG='$(bench_clang)' experiments/bench.sh \
	  frames outside solids lights slime processes rays paths rows

# What the same bits everywhere cost (experiments/determinism.sh): the program without parts of that, in build/variants,
# FILM-CONTRACT-COMPILER. Sums of the film fixed or float (render/plan/film.h); products and sums of the kernels
# contracted (fast) to FMA, which SSE2 does not have, or not (off). gcc or clang compiles the kernels and what writes
# the film; all else is that of $(build).
.PHONY: variants
VARIANTS ?= $(foreach compiler,gcc clang,$(addsuffix -$(compiler),fixed-off fixed-fast float-off float-fast))
in_tracer := src/optics/% src/geometry/% src/render/%
tracer := $(filter $(in_tracer),$(library))
tracer_kernels := $(filter $(in_tracer),$(kernels))
film_users = $(eval film_users := $$(shell \
  grep -lE 'film_(sum|units|add|radiance)' $$(tracer) $$(tracer_kernels)))$(film_users)
## variants: the program without what makes the same bits
variants: $(VARIANTS:%=$(build)/variants/%/cuvette) $(build)/cuvette-import
variant_cflags = $(patsubst -ffp-contract=%,-ffp-contract=$(1),$(code_flags)) -g0 -w -MMD -MP
# $(1): its name; $(2): compiler; $(3): contract; $(4): flags of the film. Objects replace those of the library after
# them.
define variant_rules
variant_objects_$(1) := $$(patsubst src/%.c,$$(build)/variants/$(1)/%.o,src/base/build_id.c \
  $$(filter-out %_kernel.c,$$(film_users))) \
  $$(foreach i,$$(isas),$$(patsubst src/%.c,$$(build)/variants/$(1)/%.$$(i).o,$$(filter %_kernel.c,$$(film_users)))) \
  $(if $(filter off-$(notdir $(CC)),$(3)-$(2)),,$$(foreach i,$$(isas),$$(patsubst \
  src/%.c,$$(build)/variants/fixed-$(3)-$(2)/%.$$(i).o,$$(filter-out $$(film_users),$$(tracer_kernels)))))
$$(build)/variants/$(1)/%.o: src/%.c $$(build)/flags
	$$(call say,$(2) $$< for $(1))
	@mkdir -p $$(@D)
	$$(quiet)$(2) $$(call variant_cflags,off) $(4) -DCUVETTE_BUILD_ID='"$(1)"' -c -o $$@ $$<
$$(build)/variants/$(1)/cuvette: $$(program_objects) $$(build)/libweb.a $$(variant_objects_$(1)) $$(build)/libcuvette.a
	$$(call say,link $$@)
	$$(quiet)$$(CC) $$(all_cflags) -o $$@ $$^ $$(LDFLAGS) $$(program_libs)
-include $$(variant_objects_$(1):.o=.d)
endef
# $(1): its name; $(2): compiler; $(3): instruction set; $(4): contract; $(5): flags of the film
define variant_kernel_rule
$$(build)/variants/$(1)/%_kernel.$(3).o: src/%_kernel.c $$(build)/flags
	$$(call say,$(2) $$< for $(1) $(3))
	@mkdir -p $$(@D)
	$$(quiet)$(2) $$(call variant_cflags,$(4)) $$(isa_flags_$(3)) $$(if $$(filter fast-avx2,$(4)-$(3)),-mfma) $(5) \
	  -DKERNEL_ISA=$(3) -c -o $$@ $$<
endef
variant_part = $(word $(2),$(subst -, ,$(1)))
variant_film = $(if $(filter float-%,$(1)),-DCUVETTE_FILM_FLOAT=1)
ifneq ($(call requested,variants),)
variant_names := $(sort $(VARIANTS) $(VARIANTS:float-%=fixed-%))
$(foreach v,$(variant_names),$(eval $(call \
  variant_rules,$(v),$(call variant_part,$(v),3),$(call variant_part,$(v),2),$(call variant_film,$(v)))))
$(foreach v,$(variant_names),$(foreach i,$(isas),$(eval $(call \
  variant_kernel_rule,$(v),$(call variant_part,$(v),3),$(i),$(if $(filter sse2,$(i)),off,$(call \
  variant_part,$(v),2)),$(call variant_film,$(v))))))
endif

# cuvette-mpi's loops on simulated clusters (experiments/cluster/simulated): src/mpi/messenger.c and handout.c as they
# are, by SimGrid's compiler; and by OpenMPI's the same without tracing, whose time is that of the messages. All are
# built at once.
.PHONY: simulated simulate-mpi
simulated_folder := experiments/cluster/simulated
simulated_sources := $(wildcard $(simulated_folder)/*.c) src/mpi/handout.c src/render/plan/schedule.c \
  src/base/status.c src/base/cancel.c
simulated_flags = -std=gnu17 -D_GNU_SOURCE -O2 -g $(filter -W%,$(all_cflags)) -Isrc -I$(simulated_folder)
simulated: $(build)/cluster/simulated
$(build)/cluster/simulated: private compiler = smpicc -DSIMULATED
$(build)/cluster/messages: private compiler = mpicc
$(build)/cluster/simulated $(build)/cluster/messages: $(simulated_sources) $(wildcard $(simulated_folder)/*.h) \
  src/mpi/messenger.c $(wildcard src/mpi/*.h) $(build)/flags
	$(call say,$(firstword $(compiler)) $(simulated_folder))
	@mkdir -p $(@D)
	$(quiet)$(compiler) $(simulated_flags) -DMESSAGES_ARE_KEPT -include simulated_mpi.h \
	  -c -o $@-messenger.o src/mpi/messenger.c
	$(quiet)$(compiler) $(simulated_flags) -o $@ $(filter-out %/messenger.c,$(filter %.c,$^)) $@-messenger.o -lm
## simulate-mpi: clusters of 1 to 4096 ranks (half an hour)
simulate-mpi: simulated
	TABLE='$(abspath $(RESULTS))/cluster.csv' $(simulated_folder)/study.sh
