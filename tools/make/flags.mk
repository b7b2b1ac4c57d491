# Flags: those of all files, of rooms, and of single files with the reason.

WARN := -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wstrict-prototypes \
        -Wmissing-prototypes -Wvla -Wdouble-promotion -Wundef $(WERROR)
CFLAGS := $(MACHINE_$(TARGET)) $(SECTIONS) -std=c99 -O2 -g -ffile-prefix-map=$(CURDIR)=. -ffp-contract=off -fvisibility=hidden $(WARN)
$(OUT)/src/%.o $(OUT)/tests/%.o: CPPFLAGS += -Isrc
$(OUT)/tests/%.o: CPPFLAGS += -Itests
$(OUT)/platform/%.o $(OUT)/tools/%.o $(OUT)/tests/%.o: CPPFLAGS += \
        -Isrc -Iplatform -Itools -Itools/glint -Itools/hosts -D_POSIX_C_SOURCE=200809L \
        -DGLINT_SHARE_DIR='"$(PREFIX)/share/glint"' \
        -DGLINT_PLUGIN_DIR='"$(LIBDIR)/glint"'
$(OUT)/platform/jpeg/mjpeg.o $(OUT)/platform/formats/still_jpeg.o $(OUT)/tests/%_mjpeg.o: CPPFLAGS += $(JPEG_CPPFLAGS)
$(OUT)/platform/formats/still_png.o: CPPFLAGS += $(PNG_CPPFLAGS)
$(OUT)/src/bake/motion/recording.o: CPPFLAGS += $(JANSSON_CPPFLAGS)
$(OUT)/tools/import/openlensflare.o: CPPFLAGS += $(EXPAT_CPPFLAGS)
$(OUT)/tools/import/openlensflare_absent.o: NOTE := lens files of OpenLensFlare left out: no libexpat1-dev

# What reads files of others is guarded against what no test has found; the
# run-time half, which has no copies and no arrays of a length from outside, is
# not. A sanitizer sees more by itself, and -O0 takes no _FORTIFY_SOURCE.
LINKED := -Wl,-z,relro,-z,now
ifdef PIC # for shared libraries, of which the linker keeps what is to be seen
CFLAGS := $(filter-out -fvisibility=hidden,$(CFLAGS)) -fPIC -fno-semantic-interposition
else ifeq ($(filter -static,$(LDFLAGS)),)
CFLAGS += -fPIE
LINKED += -pie
endif
ifneq ($(and $(filter release qcheck,$(CONFIG)),$(filter-out wasm32,$(ARCH))),)
$(engine_o) $(bake_o) $(platform_o) $(tools_o) $(main_o): CFLAGS += \
        -fstack-protector-strong -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2
endif
# Plug-ins of one command each.
PLUGGED := -O2 -g -ffile-prefix-map=$(CURDIR)=. -fPIC -fvisibility=hidden -shared -fstack-protector-strong \
        -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2 -Wl,-z,relro,-z,now
# On boards what is around the frames is small rather than fast, but for the rows
# of pixels below.
ifdef CROSS
$(engine_o) $(platform_o) $(tools_o) $(main_o): CFLAGS += -Os -fno-asynchronous-unwind-tables -fno-unwind-tables
endif
# The run-time half has no library, small stack frames and nothing to unwind;
# --gc-sections takes out what is not called.
$(core_o): CFLAGS += -ffreestanding -ffunction-sections -Wframe-larger-than=1024 \
        -fno-asynchronous-unwind-tables -fno-unwind-tables
# An instruction set is a file-name suffix; nothing else may use its flags.
$(OUT)/src/%_sse41.o: CFLAGS += $(if $(filter wasm32,$(ARCH)),-Isrc/kernels/wasm,-msse4.1)
$(OUT)/src/%_avx2.o: CFLAGS += -mavx2
ifeq ($(ARCH),armv7)
$(OUT)/src/%_neon.o: CFLAGS += -mfpu=neon
endif

# of FILES, FLAGS: one row of the tables below.
of = $(eval $(patsubst %,$(OUT)/%.o,$(1)): CFLAGS += $(2))

# Run once, or once for a lamp, bundle or row: small rather than fast.
$(call of,$(addprefix src/base/,status arena workers blob) src/image/image,-Os)
$(call of,src/lens/model,-Os)
$(call of,$(addprefix src/scene/,scene valid model account/account begin lights looks uv ward/environment ward/ward_lobe translucent/translucent),-Os)
$(call of,$(addprefix src/scene/,ward/scene_ward ward/ward phong ray shadow surface vector visible mesh quick quick_mesh scene_pass translucent/spread translucent/scene_stone) src/image/cover,-O3)# loops of three
$(call of,src/lamps/lamp_finder,-Os)
$(call of,$(addprefix src/follow/,match record lamp_tracker),-Os)
$(call of,$(addprefix src/flare/,aim by_edges capacities colours lights plan plan_cells probe window wave_sets flare draw_over account),-Os)
$(call of,src/tile/bins src/tile/pass src/star/star src/veil/veil $(addprefix src/image/,resolve curve mix),-Os)

