# Instruction sets and other architectures. Included by the Makefile.

# One source for all instruction sets of the architecture (src/base/isa.h): *_kernel.c is compiled once for each.
isa_flags_sse2   := -msse2
isa_flags_avx2   := -mavx2
isa_flags_avx512 := -mavx512f -mavx512dq -mavx512bw -mavx512vl -mprefer-vector-width=512
isas = $(eval isas := $$(call isas_of,$$(shell $$(CC) -dumpmachine)))$(isas)
isas_of = $(if $(filter x86_64-% amd64-%,$(1)),sse2 avx2 avx512,$(if $(filter aarch64-% arm64-%,$(1)),neon,plain))
isas_flags = $(foreach i,$(isas),$(isa_flags_$(i)))
# For scripts that compile kernels.
kernel_environment = KERNEL_FLAGS='$(code_flags) -Wno-psabi' $(foreach i,$(isas),KERNEL_FLAGS_$(i)='$(isa_flags_$(i))')

kernel_objects := $(foreach i,$(isas),$(kernels:src/%.c=$(build)/obj/%.$(i).o))
define kernel_rule
$(build)/obj/%_kernel.$(1).o: src/%_kernel.c $(build)/flags
	$$(call compile,$$(all_cflags) $$(isa_flags_$(1)) -DKERNEL_ISA=$(1), for $(1))
endef
$(foreach i,$(isas),$(eval $(call kernel_rule,$(i))))

.PHONY: vectorise test-arch
## vectorise: report which kernel loops are vectorised
vectorise: $(build)/flags
	@CHECK=1 $(kernel_environment) bash tests/source/vectorise.sh | sed -n 's/^# //p; /^not ok/p'; exit $${PIPESTATUS[0]}

# Debian's cross compilers and qemu-user: arch="s390x" for one of .ci/architectures, SIZE=160x120 for larger films.
## test-arch: arm64, s390x, riscv64: films, files as on this machine
test-arch: $(build)/cuvette $(build)/cuvette-import
	@CUVETTE='$(abspath $(build)/cuvette)' MAKE='$(MAKE)' tests/check/arch.sh $(build)/arch $(arch)
