# facet. `make help` says what can be made; README.md says what for.

BUILD   ?= build
PREFIX  ?= /usr/local
CFLAGS  ?= -O3
AR      ?= ar
MAKEFLAGS += --no-builtin-rules
RUN     ?=

VERSION := $(shell sed -n 's/.*FACET_VERSION_[MP][A-Z]* //p' src/facet.h | paste -sd.)
SONAME  := libfacet.so.$(firstword $(subst ., ,$(VERSION)))
MACHINE := $(firstword $(subst -, ,$(shell $(CC) -dumpmachine)))

# ---- What is built: an architecture is arch/NAME.h, a row in src/arches.def, and its flags here ----------------------

FLAGS.sse41  := -msse4.1
FLAGS.avx2   := -mavx2 -mfma -mf16c
FLAGS.avx512 := -mavx512f -mavx512vl -mavx512dq -mavx512bw -mprefer-vector-width=512

# How gcc orders a kernel's instructions: for latency before registers are handed out, while they suffice: 2 to 9 %.
# SSE's overwrite an operand: with other registers they can be ordered once more, 4 to 22 %. What has SSE4.1 and no AVX2
# is a Silvermont or the like; to let its latencies order them takes 17 % from tile's cycles on x86-64, by llvm-mca.
TUNE.avx2   := -fschedule-insns -fsched-pressure
TUNE.avx512 := $(TUNE.avx2)
TUNE.sse2   := $(TUNE.avx2) -frename-registers
TUNE.sse41  := -fschedule-insns -frename-registers -mtune=silvermont

ARCHES.x86_64  := scalar sse2 sse41 avx2 avx512
ARCHES.aarch64 := scalar neon

ARCHES ?= $(or $(ARCHES.$(MACHINE)),scalar)
TIERS  ?= fast strict
# Words of src/models.def, and packed for packed streams: build these alone. Empty: all.
MODELS ?=

# One short line a file; V=1 shows the commands.
say = $(if $(V),,@printf '  %s\n' $@; )

WARN   := -Wall -Wextra -Wconversion -Wshadow
COMMON := -std=gnu11 -ffp-contract=off $(WARN) -MMD -MP
# The library calls nothing, not even memcpy: freestanding, and no loop becomes a call.
CLANG_BUILT := $(findstring clang,$(shell $(CC) --version))
LIBRARY := $(COMMON) -fPIC -fvisibility=hidden -ffreestanding -fno-math-errno -fno-trapping-math \
    $(if $(CLANG_BUILT),,-fno-tree-loop-distribute-patterns) \
    $(ARCHES:%=-DFACET_ARCH_%=1) $(TIERS:%=-DFACET_TIER_%=1) \
    $(if $(MODELS),-DFACET_FILTERED $(patsubst %,-DFACET_WITH_%=1,none $(subst -,_,$(MODELS))))

SOURCES := convert cpu describe encode fit kernels metals plan shade words
KERNELS := $(foreach arch,$(ARCHES),$(TIERS:%=f32_$(arch)_%))
OBJECTS := $(SOURCES:%=$(BUILD)/obj/%.o) $(KERNELS:%=$(BUILD)/obj/%.o)

.PHONY: all help demo bench chart check deps install uninstall clean FORCE
.DELETE_ON_ERROR:

all: $(BUILD)/libfacet.a $(BUILD)/libfacet.so $(BUILD)/facet.pc ## the library, static and shared

BUILT_WITH = $(CC) $(LIBRARY) $(CPPFLAGS) $(CFLAGS) $(LDFLAGS) \
    $(foreach arch,$(ARCHES),$(arch) $(FLAGS.$(arch)) $(TUNE.$(arch)))

# Changes when the compiler or the flags do; all objects depend on it.
$(BUILD)/flags: FORCE
	@mkdir -p $(@D)
	@echo '$(BUILT_WITH)' | cmp -s - $@ || echo '$(BUILT_WITH)' > $@

# -O3 is for what is called often.
$(BUILD)/obj/%.o: src/%.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say)$(CC) $(LIBRARY) $(CPPFLAGS) $(if $(filter shade encode,$*),$(CFLAGS),$(CFLAGS:-O3=-Os)) -c $< -o $@