# Loops over doubles that a machine takes two at a time.
$(call of,src/bake/translucent/% tests/reference/scatter/%,-O3)
# The compiler of Debian 12 for aarch64 fails in this with -O3.
$(call of,src/bake/translucent/quantise,-O2)

# Hot loops are unrolled.
$(call of,src/kernels/%,-O3)
$(call of,src/kernels/ward/sum_avx2,-Wframe-larger-than=2048)# 16 vectors of texels
$(call of,$(addprefix src/lamps/,bright_scan row_light),-O3)
$(call of,$(addprefix src/flare/edges/,ghost_edges ghost_rows),-O3)
$(call of,$(addprefix src/flare/edges/,edge edge_add),-O3 -fno-tree-vectorize)# their loops are short
# Unrolling these buys nothing but bytes.
$(call of,$(addprefix src/image/,codes quads) src/veil/veil_pass src/veil/veil_front src/tile/blend $(addprefix src/flare/,edges/sums edges_pass) \
	$(addprefix src/lens/,transfer transfer_rays transfer_grid),-ftree-vectorize)
# Every frame of a camera goes through these on its way to a panel.
$(call of,$(addprefix platform/panel/,panel sinks),-O3)
# The floor that frames are measured by is as fast as can be.
$(call of,tools/measure/canvas,-O3)
# Frequencies in fours.
$(call of,src/engine/star/arcs,-O3 -fno-math-errno -fno-trapping-math)
# Rays in eights: errno and traps are all that these give away.
$(call of,src/bake/trace/trace src/bake/trace/forms src/bake/table/form,-O3 -fno-math-errno -fno-trapping-math)
ifeq ($(findstring clang,$(CC)),)
# gcc unrolls loops over eight rays before it vectorises, and then cannot.
$(call of,src/bake/trace/trace src/bake/trace/forms src/bake/table/form,--param max-completely-peel-times=3)
endif

ifeq ($(ARCH)-$(findstring gcc,$(CC)),aarch64-gcc)
# Else constants that are hoisted push out tables: a tenth more instructions.
$(call of,src/kernels/composite_neon,-fno-move-loop-invariants)
endif
ifneq ($(filter armv7%,$(ARCH)),)
# There are 16 vectors for 40 values: the rest is spilled.
$(call of,src/kernels/composite_neon,-Wframe-larger-than=1536)
endif
ifneq ($(findstring clang,$(CC)),)
# Likewise, of 32 bytes each.
$(call of,src/kernels/composite_avx2,-Wframe-larger-than=1536)
endif

# ----------------------------------------------------------- configurations
ifeq ($(CONFIG),asan)
SANITIZE := -fsanitize=address,undefined -fno-sanitize-recover=all
else ifeq ($(CONFIG),tsan)
SANITIZE := -fsanitize=thread
else ifeq ($(CONFIG),fuzz) # what make fuzz builds; clang only
SANITIZE := -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
# What rays, polynomials and pixels compare is not a word of a file, and takes two
# thirds of the time to follow.
$(filter-out %/model.o,$(call objects,src,base kernels kernels/rays kernels/ward kernels/maps \
        lens image tile flare flare/edges scene bake/trace)) $(OUT)/src/bake/table/form.o: CFLAGS += -fno-sanitize-coverage=trace-cmp
else ifeq ($(CONFIG),analyze) # what make analyze builds; gcc only
# as it is written: -O0 keeps functions and their messages apart
ANALYZER := -O0 -fanalyzer -Wno-frame-larger-than
# gcc 12 does not see what its own intrinsics write,
$(OUT)/src/%_sse41.o $(OUT)/src/%_avx2.o: ANALYZER := -O0 -Wno-frame-larger-than
# nor that a float made of a double is something,
$(OUT)/platform/formats/samples.o: ANALYZER += -Wno-analyzer-use-of-uninitialized-value
# nor that what a frame points to is the frame's,
$(OUT)/src/bake/exact/frame_rays.o: ANALYZER += -Wno-analyzer-malloc-leak
# nor that systems in an array of the run's are the run's.
$(OUT)/src/bake/bake.o: ANALYZER += -Wno-analyzer-malloc-leak
TIDY = $(Q)clang-tidy --quiet $< -- $(CPPFLAGS) $(filter-out $(WARN),$(CFLAGS))
else ifeq ($(CONFIG),qcheck)
CPPFLAGS += -DGLINT_Q_CHECK
else ifneq ($(CONFIG),release)
$(error CONFIG is release, asan, tsan or qcheck)
endif
ifdef SANITIZE
CPPFLAGS += -DGLINT_SANITIZED
CFLAGS += -O1 $(SANITIZE)
$(core_o): CFLAGS += -Wno-frame-larger-than
endif
