# Tests on machines that are emulated: ARM programs, and whole boards.

# The run-time half on ARM, in an emulator that runs programs: the same tests,
# the same hashes, with models baked here (tests/arm/check).
ARM_TARGETS := aarch64 armv7 armv7-neon armv6-soft
ARM_MODELS  := heliar-tronnier double-gauss-angenieux nikon-zoom-mid
ARM_UNIT := aim arena divide cuts kernels model transfer curve edges resolve composite lamp_finder lamp_shapes flare flare_light flare_room plan account lights scene_draw scene_model scene_rays scene_shade translucent bright match window pass blend star_bits hidden_lamps \
        lamp_tracker lamp_tracker_any quantise pnm y4m y4m_divide output pool measure lamps fourcc panel frame \
        show_lights live_stats live_adapt
# Those that want a model bake it here first, for all.
ARM_BAKES := $(OUT)/tests/unit/test_frame
build/models/%.glint: lenses/%.lens $(OUT)/libglint-bake.a | $(OUT)/glint
	@mkdir -p $(@D)
	$(say) BAKE $@
	$(Q)$(OUT)/glint bake $< --coating table -q -o $@
$(OUT)/scenes: $(OUT)/tests/arm/scenes.o $(OUT)/tests/support/stars/any.o $(libs)
	$(link)
$(OUT)/things: $(OUT)/tests/arm/things.o $(libs)
	$(link)
ARM_SCENES := tools/examples/scenes/shop.scene tools/examples/scenes/ball.scene \
        tools/examples/scenes/brushed.scene tools/examples/scenes/stone.scene \
        tools/examples/scenes/tutorial.scene \
        $(patsubst %,tests/peers/%.scene,mesh phong reflect refract shadow texture)
build/things/%.glint: $(OUT)/glint
	@mkdir -p $(@D)
	$(Q)$(OUT)/glint bake $(filter %/$*.scene,$(ARM_SCENES)) -q -o $@
arm-tests: $(ARM_UNIT:%=$(OUT)/tests/unit/test_%)
check-arm:
	@tools/make/deps "ARM in an emulator" libcmocka-dev gcc-aarch64-linux-gnu libc6-dev-arm64-cross \
	        gcc-arm-linux-gnueabihf libc6-dev-armhf-cross gcc-arm-linux-gnueabi \
	        libc6-dev-armel-cross qemu-user-static debian-archive-keyring
	@$(MAKE) --no-print-directory WERROR=-Werror all $(OUT)/scenes $(OUT)/things $(ARM_BAKES) \
	        $(patsubst %.scene,build/things/%.glint,$(notdir $(ARM_SCENES))) \
	        $(ARM_MODELS:%=build/models/%.glint)
	@set -e; for t in $(ARM_TARGETS); do \
	        $(MAKE) --no-print-directory WERROR=-Werror TARGET=$$t purity \
	                build/$$t/scenes build/$$t/things; done; \
	for t in aarch64 armv7; do s=$$(tests/arm/prepare $$t); \
	        $(MAKE) --no-print-directory WERROR=-Werror TARGET=$$t \
	                SYSROOT=$$s arm-tests glint-live build/$$t/examples/draw_flare; \
	        [ $$t != aarch64 ] || $(MAKE) --no-print-directory WERROR=-Werror \
	                TARGET=$$t SYSROOT=$$s build/$$t/glint; \
	done
	@XDG_CACHE_HOME=$(CURDIR)/build/cache $(ARM_BAKES) >/dev/null 2>&1
	@tests/arm/check $(ARM_MODELS:%=build/models/%.glint) -- $(ARM_UNIT)
# glint on Debian's kernels in an emulator: cameras, panels, ARM. One:
# VMFILTER=aarch64/camera, as tests/vm/check says.
VM_ARCHS ?= x86_64 aarch64 armv7
VM_TOOLS := as bars ctl feed grab vt
vm_cache := $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/glint/vm
$(OUT)/vm/%: tests/vm/programs/%.c tests/vm/programs/device.h tests/vm/programs/layout.h
	@mkdir -p $(@D)
	$(say) CC $<
	$(Q)$(CC) $(CPPFLAGS) -D_POSIX_C_SOURCE=200809L $(CFLAGS) $(LDFLAGS) $< -o $@
# what makes scenes and states what must come of them
$(OUT)/vm/scene: tests/support/rng.h
VM_HOST := scene expected $(if $(filter yes,$(WITH_JPEG)),jpeg)
$(OUT)/vm/jpeg: CPPFLAGS += $(JPEG_CPPFLAGS)
$(VM_HOST:%=$(OUT)/vm/%): $(OUT)/vm/%: tests/vm/programs/%.c tests/vm/programs/layout.h $(libs)
	@mkdir -p $(@D)
	$(say) CC $<
	$(Q)$(CC) $(CPPFLAGS) -Iplatform -D_POSIX_C_SOURCE=200809L $(CFLAGS) \
	        $(LDFLAGS) $< $(libs) $(LDLIBS) -o $@
vm-programs: $(OUT)/glint $(OUT)/glint-live $(VM_TOOLS:%=$(OUT)/vm/%) \
        $(if $(filter x86_64,$(TARGET)),$(VM_HOST:%=$(OUT)/vm/%))
	@:
vm-deps:
	@tools/make/deps "cameras, panels and ARM in an emulator" qemu-system-x86 \
	        qemu-system-arm qemu-system-data seabios cpio kmod xz-utils \
	        device-tree-compiler debian-archive-keyring gcc-aarch64-linux-gnu \
	        libc6-dev-arm64-cross gcc-arm-linux-gnueabihf libc6-dev-armhf-cross strace xxd pkg-config \
	        libgstreamer-plugins-base1.0-dev gstreamer1.0-tools gstreamer1.0-plugins-base gstreamer1.0-plugins-good gstreamer1.0-plugins-bad
	@[ "$(DEPS)" = no ] || for a in x86_64 $(VM_ARCHS); do \
	        tests/vm/prepare $$a || exit 1; done
check-vm: vm-deps
	@set -e; tests/vm/possible $(VM_ARCHS); \
	for a in x86_64 $(VM_ARCHS); do tests/vm/prepare $$a; \
	        $(MAKE) --no-print-directory WERROR=-Werror TARGET=$$a \
	                SYSROOT=$(vm_cache)/$$a/sysroot vm-programs; done; \
	tests/vm/check $(VM_ARCHS)

.PHONY: arm-tests check-arm vm-programs vm-deps check-vm