# f32_ARCH_TIER.o: one kernel.
part = $(word $1,$(subst _, ,$*))
KERNEL_FLAGS = $(FLAGS.$(call part,1)) -DFACET_STRICT=$(if $(filter strict,$(call part,2)),1,0) \
    -DFACET_ARCH_HEADER='"$(or $(HEADER.$(call part,1)),../arch/$(call part,1).h)"'

$(BUILD)/obj/f32_%.o: src/kernel_f32.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say)$(CC) $(LIBRARY) $(CPPFLAGS) $(CFLAGS) $(KERNEL_FLAGS) $(if $(CLANG_BUILT),,$(TUNE.$(call part,1))) \
	    -DFACET_KERNEL=facet_f32_$* -c $< -o $@

$(BUILD)/libfacet.a: $(OBJECTS)
	@rm -f $@
	$(say)$(AR) rcs $@ $^

$(BUILD)/$(SONAME): $(OBJECTS)
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -shared -Wl,-soname,$(SONAME) -o $@ $^

$(BUILD)/libfacet.so: $(BUILD)/$(SONAME)
	@ln -sf $(SONAME) $@

$(BUILD)/facet.pc: $(BUILD)/flags src/facet.h
	@printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$${prefix}/lib' 'includedir=$${prefix}/include' '' 'Name: facet' \
	    'Description: shades batches of surface samples' 'Version: $(VERSION)' \
	    'Libs: -L$${libdir} -lfacet' 'Cflags: -I$${includedir}' > $@

# ---- Programs: they see src/facet.h alone ----------------------------------------------------------------------------

PROGRAM := $(COMMON) -Isrc

$(BUILD)/bench/%.o: bench/%.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say)$(CC) $(PROGRAM) $(CPPFLAGS) $(CFLAGS) -c $< -o $@

$(BUILD)/tests/%.o: tests/%.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say)$(CC) $(PROGRAM) $(CPPFLAGS) $(CFLAGS) -c $< -o $@

# Option words, which facet-demo and relight share.
WORDS := shading_options model_words command_line console
DEMO  := demo demo_options $(WORDS) shading_rate workers balls rigs mesh obj teapot raster image

$(BUILD)/bench/workers.o: PROGRAM += -pthread

$(BUILD)/facet-demo: $(DEMO:%=$(BUILD)/bench/%.o) $(BUILD)/libfacet.a
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -pthread -o $@ $^ -lm

demo: $(BUILD)/facet-demo ## shades a teapot into build/teapot.png and times every architecture
	$(RUN) $(BUILD)/facet-demo -o $(BUILD)/teapot.png

# ---- Benchmark -------------------------------------------------------------------------------------------------------

# The baselines, compiled as a user would compile them, by each compiler that is here, at each width that the CPU has:
# where what is built runs here.
GCC   ?= $(shell command -v gcc)
CLANG ?= $(firstword $(foreach c,clang clang-19 clang-14,$(shell command -v $c)))
ISPC  ?= $(shell command -v ispc)
HERE  := $(if $(RUN),,$(filter $(MACHINE),$(shell uname -m)))
MORE  := $(if $(filter x86_64,$(HERE)),$(shell $(CC) -march=native -dM -E -x c /dev/null | grep -c __AVX512F__))
BITS  := $(if $(MORE),256 $(if $(filter-out 0,$(MORE)),512),128)

COMPILER.gcc   := $(GCC)
COMPILER.clang := $(CLANG)
VECTORIZED := $(if $(HERE),$(foreach c,gcc clang,$(if $(COMPILER.$c),$(BITS:%=$c_%))))
EXPLICIT   := $(if $(HERE),$(if $(ISPC),ispc))
BASELINES  := literal $(VECTORIZED) $(EXPLICIT)
SKIPPED    := $(if $(HERE),$(if $(GCC),,"gcc: none here") $(if $(CLANG),,"clang: none here") \
    $(if $(ISPC),,"ispc: none here"),"all but literal: built for another machine")

# Changes when what facet-bench is made of does.
$(BUILD)/bench/built.def: FORCE
	@mkdir -p $(@D)
	@{ echo '/* What facet-bench was built with; the Makefile writes it. $(GCC) $(CLANG) $(ISPC) */'; \
	    for macro in BASELINE PEAKS SKIPPED; do printf '%s\n' "#ifndef $$macro" "#define $$macro(...)" '#endif'; done; \
	    printf 'BASELINE(%s)\n' $(BASELINES); printf 'PEAKS(%s)\n' $(ARCHES); \
	    $(if $(strip $(SKIPPED)),printf 'SKIPPED("%s")\n' $(SKIPPED);) \
	    printf '#undef %s\n' BASELINE PEAKS SKIPPED; } > $@.new
	@cmp -s $@.new $@ || cp $@.new $@

