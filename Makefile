# facet. `make help` says what can be made; README.md says what for.

BUILD   ?= build
PREFIX  ?= /usr/local
CFLAGS  ?= -O2
AR      ?= ar
RUN     ?=

VERSION := $(shell sed -n 's/.*FACET_VERSION_[MP][A-Z]* //p' src/facet.h | paste -sd.)
SONAME  := libfacet.so.$(firstword $(subst ., ,$(VERSION)))
MACHINE := $(firstword $(subst -, ,$(shell $(CC) -dumpmachine)))

# ---- What is built: an architecture is arch/NAME.h, a row in src/arches.def, and its flags here -----------------------

FLAGS.sse41  := -msse4.1
FLAGS.avx2   := -mavx2 -mfma
FLAGS.avx512 := -mavx512f -mavx512vl -mavx512dq -mavx512bw -mprefer-vector-width=512

ARCHES.x86_64  := scalar sse2 sse41 avx2 avx512
ARCHES.aarch64 := scalar neon

ARCHES ?= $(or $(ARCHES.$(MACHINE)),scalar)
TIERS  ?= fast strict
# Words of src/models.def: build these alone. Empty: all.
MODELS ?=

# One short line a file; V=1 shows the commands.
say = $(if $(V),,@printf '  %s\n' $@; )

WARN   := -Wall -Wextra -Wconversion -Wshadow
COMMON := -std=gnu11 -ffp-contract=off $(WARN) -MMD -MP
# The library calls nothing, not even memcpy: freestanding, and no loop becomes a call.
LIBRARY := $(COMMON) -fPIC -fvisibility=hidden -ffreestanding -fno-math-errno -fno-trapping-math \
    $(if $(findstring clang,$(shell $(CC) --version)),,-fno-tree-loop-distribute-patterns) \
    $(ARCHES:%=-DFACET_ARCH_%=1) $(TIERS:%=-DFACET_TIER_%=1) \
    $(if $(MODELS),-DFACET_FILTERED $(patsubst %,-DFACET_WITH_%=1,none $(subst -,_,$(MODELS))))

SOURCES := cpu describe encode kernels plan shade words
KERNELS := $(foreach arch,$(ARCHES),$(TIERS:%=f32_$(arch)_%))
OBJECTS := $(SOURCES:%=$(BUILD)/obj/%.o) $(KERNELS:%=$(BUILD)/obj/%.o)

.PHONY: all help demo bench check deps install uninstall clean FORCE
.DELETE_ON_ERROR:

all: $(BUILD)/libfacet.a $(BUILD)/libfacet.so $(BUILD)/facet.pc ## the library, static and shared

# Changes when the compiler or the flags do; all objects depend on it.
$(BUILD)/flags: FORCE
	@mkdir -p $(@D)
	@echo '$(CC) $(CFLAGS) $(LDFLAGS) $(ARCHES) $(TIERS) $(MODELS)' | cmp -s - $@ || \
	    echo '$(CC) $(CFLAGS) $(LDFLAGS) $(ARCHES) $(TIERS) $(MODELS)' > $@

$(BUILD)/obj/%.o: src/%.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say)$(CC) $(LIBRARY) $(CPPFLAGS) $(CFLAGS) -c $< -o $@

# f32_ARCH_TIER.o: one kernel.
part = $(word $1,$(subst _, ,$*))
KERNEL_FLAGS = $(FLAGS.$(call part,1)) -DFACET_STRICT=$(if $(filter strict,$(call part,2)),1,0) \
    -DFACET_ARCH_HEADER='"$(or $(HEADER.$(call part,1)),../arch/$(call part,1).h)"'

$(BUILD)/obj/f32_%.o: src/kernel_f32.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say)$(CC) $(LIBRARY) $(CPPFLAGS) $(CFLAGS) $(KERNEL_FLAGS) -DFACET_KERNEL=facet_f32_$* -c $< -o $@

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

DEMO := demo mesh teapot raster image

$(BUILD)/facet-demo: $(DEMO:%=$(BUILD)/bench/%.o) $(BUILD)/libfacet.a
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

demo: $(BUILD)/facet-demo ## shades a teapot into build/teapot.png and times every architecture
	$(RUN) $(BUILD)/facet-demo -o $(BUILD)/teapot.png

# ---- Tests -----------------------------------------------------------------------------------------------------------

SUITES := harness cases reference samples ops api encode accuracy stability physics agreement golden environment
OPS    := $(foreach arch,$(ARCHES),$(TIERS:%=ops_$(arch)_%))

# ops_ARCH_TIER.o: the vector layer's operations as functions.
$(BUILD)/tests/ops_%.o: tests/ops_arch.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say)$(CC) $(PROGRAM) $(CPPFLAGS) $(CFLAGS) $(KERNEL_FLAGS) -DOPS_TABLE=ops_$* -c $< -o $@

$(BUILD)/facet-check: $(SUITES:%=$(BUILD)/tests/%.o) $(OPS:%=$(BUILD)/tests/%.o) $(BUILD)/libfacet.a
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm -lpthread

OPENEXR := $(shell pkg-config --libs OpenEXR 2>/dev/null)

$(BUILD)/tests/relight.o $(BUILD)/tests/exr.o: PROGRAM += $(shell pkg-config --cflags OpenEXR 2>/dev/null)

$(BUILD)/relight: $(BUILD)/tests/relight.o $(BUILD)/tests/exr.o $(BUILD)/libfacet.a
	$(say)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(OPENEXR) -lm

help: ## lists the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(firstword $(MAKEFILE_LIST)) | expand -t 12
	@echo
	@echo 'CC= CFLAGS= BUILD= PREFIX= DESTDIR= RUN= (an emulator) V=1 (show commands)'
	@echo 'ARCHES="scalar ..." TIERS="fast strict" MODELS="lambert ..." build less'

-include $(wildcard $(BUILD)/*/*.d)