NATIVE = -std=gnu11 $(WARN) -MMD -MP -Isrc -O3 -ffast-math -march=native
WIDTH  = $(if $(filter x86_64,$(HERE)),-mprefer-vector-width=$(call part,2))

$(BUILD)/bench/vectorized_%.o: bench/autovectorized.c $(BUILD)/bench/built.def
	@mkdir -p $(@D)
	$(say)$(COMPILER.$(call part,1)) $(NATIVE) $(WIDTH) -DBASELINE=baseline_$* \
	    -DBASELINE_NAME='"$(subst _,-,$*)"' -DBASELINE_BITS=$(call part,2) -c $< -o $@

$(BUILD)/bench/tile_ispc.o: bench/tile.ispc $(BUILD)/bench/built.def
	@mkdir -p $(@D)
	$(say)$(ISPC) -O3 --opt=fast-math --pic $< -o $@

$(BUILD)/bench/textbook.o: override CFLAGS += -O2
$(BUILD)/bench/ispc.o: PROGRAM += -DBASELINE_BITS=$(lastword $(BITS))
BASELINE_OBJECTS := textbook $(VECTORIZED:%=vectorized_%) $(EXPLICIT:%=ispc tile_ispc)

# What an architecture's vectors do at best.
FLAGS_PEAK.scalar := -DPEAK_SCALAR -fno-tree-vectorize -fno-tree-slp-vectorize

$(BUILD)/bench/peaks_%.o: bench/peaks_arch.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say)$(CC) $(PROGRAM) $(CPPFLAGS) $(CFLAGS) -O3 -ffp-contract=fast -fno-math-errno -fno-trapping-math \
	    $(FLAGS.$*) $(FLAGS_PEAK.$*) -DPEAK_TABLE=peaks_$* -DPEAK_ARCH='"$*"' -c $< -o $@

BENCH := bench $(addprefix bench_,contenders errors machine options report results rounds series streams work) \
    command_line console $(ARCHES:%=peaks_%) $(BASELINE_OBJECTS)

BUILT := $(addprefix $(BUILD)/,bench/bench_contenders.o bench/bench_machine.o tests/baselines.o)
$(BUILT): $(BUILD)/bench/built.def
$(BUILT): PROGRAM += -I$(BUILD)/bench
$(BUILD)/bench/bench_results.o: PROGRAM += -DBENCH_CFLAGS='"$(CFLAGS)"'

$(BUILD)/facet-bench: $(BENCH:%=$(BUILD)/bench/%.o) $(BUILD)/tests/cases.o $(BUILD)/libfacet.a
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

# The baselines' errors, by the tests' reference.
ERRORS := $(addprefix tests/,baselines bounds cases packed_samples random reference samples unpack) \
    $(addprefix bench/,bench_work $(BASELINE_OBJECTS))

$(BUILD)/baseline-errors: $(ERRORS:%=$(BUILD)/%.o) $(BUILD)/libfacet.a
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$(BUILD)/baselines.tsv: $(BUILD)/baseline-errors tests/accuracy.tsv
	@$(RUN) $< tests > $@.new && mv $@.new $@

bench: $(BUILD)/facet-bench $(BUILD)/baselines.tsv ## times the kernels and the baselines, interleaved
	$(RUN) $(BUILD)/facet-bench --errors tests/accuracy.tsv,$(BUILD)/baselines.tsv

# ---- Charts: speed against accuracy ----------------------------------------------------------------------------------

# Files of facet-bench --tsv, measured here or elsewhere; empty: measures this machine first, for some minutes.
CHART ?=
CHARTS := $(BUILD)/chart
DRAWS  := chart chart_data chart_parts chart_scatter chart_speed chart_models chart_arches chart_failures chart_page \
    axis labels svg tsv console

$(BUILD)/facet-chart: $(DRAWS:%=$(BUILD)/bench/%.o)
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$(BUILD)/model-errors: $(patsubst %,$(BUILD)/tests/%.o,model_errors random reference) $(BUILD)/libfacet.a
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$(CHARTS)/errors.tsv: $(BUILD)/model-errors
	@mkdir -p $(@D)
	$(RUN) $< > $@

$(CHARTS)/bench.tsv: $(BUILD)/facet-bench $(BUILD)/baselines.tsv FORCE
	@mkdir -p $(@D)
	$(RUN) $< --all --seconds 300 --errors tests/accuracy.tsv,$(BUILD)/baselines.tsv --tsv $@

chart: $(BUILD)/facet-chart $(CHARTS)/errors.tsv $(if $(CHART),,$(CHARTS)/bench.tsv) ## draws build/chart/index.html
	$(RUN) $< --errors $(CHARTS)/errors.tsv -o $(CHARTS) $(or $(CHART),$(CHARTS)/bench.tsv)

# ---- Tests -----------------------------------------------------------------------------------------------------------

# facet-check is every file of tests/ but other programs' and *_arch.c, which are compiled for each kernel.
SUITES := $(filter-out baselines consumer cost exr exr_variants filtered metals_table model_errors %_arch \
    readme_tables relight, $(patsubst tests/%.c,%,$(sort $(wildcard tests/*.c))))
LAYERS := $(foreach arch,$(ARCHES),$(foreach layer,ops elementary fits,$(TIERS:%=$(layer)_$(arch)_%)))

# An emulator seldom finds the shared libraries of the other machine.
$(addprefix $(BUILD)/,facet-bench baseline-errors facet-check facet-demo metals-table readme-tables): \
    private LDFLAGS += $(if $(RUN),-static)

# ops_ARCH_TIER.o: the vector layer's operations as functions.
$(BUILD)/tests/ops_%.o: tests/ops_arch.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say)$(CC) $(PROGRAM) $(CPPFLAGS) $(CFLAGS) $(KERNEL_FLAGS) -DOPS_TABLE=ops_$* -c $< -o $@

# elementary_ARCH_TIER.o: the functions made of them.
$(BUILD)/tests/elementary_%.o: tests/elementary_arch.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say)$(CC) $(PROGRAM) $(CPPFLAGS) $(CFLAGS) $(KERNEL_FLAGS) -DELEMENTARY_TABLE=elementary_$* -c $< -o $@

# fits_ARCH_TIER.o: fitted Fresnel terms as functions.
$(BUILD)/tests/fits_%.o: tests/fits_arch.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say)$(CC) $(PROGRAM) $(CPPFLAGS) $(CFLAGS) $(KERNEL_FLAGS) -DFITS_FUNCTION=fits_$* -c $< -o $@

$(BUILD)/facet-check: $(SUITES:%=$(BUILD)/tests/%.o) $(LAYERS:%=$(BUILD)/tests/%.o) $(BUILD)/libfacet.a
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm -lpthread

# Asked for when it is needed, as `make deps` may have come first.
$(BUILD)/tests/relight.o $(BUILD)/tests/exr.o: PROGRAM = $(COMMON) -Isrc $(shell pkg-config --cflags OpenEXR)

$(BUILD)/relight: $(BUILD)/tests/relight.o $(BUILD)/tests/exr.o $(WORDS:%=$(BUILD)/bench/%.o) $(BUILD)/libfacet.a
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(shell pkg-config --libs OpenEXR) -lm

check: ## every test that this machine can run; `make deps check` leaves none out
	@MAKE='$(MAKE_COMMAND)' CC='$(CC)' CFLAGS='$(CFLAGS)' CPPFLAGS='$(CPPFLAGS)' LDFLAGS='$(LDFLAGS)' RUN='$(RUN)' \
	    sh tests/run.sh '$(BUILD)'

update: $(BUILD)/facet-check ## measures tests/accuracy.tsv and tests/golden.txt anew
	$(RUN) $(BUILD)/facet-check --update accuracy golden

# What a sample costs, in instructions and cycles.
$(BUILD)/facet-cost: $(BUILD)/tests/cost.o $(BUILD)/tests/cases.o $(BUILD)/libfacet.a
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^

cost = MAKE='$(MAKE_COMMAND)' CC='$(CC)' CFLAGS='$(CFLAGS)' MODELS='$(MODELS)' RUN='$(RUN)' sh tests/cost.sh '$(BUILD)'

check-cost: $(BUILD)/facet-cost ## whether a sample costs more than tests/cost.tsv says
	@$(cost)

update-cost: $(BUILD)/facet-cost ## measures tests/cost.tsv anew
	@$(cost) update

$(BUILD)/metals-table: $(BUILD)/tests/metals_table.o $(BUILD)/tests/spectra.o $(BUILD)/libfacet.a
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^

metals: $(BUILD)/metals-table ## writes src/metals.def anew from tests/data/metals
	@$(RUN) $< tests/data/metals > $(BUILD)/metals.def
	@cmp -s $(BUILD)/metals.def src/metals.def || cp $(BUILD)/metals.def src/metals.def

# README's tables between <!-- NAME --> and <!-- /NAME -->.
README := README.md

$(BUILD)/readme-tables: $(BUILD)/tests/readme_tables.o
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^

readme: $(BUILD)/readme-tables ## writes README.md's tables anew from src/*.def
	@$(RUN) $< '$(README)' $(foreach f,$(filter FLAGS.%,$(.VARIABLES)),'$(f:FLAGS.%=%)=$($f)') > $(BUILD)/README.md
	@cmp -s $(BUILD)/README.md '$(README)' || cp $(BUILD)/README.md '$(README)'

# ---- What the tests need ---------------------------------------------------------------------------------------------

DEBIAN := binutils gcc gcc-12 gcc-11 g++ clang-14 clang-19 libc6-dev pkgconf libopenexr-dev gzip qemu-user \
    gcc-aarch64-linux-gnu libc6-dev-arm64-cross gcc-arm-linux-gnueabihf libc6-dev-armhf-cross \
    gcc-s390x-linux-gnu libc6-dev-s390x-cross gcc-riscv64-linux-gnu libc6-dev-riscv64-cross valgrind llvm-19

# What it installs decides how the rest is built: with it among the goals they run one after the other, in their order.
ifneq ($(filter deps,$(MAKECMDGOALS)),)
.NOTPARALLEL:
endif

deps: ## installs the Debian packages that `make check` and check-cost can use
	@command -v apt-get > /dev/null || { echo 'make deps: no apt-get here; the packages are: $(DEBIAN)' >&2; exit 1; }
	@missing=; for package in $(DEBIAN); do \
	    dpkg-query -W -f '$${Status}' $$package 2> /dev/null | grep -q ' installed' || missing="$$missing $$package"; \
	done; \
	[ -z "$$missing" ] && exit; \
	as_root=$$([ "$$(id -u)" = 0 ] || echo sudo); echo "installing$$missing"; \
	$$as_root apt-get -qq update && \
	$$as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends $$missing > /dev/null

# ---- Install ---------------------------------------------------------------------------------------------------------

TO    = $(DESTDIR)$(PREFIX)
FILES = include/facet.h lib/libfacet.a lib/libfacet.so lib/$(SONAME) lib/libfacet.so.$(VERSION) lib/pkgconfig/facet.pc

install: all ## into DESTDIR and PREFIX
	install -d '$(TO)/include' '$(TO)/lib/pkgconfig'
	install -m 644 src/facet.h '$(TO)/include'
	install -m 644 $(BUILD)/libfacet.a '$(TO)/lib'
	install -m 755 $(BUILD)/$(SONAME) '$(TO)/lib/libfacet.so.$(VERSION)'
	ln -sf libfacet.so.$(VERSION) '$(TO)/lib/$(SONAME)'
	ln -sf $(SONAME) '$(TO)/lib/libfacet.so'
	sed 's|^prefix=.*|prefix=$(PREFIX)|' $(BUILD)/facet.pc > '$(TO)/lib/pkgconfig/facet.pc'

uninstall: ## removes what install put there
	rm -f $(FILES:%='$(TO)/%')

clean: ## removes what was built
	rm -rf '$(BUILD)'

.PHONY: check-cost metals readme update update-cost

help: ## lists the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(firstword $(MAKEFILE_LIST)) | expand -t 12
	@echo
	@echo 'CC= CFLAGS= BUILD= PREFIX= DESTDIR= RUN= (an emulator) V=1 (show commands)'
	@echo 'ARCHES="scalar ..." TIERS="fast strict" MODELS="lambert ..." build less'
	@echo 'CHART="a.tsv ..." charts what facet-bench --tsv wrote on these machines'

-include $(wildcard $(BUILD)/*/*.d)
